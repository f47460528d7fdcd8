#pragma once
#include <cstdint>
#include <string>

#include "seal.hpp"
#include "thixis/core/types.hpp"

namespace thixis::output {

/// What a run that goes on must know of a frame on the disk.
struct StoredFrame {
  double time = 0;
  int mesh = 0;                   ///< number of the frame that holds its mesh
  std::uint64_t fingerprint = 0;  ///< of that mesh, if it is the frame's own
  std::string xdmf;               ///< its `<Grid>` element
};

/// The frames of a series in time: frame n is the file `fields/<n, six digits at least>.h5` in the folder of the run, and holds
///
///     /mesh_<n>    if the mesh is not that of frame n - 1: `points`, the cells and the attribute `fingerprint` (64 bits, integer)
///     /fields_<n>  the fields, and the attributes `time` (double) and `mesh` (integer), the number of the frame that holds the mesh
///     /xdmf        text, its `<Grid>` element of fields.xdmf
///
/// behind a seal: a run that goes on shows a damaged frame to no library.
/// Nothing here is collective.
class Frames {
 public:
  explicit Frames(const std::string& folder) : folder_(folder) {}

  /// The file of a frame as the files beside the folder of frames call it, and its path.
  static std::string name(int frame);
  std::string path(int frame) const;

  static Seal seal() { return {"thixis frame", 1}; }

  /// Makes the folder of frames. Throws FileError.
  void make_folder() const;
  /// Removes the frames from this one on and files that were not finished; other files stay. Throws FileError.
  void remove_from(int first) const;
  /// Removes all frames, and their folder if it is empty then. Throws FileError.
  void remove() const;

  /// Reads a frame, without the values of its arrays; `mesh_before`: that of the previous one. Throws FileError if there is no such frame
  /// or it is damaged.
  StoredFrame read(int frame, int mesh_before) const;

 private:
  std::string folder_;
};

}  // namespace thixis::output
