#include "deviation/deviation.hpp"

#include "deviation/deviation_points.hpp"

namespace thixis::bound {

Deviation deviation_of_membranes(const method::Space& space, const BoundaryLift& lift, const std::vector<bool>& dirichlet, double noise) {
  if (lift.empty()) return {};
  const mesh::Mesh& mesh = space.mesh();
  const auto& cells = lift.cells();
  const auto place = nowhere(mesh);
  Deviation deviation;
  deviation.quadrature = composite(method::make_quadrature(mesh, cells, 6, nullptr), 4);
  const View<double*> bound("thixis::bound::deviation_bound", cells.extent(0));
  const View<double* [3]> D("thixis::bound::deviation", deviation.quadrature.points());
  const auto host = mesh::on_host(mesh);
  const View<bool* [3]> on_held("thixis::bound::deviation_on_held", cells.extent(0));
  const LiftTable table = lift.table(deviation.quadrature.rule_xi), on_faces = lift.table(face_points());
  std::vector<double> L[3];
  for (LocalIndex k = 0; k < cells.extent_int(0); ++k) {
    place(cells(k)) = k;
    bound(k) = lift.bound_of_difference(k);
    const auto K = mesh::cell_geometry(host.coordinates, host.cell_vertices, cells(k));
    on_faces.evaluate(lift.difference(k), L);
    mark_held(host, dirichlet, cells(k), L[0].data(), noise, on_held, k);
    table.evaluate(lift.difference(k), L);
    const GlobalIndex first = deviation.quadrature.offset(k);
    for (int q = 0; q < table.points(); ++q) {
      D(first + q, 0) = L[0][q];
      for (int d = 0; d < 2; ++d) D(first + q, 1 + d) = L[1][q] * K.gradient[1][d] + L[2][q] * K.gradient[2][d];
    }
  }
  deviation.place = place;
  deviation.bound = bound;
  deviation.at_points = D;
  deviation.on_held = on_held;
  return deviation;
}

}  // namespace thixis::bound
