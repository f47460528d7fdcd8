#pragma once
#include <string>
#include <vector>

#include "hdf5/slabs.hpp"

namespace thixis::output {

/// An HDF5 file opened for reading by this rank alone. Nothing is collective. What is not there or is something else than asked for throws
/// a FileError with the sentence of the constructor; so does what this program never writes: a link in place of an entry, an array whose
/// values stand in another file, one that says it is larger than the file. HDF5 itself prints nothing, and files are not locked.
class Hdf5Reader {
 public:
  /// `complaint`: the sentence about a file that does not hold what it should. An existing file that is no HDF5 is one, too.
  Hdf5Reader(const std::string& path, std::string complaint);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  bool has(const std::string& name) const;  ///< an entry of the outermost group
  std::string text(const std::string& name) const;
  double number(const std::string& group, const std::string& name) const;
  GlobalIndex integer(const std::string& group, const std::string& name) const;
  std::vector<std::string> attributes(const std::string& group) const;  ///< names, sorted
  std::vector<std::string> entries(const std::string& group) const;     ///< names, sorted
  GlobalIndex rows(const std::string& array) const;                     ///< its first extent
  GlobalIndex length(const std::string& vector) const;
  std::vector<double> numbers(const std::string& vector, const Slab& slab) const;
  std::vector<GlobalIndex> integers(const std::string& vector, const Slab& slab) const;

 private:
  using Id = long long;  ///< hid_t, HDF5 header kept out
  void require(bool good) const;
  void read_attribute(const std::string& group, const std::string& name, Id type, void* value) const;
  void read_rows(const std::string& vector, const Slab& slab, Id type, void* rows) const;

  void require_own(const std::string& name) const;
  GlobalIndex bytes_of(Id array) const;

  std::string complaint_;
  GlobalIndex bytes_ = 0;  ///< of the file
  Id file_ = -1;
};

}  // namespace thixis::output
