#pragma once
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "thixis/core/comm.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/types.hpp"

namespace thixis::output {

/// Values with identities that depend neither on the number of ranks nor on who owns what. Each rank brings some of them, in any order;
/// no id is brought twice. Ids are >= 0 and may have gaps.
struct CheckpointBlock {
  std::string name;              ///< letters, digits, '_', '-', '.' and inner spaces; the same blocks in the same order on all ranks
  std::vector<GlobalIndex> ids;  ///< of this rank
  std::vector<double> values;    ///< one per id; also those that are not finite are kept, bit for bit
};

/// A list that is known on all ranks, as a block: ids 0, 1, …, brought by the root. Numbers are exact up to 2^53.
CheckpointBlock list_block(const std::string& name, const std::vector<GlobalIndex>& list, bool root);

/// Everything a run needs to go on. All but the blocks are the same on all ranks.
struct Checkpoint {
  std::string deck;                          ///< the deck as run (XML), what was overridden included
  std::string folder;                        ///< where relative files of the deck are found: an absolute path
  int level = -1;                            ///< level of the mesh hierarchy that the blocks belong to, -1: none
  std::map<std::string, double> attributes;  ///< counters, times, ...: integers are exact up to 2^53
  std::vector<CheckpointBlock> blocks;
};

/// Writes `checkpoint.h5` (parallel HDF5). The file does not depend on the number of ranks:
///
///     (the first 512 bytes)    a seal: length and checksum of all that follows, looked at before anything else is read
///     /                        attribute `level` (integer)
///     /deck, /folder           text
///     /attributes              a group with one attribute (double) for each of them
///     /blocks/<name>/ids       [n] 64-bit integers, rising
///     /blocks/<name>/values    [n] doubles, those of the ids
///     /blocks/<name>           attribute `checksum`: sum of hash(id, bits of the value) modulo 2^64
///
/// It is written beside its place (`<path>.part`), brought to the disk, sealed, read back and compared, and renamed: at any moment, also
/// when the program is killed or the disk is full, the whole old or the whole new checkpoint is there. Collective; throws FileError on all
/// ranks. Blocks that contradict themselves are an Error with code `internal`.
void write_checkpoint(const std::string& path, const Checkpoint& checkpoint, const core::Comm& comm);

/// A checkpoint on the disk, to be read on any number of ranks.
class StoredCheckpoint {
 public:
  ~StoredCheckpoint();
  StoredCheckpoint(StoredCheckpoint&&) noexcept;
  StoredCheckpoint& operator=(StoredCheckpoint&&) noexcept;

  const std::string& path() const { return path_; }
  const std::string& deck() const { return head_.deck; }
  const std::string& folder() const { return head_.folder; }
  int level() const { return head_.level; }
  /// Throws FileError if there is no such attribute.
  double attribute(const std::string& name) const;
  /// The same, but a finite number that is not below `least`. Throws FileError: what a run would not have written is not believed.
  double number(const std::string& name, double least = -std::numeric_limits<double>::max()) const;
  /// The same as a whole number from 0 to `most`.
  GlobalIndex count(const std::string& name, GlobalIndex most = 1000000000) const;
  bool has_attribute(const std::string& name) const { return head_.attributes.count(name) != 0; }
  /// How many values a block has over all ranks; -1 if there is no such block.
  GlobalIndex size(const std::string& block) const;

  /// The values of these ids, exactly as they were saved; any ids on any rank, also several times. Each rank reads a part of the file
  /// and answers the others. Collective; throws FileError on all ranks where an id or the block is absent, or the file is damaged.
  std::vector<double> fetch(const std::string& block, const std::vector<GlobalIndex>& ids) const;
  /// The same, of finite values.
  std::vector<double> fetch_finite(const std::string& block, const std::vector<GlobalIndex>& ids) const;
  /// All of a `list_block`, on all ranks. Collective; as fetch, and of whole numbers.
  std::vector<GlobalIndex> fetch_list(const std::string& block) const;

 private:
  friend StoredCheckpoint read_checkpoint(const std::string& path, const core::Comm& comm);
  struct File;
  StoredCheckpoint(std::string path, const core::Comm& comm);
  core::FileError wrong_number(const std::string& name, double value) const;

  std::string path_;
  core::Comm comm_;
  Checkpoint head_;  ///< without values
  std::unique_ptr<File> file_;
};

/// Opens a checkpoint; its blocks are read by `fetch`. Collective. Throws FileError on all ranks if there is no such file, it is no
/// regular file, no checkpoint of Thixis, of another format, or a single bit of it is not as it was written.
StoredCheckpoint read_checkpoint(const std::string& path, const core::Comm& comm);

}  // namespace thixis::output
