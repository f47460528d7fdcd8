#include "thixis/equilibration/cell_fields.hpp"

namespace thixis::equilibration {
namespace {

struct FillMetrics {
  View<double* [2]> x;
  View<LocalIndex* [3]> vertices;
  View<const LocalIndex*> cells;
  View<Metric*> metric;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int k) const {
    const LocalIndex a = vertices(cells(k), 0), b = vertices(cells(k), 1), c = vertices(cells(k), 2);
    const double e[2] = {x(b, 0) - x(a, 0), x(b, 1) - x(a, 1)}, f[2] = {x(c, 0) - x(a, 0), x(c, 1) - x(a, 1)};
    const double det = e[0] * f[1] - e[1] * f[0];
    metric(k) = {det, (e[0] * e[0] + e[1] * e[1]) / det, (e[0] * f[0] + e[1] * f[1]) / det, (f[0] * f[0] + f[1] * f[1]) / det};
  }
};

}  // namespace

Metrics metrics(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells) {
  const View<Metric*> metric("thixis::equilibration::metric", cells.extent(0));
  Kokkos::parallel_for("thixis::equilibration::metric", Kokkos::RangePolicy<>(0, cells.extent_int(0)),
                       FillMetrics{mesh.coordinates, mesh.cell_vertices, cells, metric});
  return metric;
}

}  // namespace thixis::equilibration
