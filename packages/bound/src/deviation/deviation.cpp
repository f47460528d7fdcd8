#include "deviation/deviation.hpp"

#include "data/on_host.hpp"
#include "deviation/deviation_points.hpp"

namespace thixis::bound {

Deviation deviation_of_membranes(const method::Space& space, const BoundaryLift& lift, const std::vector<bool>& dirichlet, double noise) {
  if (lift.empty()) return {};
  const mesh::Mesh& mesh = space.mesh();
  const auto cells = on_host(lift.cells());
  Deviation deviation;
  deviation.quadrature = composite(method::make_quadrature(mesh, lift.cells(), 6, nullptr), 4);
  DeviationOnHost out(mesh, cells.extent(0), deviation.quadrature.points());
  const auto host = mesh::on_host(mesh);
  const auto offset = on_host(deviation.quadrature.offset);
  const LiftTable table = lift.table(deviation.quadrature.rule_xi), on_faces = lift.table(face_points());
  std::vector<double> L[3];
  for (LocalIndex k = 0; k < cells.extent_int(0); ++k) {
    out.place(cells(k)) = k;
    out.bound(k) = lift.bound_of_difference(k);
    const auto K = mesh::cell_geometry(host.coordinates, host.cell_vertices, cells(k));
    on_faces.evaluate(lift.difference(k), L);
    mark_held(host, dirichlet, cells(k), L[0].data(), noise, out.on_held, k);
    table.evaluate(lift.difference(k), L);
    const GlobalIndex first = offset(k);
    for (int q = 0; q < table.points(); ++q) {
      out.at_points(first + q, 0) = L[0][q];
      for (int d = 0; d < 2; ++d) out.at_points(first + q, 1 + d) = L[1][q] * K.gradient[1][d] + L[2][q] * K.gradient[2][d];
    }
  }
  out.commit(deviation);
  return deviation;
}

}  // namespace thixis::bound
