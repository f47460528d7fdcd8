#include "restart/evolution_checkpoint.hpp"

#include <fmt/format.h>

#include <limits>

namespace thixis::drive {

std::map<std::string, double> stored_by(const TimePosition& at, double next_length, const Written& written) {
  return {{"time_step", at.step},
          {"time", at.time},
          {"next_length", next_length},
          {"newton_iterations", at.newton_iterations},
          {"linear_iterations", at.linear_iterations},
          {"retries", at.retries},
          {"history_rows", static_cast<double>(written.history_rows)},
          {"series_rows", static_cast<double>(written.series_rows)},
          {"frames", written.frames},
          {"last_frame", written.last_frame},
          {"seconds", written.seconds}};
}

StoredEvolution stored_evolution(const output::StoredCheckpoint& stored) {
  if (!stored.has_attribute("time_step"))
    throw core::InputError(
        fmt::format("scene/model: the checkpoint '{}' belongs to a stationary scene; leave the model as it was.", stored.path()));
  constexpr GlobalIndex most_rows = 1ll << 50;
  const auto count = [&](const char* name) { return static_cast<int>(stored.count(name)); };
  const int frames = count("frames");
  StoredEvolution evolution;
  evolution.at = {count("time_step"), stored.number("time", 0), count("newton_iterations"), count("linear_iterations"), count("retries")};
  evolution.next_length = stored.number("next_length", std::numeric_limits<double>::min());
  evolution.written = {stored.count("history_rows", most_rows), stored.count("series_rows", most_rows), frames,
                       frames > 0 ? count("last_frame") : -1, stored.number("seconds", 0)};
  return evolution;
}

}  // namespace thixis::drive
