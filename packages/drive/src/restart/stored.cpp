#include "restart/stored.hpp"

#include <fmt/format.h>

#include <limits>

#include "thixis/core/error.hpp"

namespace thixis::drive {
namespace {

constexpr GlobalIndex most_rows = 1ll << 50;

std::map<std::string, double> stored_by(const Effort& effort, const Written& written) {
  return {{"newton_iterations", effort.newton_iterations},
          {"linear_iterations", effort.linear_iterations},
          {"history_rows", static_cast<double>(written.history_rows)},
          {"seconds", written.seconds}};
}

int count(const output::StoredCheckpoint& stored, const char* name) { return static_cast<int>(stored.count(name)); }

/// What all runs store.
void fetch(const output::StoredCheckpoint& stored, Effort& effort, Written& written) {
  effort = {count(stored, "newton_iterations"), count(stored, "linear_iterations")};
  written.history_rows = stored.count("history_rows", most_rows);
  written.seconds = stored.number("seconds", 0);
}

}  // namespace

std::map<std::string, double> stored_by(const Position& at, const Written& written) {
  auto all = stored_by(static_cast<const Effort&>(at), written);
  all["newton_on_level"] = at.newton_on_level;
  return all;
}

std::map<std::string, double> stored_by(const TimePosition& at, double next_length, const Written& written) {
  auto all = stored_by(static_cast<const Effort&>(at), written);
  all["time_step"] = at.step;
  all["time"] = at.time;
  all["next_length"] = next_length;
  all["retries"] = at.retries;
  all["series_rows"] = static_cast<double>(written.series_rows);
  all["frames"] = written.frames;
  all["last_frame"] = written.last_frame;
  return all;
}

StoredIterate stored_iterate(const output::StoredCheckpoint& stored) {
  StoredIterate iterate;
  fetch(stored, iterate.at, iterate.written);
  iterate.at.level = stored.level();
  iterate.at.newton_on_level = count(stored, "newton_on_level");
  return iterate;
}

StoredEvolution stored_evolution(const output::StoredCheckpoint& stored) {
  if (!stored.has_attribute("time_step"))
    throw core::InputError(
        fmt::format("scene/model: the checkpoint '{}' belongs to a stationary scene; leave the model as it was.", stored.path()));
  StoredEvolution evolution;
  fetch(stored, evolution.at, evolution.written);
  evolution.at.step = count(stored, "time_step");
  evolution.at.time = stored.number("time", 0);
  evolution.at.retries = count(stored, "retries");
  evolution.next_length = stored.number("next_length", std::numeric_limits<double>::min());
  evolution.written.series_rows = stored.count("series_rows", most_rows);
  evolution.written.frames = count(stored, "frames");
  evolution.written.last_frame = evolution.written.frames > 0 ? count(stored, "last_frame") : -1;
  return evolution;
}

}  // namespace thixis::drive
