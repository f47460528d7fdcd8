#include <algorithm>
#include <cmath>

#include "data/on_host.hpp"
#include "data/tables.hpp"
#include "feasible/pair_on_mesh.hpp"

namespace thixis::bound {
namespace {

/// The norms of the function with these coefficients, and the difference of both membranes.
struct BulgeOfCells {
  FeasibleParts parts;
  Matrix modal;
  View<const double*> upper, lower;
  FeasiblePair::Bulge bulge;  ///< out; the gap is added to

  KOKKOS_FUNCTION void operator()(int K) const {
    const mesh::CellGeometry geometry = mesh::cell_geometry(parts.x, parts.vertices, K);
    const int n = parts.functions.size();
    double square = 0;
    for (int alpha = 0; alpha < parts.count; ++alpha) {
      const View<const double*>& coefficients = alpha == 0 ? upper : lower;
      double local[reference::max_functions], c[reference::max_functions], mass = 0;
      for (int l = 0; l < n; ++l) local[l] = coefficients(parts.of_cells(K, l));
      parts.functions.to_bernstein(local, c);
      square += parts.energy(alpha, K, geometry, c);
      for (int m = 0; m < n; ++m) {
        double value = 0;
        for (int l = 0; l < n; ++l) value += modal(m, l) * local[l];
        mass += value * value;
        bulge.gap(K, m) += alpha == 0 ? value : -value;
      }
      bulge.size(K, alpha) = Kokkos::Experimental::sqrt(2 * geometry.area * mass);
    }
    bulge.energy(K) = Kokkos::Experimental::sqrt(square > 0 ? square : 0);
  }
};

/// d = g - (first + last)/2 at the nodes, and how large it and the data are on this rank.
struct Middle {
  std::vector<double> d;
  double most = 0, size = 0;

  Middle() = default;
  Middle(std::vector<double> g, const View<const double*>& begin, const View<const double*>& end) : d(std::move(g)) {
    const auto first = on_host(begin), last = on_host(end);
    for (std::size_t e = 0; e < d.size(); ++e) {
      size = std::max(size, std::abs(d[e]));
      d[e] -= 0.5 * (first(e) + last(e));
      most = std::max(most, std::abs(d[e]));
    }
  }
};

}  // namespace

FeasiblePair::Bulge FeasiblePair::bulge(const FeasiblePair& before, const FeasiblePair& after) const {
  const method::Space& space = impl_->space;
  const core::Comm& comm = space.mesh().comm;
  const int count = impl_->problem.count;
  Middle middle[2];
  double size = 0;
  comm.together([&] {
    for (int alpha = 0; alpha < count; ++alpha) {
      const auto& data = impl_->problem.boundary[alpha].dirichlet;
      middle[alpha] = Middle(boundary_coefficients(space, impl_->nodes, data, impl_->problem.time), before.impl_->data[alpha],
                             after.impl_->data[alpha]);
      for (const auto& g : data)
        if (g) size = std::max(size, g->cancelled());
    }
  });
  size = std::max({size, middle[0].size, middle[1].size});
  if (comm.max(std::max(middle[0].most, middle[1].most)) <= 1e-13 * comm.max(size)) return {};
  const LocalIndex cells = space.mesh().owned_cells;
  BulgeOfCells of;
  of.parts = impl_->kernel;
  of.modal = impl_->modal;
  of.upper = to_view("thixis::bound::bulge", middle[0].d);
  of.lower = to_view("thixis::bound::bulge", middle[1].d);
  of.bulge = {View<double*>("thixis::bound::bulge_energy", cells), View<double* [2]>("thixis::bound::bulge_size", cells),
              CellTable("thixis::bound::bulge_gap", cells, space.basis().size())};
  Kokkos::parallel_for("thixis::bound::bulge", Kokkos::RangePolicy<>(0, cells), of);
  return of.bulge;
}

}  // namespace thixis::bound
