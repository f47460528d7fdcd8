#include <fmt/core.h>

#include <algorithm>

#include "grids.hpp"
#include "thixis/core/error.hpp"
#include "thixis/fv/host.hpp"

namespace thixis::fv {

void require_admissible(const Grid& grid, const std::string& parameter) {
  // Centres that coincide are a little apart after round-off.
  const double relative = 1e-8;
  const HostGrid host = on_host(grid);
  GlobalIndex bad = 0, first = grid.global_faces;
  std::vector<double> place = {0, 0};
  for (LocalIndex F = 0; F < grid.faces; ++F) {
    const bool counted_here = host.face_cells(F, 0) < grid.owned_cells;
    if (!counted_here || host.face_distance(F) > relative * host.face_area(F)) continue;
    if (bad++ > 0) continue;
    first = grid.face_id[F];
    place = {host.face_centre(F, 0), host.face_centre(F, 1)};
  }
  bad = grid.comm.sum(bad);
  if (bad == 0) return;
  if (first != grid.comm.min(first)) place = {0, 0};
  grid.comm.sum(place);
  throw core::InputError(
      fmt::format("{}: two-point fluxes do not admit this mesh: at {} of {} faces, the first one at ({:g}, {:g}), the circumcentres of "
                  "the triangles do not lie apart and in the order of the triangles, or not inside of the boundary; write "
                  "mesh/generator = tensor, or give a Gmsh mesh of acute triangles.",
                  parameter, bad, grid.global_faces, place[0], place[1]));
}

}  // namespace thixis::fv
