#pragma once
#include <map>
#include <string>

#include "thixis/drive/evolve.hpp"
#include "thixis/drive/stationary.hpp"
#include "thixis/output/checkpoint.hpp"

namespace thixis::drive {

/// What a run has written and spent so far; series and fields in time alone.
struct Written {
  GlobalIndex history_rows = 0, series_rows = 0;
  int frames = 0;      ///< of the fields
  int last_frame = 0;  ///< the step of the last one
  double seconds = 0;
};

/// What a run stores beside the state of the scene: at rest with an iterate, in time between two steps.
std::map<std::string, double> stored_by(const Position& at, const Written& written);
std::map<std::string, double> stored_by(const TimePosition& at, double next_length, const Written& written);

/// What the checkpoint of a run at rest knows beside the iterate.
struct StoredIterate {
  Position at;
  Written written;
};
StoredIterate stored_iterate(const output::StoredCheckpoint& stored);

/// What a checkpoint knows beside the state of the scene. Throws InputError for the checkpoint of a stationary run.
struct StoredEvolution {
  TimePosition at;
  double next_length = 0;
  Written written;
};
StoredEvolution stored_evolution(const output::StoredCheckpoint& stored);

}  // namespace thixis::drive
