#include "face_data.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::dg {
namespace {

using Columns = Kokkos::View<LocalIndex**, Kokkos::LayoutRight>;
using Loads = Kokkos::View<double**, Kokkos::LayoutRight>;

/// What Dirichlet data exert on the functions of the cell of a face, and the columns of these.
struct WeakLoads {
  View<double* [2]> x;
  View<LocalIndex* [3]> vertices;
  View<LocalIndex* [2]> face_vertices;
  BoundaryData on;
  Traces traces;
  Penalty penalty;
  method::ElementUnknowns elements;
  Columns columns;  ///< out, overwritten
  Loads F;          ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const int s = on.faces.cell(e, 0) >= 0 ? 0 : 1, side = on.faces.side(e, s), points = traces.t.extent_int(0);
    const LocalIndex K = on.faces.cell(e, s);
    const mesh::CellGeometry cell = mesh::cell_geometry(x, vertices, K);
    const mesh::FaceGeometry face = mesh::face_geometry(x, face_vertices, on.faces.face(e));
    const double outward = s == 0 ? 1 : -1;
    for (int i = 0; i < F.extent_int(1); ++i) {
      double sum = 0;
      for (int q = 0; q < points; ++q) {
        double slope = 0;
        for (int a = 0; a < 3; ++a)
          slope +=
              traces.derivative(side, q, i, a) * outward * (face.normal[0] * cell.gradient[a][0] + face.normal[1] * cell.gradient[a][1]);
        sum += traces.weight(q) * face.length * on.mu(e * points + q) * on.data(e * points + q) *
               (penalty.eta / face.length * traces.value(side, q, i) - penalty.theta * slope);
      }
      columns(e, i) = elements(K, i);
      F(e, i) = sum;
    }
  }
};

}  // namespace

void add_weakly(const method::Space& space, const Penalty& penalty, const scene::Field& tension, const scene::Field& g, LocalIndex tag,
                double t, algebra::Vector& F) {
  const mesh::Mesh& mesh = space.mesh();
  WeakLoads kernel;
  kernel.x = mesh.coordinates;
  kernel.vertices = mesh.cell_vertices;
  kernel.face_vertices = mesh.face_vertices;
  kernel.traces = traces(space.basis(), space.options().params.order());
  kernel.on = boundary_data(space, tag, kernel.traces, g, t, &tension);
  kernel.penalty = penalty;
  kernel.elements = space.elements();  // owned cells are the first ones of these
  kernel.columns = Columns("thixis::dg::weak_columns", kernel.on.size(), space.basis().size());
  kernel.F = Loads("thixis::dg::weak_loads", kernel.on.size(), space.basis().size());
  Kokkos::parallel_for("thixis::dg::weak_loads", Kokkos::RangePolicy<>(0, kernel.on.size()), kernel);
  method::scatter(kernel.columns, 0, kernel.F, F);
}

}  // namespace thixis::dg
