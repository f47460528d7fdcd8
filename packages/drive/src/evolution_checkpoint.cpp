#include "evolution_checkpoint.hpp"

#include <fmt/format.h>

#include "checkpoint.hpp"

namespace thixis::drive {

EvolutionCheckpoint::EvolutionCheckpoint(std::string path, const RunParams& params, const core::Deck& deck)
    : path_(std::move(path)), frame_(checkpoint_frame(params, deck)) {}

void EvolutionCheckpoint::write(const TimePosition& at, double next_length, const models::Evolution& evolution, const algebra::Vector& X,
                                const Written& written) const {
  models::EvolutionState state = evolution.save(X);
  output::Checkpoint checkpoint = frame_;
  checkpoint.level = 0;
  checkpoint.blocks = std::move(state.blocks);
  checkpoint.attributes = std::move(state.attributes);
  checkpoint.attributes.insert({{"time_step", at.step},
                                {"time", at.time},
                                {"next_length", next_length},
                                {"newton_iterations", at.newton_iterations},
                                {"linear_iterations", at.linear_iterations},
                                {"retries", at.retries},
                                {"history_rows", static_cast<double>(written.history_rows)},
                                {"series_rows", static_cast<double>(written.series_rows)},
                                {"frames", written.frames},
                                {"last_frame", written.last_frame},
                                {"seconds", evolution.comm().max(written.seconds)}});
  output::write_checkpoint(path_, checkpoint, evolution.comm());
}

StoredEvolution stored_evolution(const output::StoredCheckpoint& stored) {
  if (!stored.has_attribute("time_step"))
    throw core::InputError(
        fmt::format("scene/model: the checkpoint '{}' belongs to a stationary scene; leave the model as it was.", stored.path()));
  const auto count = [&](const char* name) { return static_cast<int>(stored.attribute(name)); };
  StoredEvolution evolution;
  evolution.at = {count("time_step"), stored.attribute("time"), count("newton_iterations"), count("linear_iterations"), count("retries")};
  evolution.next_length = stored.attribute("next_length");
  evolution.written = {static_cast<GlobalIndex>(stored.attribute("history_rows")),
                       static_cast<GlobalIndex>(stored.attribute("series_rows")), count("frames"), count("last_frame"),
                       stored.attribute("seconds")};
  return evolution;
}

}  // namespace thixis::drive
