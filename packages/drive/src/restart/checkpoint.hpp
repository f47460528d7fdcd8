#pragma once
#include <map>

#include "thixis/core/deck.hpp"
#include "thixis/drive/params.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/models/scene_on_mesh.hpp"
#include "thixis/output/checkpoint.hpp"

namespace thixis::drive {

/// Removes a file that an older run has left. Collective.
void remove_file(const std::string& path, const core::Comm& comm);

/// The file `checkpoint.h5` of a run. It holds the deck as run, so that a restart may be called from another folder.
class CheckpointFile {
 public:
  CheckpointFile(std::string path, const RunParams& params, const core::Deck& deck);

  const std::string& path() const { return path_; }
  /// Remembers that the mesh of `level` came from refining these cells of the one before: no deck can say that.
  void refined(int level, const std::vector<GlobalIndex>& marked) { marked_[level] = marked; }
  /// Writes X with what the scene and, by name, the run need to go on; an X that is not finite is not worth it: returns false and leaves
  /// the file as it is. `level`: of the mesh. Collective.
  bool write(const models::SceneOnMesh& scene, const algebra::Vector& X, int level, std::map<std::string, double> of_run) const;

 private:
  std::string path_;
  output::Checkpoint frame_;                        ///< deck and folder
  std::map<int, std::vector<GlobalIndex>> marked_;  ///< by the level that came from it
};

/// Appends the meshes that adaptivity had added to those of the deck before the checkpoint was written, and tells `checkpoint` so.
/// Collective.
void replay(const output::StoredCheckpoint& stored, mesh::Hierarchy& hierarchy, CheckpointFile& checkpoint);

/// Says in the log which parameters of the deck are not those of the checkpoint; a warning where they change what is solved.
void say_differences(const output::StoredCheckpoint& stored, const RunParams& params);

/// Whether the run that left the checkpoint wrote into this directory, or the checkpoint lies in it (results that were moved).
bool same_directory(const output::StoredCheckpoint& stored, const RunParams& params, const std::string& directory);

/// Throws InputError unless the deck's hierarchy has the level of the checkpoint with as many cells, and the start is nested if there are
/// finer ones.
void check_restart(const output::StoredCheckpoint& stored, const RunParams& params, const mesh::Hierarchy& hierarchy);

}  // namespace thixis::drive
