#pragma once
#include <string>
#include <vector>

#include "thixis/core/types.hpp"
#include "thixis/output/fields.hpp"

namespace thixis::output {

/// One dataset of the HDF5 file that is a field.
struct XdmfAttribute {
  std::string name;
  Centre centre;
  int columns;  ///< 1 (scalar) or 3 (vector)
};

/// One grid of the file: `/mesh_<mesh>` with the fields in `/fields_<number>`.
struct XdmfGrid {
  int number = 0, mesh = 0;
  std::string file, mesh_file;  ///< HDF5 files that hold the fields and the mesh, relative to the XDMF file
  GlobalIndex points = 0, cells = 0;
  int corners = 3;  ///< of a cell
  double time = 0;
  std::vector<XdmfAttribute> attributes;
};

/// A `<Grid>` element. Only grids of a collection have their time: readers of single grids (meshio) do not know it.
std::string xdmf_grid(const XdmfGrid& grid, bool with_time);
/// The array of `/mesh_<m>` with the cells: segments, triangles, quadrilaterals.
std::string cell_array(int corners);
/// The whole text: one grid, or the elements of several ones in a collection in time.
std::string xdmf_single(const std::string& grid);
std::string xdmf_series(const std::string& grids);

}  // namespace thixis::output
