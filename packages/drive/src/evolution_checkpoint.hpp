#pragma once
#include "thixis/core/deck.hpp"
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

/// The file `checkpoint.h5` of a run in time: the state between two steps.
class EvolutionCheckpoint {
 public:
  EvolutionCheckpoint(std::string path, const RunParams& params, const core::Deck& deck);
  const std::string& path() const { return path_; }
  /// Collective.
  void write(const TimePosition& at, double next_length, const models::Evolution& evolution, const algebra::Vector& X,
             const Written& written) const;

 private:
  std::string path_;
  output::Checkpoint frame_;  ///< deck and folder
};

/// What a checkpoint knows beside the state of the scene. Throws InputError for the checkpoint of a stationary run.
struct StoredEvolution {
  TimePosition at;
  double next_length = 0;
  Written written;
};
StoredEvolution stored_evolution(const output::StoredCheckpoint& stored);

}  // namespace thixis::drive
