#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "thixis/core/comm.hpp"
#include "thixis/core/types.hpp"

namespace thixis::mesh {
struct Mesh;
}

namespace thixis::output {

/// Where the values of a field sit.
enum class Centre { vertex, cell };

/// Values on the local vertices (cells) of a mesh, or on the local points (cells) of a grid. Ghosts are not read: the values may end
/// after the last owned entity, e.g. after `owned_cells` cells. They are written as they are, also those that are not finite.
struct FieldData {
  std::string name;  ///< letters, digits, '_', '-', '.' and inner spaces; one field of that name per call
  Centre centre = Centre::vertex;
  std::vector<double> values;  ///< [entities][components]
  int components = 1;          ///< 1, 2 or 3; two of them are stored with a third one, 0, because ParaView knows no others
};

/// Segments or quadrilaterals, on this rank, ghosts or not.
struct Cells {
  int corners = 0;  ///< of each cell: 2 or 4, the same on all ranks; 0: there are none
  GlobalIndex global = 0;
  std::vector<LocalIndex> points;  ///< [cells][corners] local points, those of a quadrilateral counter-clockwise
  std::vector<GlobalIndex> id;
  std::vector<int> owner;  ///< ranks
};

/// What the file shows: plain triangles on this rank, ghosts or not, or other cells in their place. A discontinuous field of high order is
/// a grid of its own, whose cells are the pieces of those of the mesh and share no points.
///
/// Ids are 0..points-1 and 0..cells-1 over all ranks; the rank that owns an entity holds it, and no other rank says that it owns it.
struct Grid {
  GlobalIndex global_points = 0, global_triangles = 0;
  std::vector<std::array<double, 2>> points;
  std::vector<GlobalIndex> point_id;
  std::vector<int> point_owner;                      ///< ranks
  std::vector<std::array<LocalIndex, 3>> triangles;  ///< local points
  std::vector<GlobalIndex> triangle_id;
  std::vector<int> triangle_owner;  ///< ranks
  Cells others;                     ///< in place of triangles, of which there are none then

  /// Local cells of whatever kind.
  std::size_t cells() const { return others.corners == 0 ? triangles.size() : others.id.size(); }
};

/// Writes `fields.h5` and `fields.xdmf` (XDMF 3, relative paths), collectively, in the order of global ids, so that the arrays do not
/// depend on the number of ranks. All members are collective and throw FileError on all ranks; fields or grids that contradict themselves
/// are an Error with code `internal`.
///
/// HDF5: `/mesh_<m>/points [points][2]` and `/mesh_<m>/triangles [triangles][3]` (in its place `segments [segments][2]` or `quadrilaterals
/// [quadrilaterals][4]`), `/fields_<n>/<name> [entities]` or `[entities][3]`; attributes are `time` and `mesh` (the m) of `/fields_<n>` and
/// `fingerprint` of `/mesh_<m>`. In XDMF the cells are Triangle, Polyline of two nodes, Quadrilateral.
///
/// FieldWriter(folder, comm), for a run that shows its end: fields.h5 holds all of it. One grid makes a plain file, several a
/// collection in time. Between two calls both files are closed, so that they can be looked at. After an Error and on a full disk the file
/// is as it was before the call; after another failure of the disk nothing more can be written to it.
///
/// series(folder, comm, n), for a run in time, which may be killed at any moment and go on: grid n, with its mesh if that is a new one, is
/// written aside, brought to the disk and renamed to `fields/<n, six digits>.h5`. fields.h5 consists of links to what these files hold, so
/// that it shows the same entries; fields.xdmf, always a collection in time, refers to them directly. Equal calls make equal files, byte by
/// byte, whether or not the run was interrupted between them. After an Error the frames are as they were before the call. A checkpoint that
/// counts a frame is to be written behind it.
///
/// (The lists of all grids so far, fields.xdmf and the links, are renewed, beyond 128 grids, once per 64th of their number, and by
/// close().)
class FieldWriter {
 public:
  /// Creates an empty fields.h5 in an existing folder; an old fields.xdmf and old frames are removed.
  FieldWriter(const std::string& folder, const core::Comm& comm);
  /// The first `frames_kept` frames that an interrupted run left in the folder stay, later ones are removed: they will be written again, on
  /// any number of ranks. None begins anew. Throws FileError if one that is to stay is missing or damaged (the values of its arrays are not
  /// read); then nothing is changed.
  static FieldWriter series(const std::string& folder, const core::Comm& comm, int frames_kept = 0);
  ~FieldWriter();
  FieldWriter(FieldWriter&&) noexcept;
  FieldWriter& operator=(FieldWriter&&) = delete;

  /// One grid with its fields; `time` grows from call to call. The mesh is written anew only when its points, cells or
  /// numbers differ from those of the previous call.
  void write(const mesh::Mesh& mesh, const std::vector<FieldData>& fields, double time);
  void write(const Grid& grid, const std::vector<FieldData>& fields, double time);
  /// Grids so far, on all ranks; those that were kept count. Not collective.
  int frames() const;
  /// Finishes both files; nothing can be written any more.
  void close();

 private:
  struct Impl;
  explicit FieldWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::output
