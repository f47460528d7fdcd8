#include <cmath>

#include "grids.hpp"
#include "thixis/core/error.hpp"

namespace thixis::fv {
namespace {

/// Local numbers are 32 bit: four faces of each cell and the ghosts of a rank must fit.
void require_size(const mesh::MeshParams& params, int ranks) {
  const double limit = 5e8;
  double cells = 1;
  for (const int n : params.cells) cells *= std::ldexp(n, params.refinements);
  if (cells / ranks > limit)
    throw core::InputError(
        "mesh/cells: a rank would hold more than 500 million cells; write fewer cells or refinements, or use more ranks.");
}

}  // namespace

Grid build(const mesh::MeshParams& params, const core::Comm& comm, const std::string& folder) {
  if (mesh::not_triangles(params)) {
    if (const auto found = mesh::mistake(params)) throw core::InputError("mesh/" + found->parameter + ": " + found->sentence);
    require_size(params, comm.size());
    return lattice_grid(lattice(params), comm);
  }
  Grid grid = triangle_grid(mesh::build(params, comm, folder).finest());
  require_admissible(grid, params.generator == mesh::Generator::file ? "mesh/file" : "mesh/generator");
  return grid;
}

}  // namespace thixis::fv
