#pragma once
#include <string>
#include <vector>

#include "hdf5/slabs.hpp"

namespace thixis::output {

/// Throws an Error (code `internal`) unless the name is made of letters, digits, '_', '-', '.' and inner spaces; `what` it names.
void check_entry_name(const std::string& what, const std::string& name);

/// At most so many bytes does HDF5 add to the numbers themselves: for a group with its first entries, for an array.
constexpr long long group_bytes = 8192, array_bytes = 4096;

/// An HDF5 file opened by all ranks together (MPI-IO). Members are collective and throw FileError on all ranks; HDF5 itself prints nothing.
class Hdf5File {
 public:
  enum class Mode { create, extend };
  /// `room`: bytes that will be added at most. They are reserved now: on a full disk the file stays as it is (HDF5 would leave it
  /// damaged, and crash at the end of the program because it can not be closed).
  /// `front`: bytes that are left free in front of a file that is created: 0, or a power of two from 512.
  Hdf5File(const std::string& path, Mode mode, long long room, const core::Comm& comm, std::size_t front = 0);
  /// Closes without complaint.
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  void add_group(const std::string& name);
  /// A number attached to a group.
  void add_attribute(const std::string& group, const std::string& name, double value);
  void add_attribute(const std::string& group, const std::string& name, GlobalIndex value);
  /// The root's text, as a string of fixed length.
  void add_text(const std::string& name, const std::string& text);
  /// A new array [slab.total][columns] (a vector if columns = 1) of which every rank brings its slab.
  void add_array(const std::string& name, const Slab& slab, int columns, const std::vector<double>& rows);
  void add_array(const std::string& name, const Slab& slab, int columns, const std::vector<GlobalIndex>& rows);
  /// Brings everything to the disk.
  void sync();
  /// Brings everything to the file.
  void close();

 private:
  using Id = long long;  ///< hid_t, HDF5 header kept out
  void add_number(const std::string& group, const std::string& name, Id stored, Id type, const void* value);
  void add_rows(const std::string& name, const Slab& slab, int columns, Id type, const void* rows);
  void require(bool done, const std::string& what) const;

  std::string path_;
  core::Comm comm_;
  Id file_ = -1;
};

}  // namespace thixis::output
