#pragma once
#include <memory>
#include <string>

#include "thixis/core/comm.hpp"

namespace thixis::output {

class FolderLock;

/// The directory of a run and the names of the files in it. The object itself touches nothing: create() is called when the deck and the
/// scene are known to be valid, so that a wrong deck leaves no traces.
class RunDirectory {
 public:
  explicit RunDirectory(std::string path) : path_(std::move(path)) {}

  /// Makes the directory with its parents, if it is not there, and sees whether files can be written into it; old files stay. From now on
  /// it is this run's alone, until the last copy of the object is gone: another run that creates it is refused. The directory itself and
  /// its parents may be links; where a link stands in the place of a file of the run, or something else that is no regular file, it is
  /// refused: nothing is written through it. Collective; throws FileError on all ranks.
  void create(const core::Comm& comm);
  /// Writes `deck.xml`: the deck as run. Collective; throws FileError on all ranks.
  void write_deck(const std::string& xml, const core::Comm& comm) const;

  const std::string& path() const { return path_; }
  /// The path of a file in it.
  std::string file(const std::string& name) const;
  std::string deck() const { return file("deck.xml"); }
  std::string log() const { return file("log.txt"); }
  std::string history() const { return file("history.csv"); }
  std::string summary() const { return file("summary.json"); }
  std::string series() const { return file("series.csv"); }
  std::string probes() const { return file("probes.csv"); }
  std::string checkpoint() const { return file("checkpoint.h5"); }

 private:
  std::string path_;
  std::shared_ptr<FolderLock> lock_;  ///< on the root
};

}  // namespace thixis::output
