#pragma once
#include "restart/checkpoint.hpp"
#include "thixis/drive/evolve.hpp"
#include "thixis/output/checkpoint.hpp"

namespace thixis::drive {

/// What a run in time has written and spent so far.
struct Written {
  GlobalIndex history_rows = 0, series_rows = 0;
  int frames = 0;      ///< of the fields
  int last_frame = 0;  ///< the step of the last one
  double seconds = 0;
};

/// What a run in time stores beside the state of the scene, between two steps.
std::map<std::string, double> stored_by(const TimePosition& at, double next_length, const Written& written);

/// What a checkpoint knows beside the state of the scene. Throws InputError for the checkpoint of a stationary run.
struct StoredEvolution {
  TimePosition at;
  double next_length = 0;
  Written written;
};
StoredEvolution stored_evolution(const output::StoredCheckpoint& stored);

}  // namespace thixis::drive
