#include "data/tension_bounds.hpp"

#include <algorithm>

#include "data/cell_energy.hpp"
#include "data/on_host.hpp"
#include "data/tables.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/method/gradient_form.hpp"

namespace thixis::bound {
namespace {

/// Places inside of the reference triangle, where pieces that meet at faces are told apart, and the way from values there to Bernstein
/// coefficients, (k, m).
struct Fit {
  std::vector<double> xi, to_coefficients;

  explicit Fit(const reference::CellBasis& basis) : xi(basis.lattice()) {
    const int n = basis.size();
    std::vector<double> B(n * n);
    for (double& coordinate : xi) coordinate = (1 + 8 * coordinate) / 11;
    for (int m = 0; m < n; ++m) {
      const double lambda[3] = {1 - xi[2 * m] - xi[2 * m + 1], xi[2 * m], xi[2 * m + 1]};
      basis.bernstein().values(lambda, &B[m * n]);
    }
    to_coefficients = reference::inverse(n, B);
  }
};

/// (cell, k): Bernstein coefficients of a polynomial in the owned cells. Throws on this rank only.
std::vector<double> coefficients(const method::Space& space, const scene::Field& field, const reference::CellBasis& basis) {
  const auto host = mesh::on_host(space.mesh());
  const LocalIndex owned = space.mesh().owned_cells;
  const int n = basis.size();
  const Fit fit(basis);
  std::vector<double> x, y;
  for (LocalIndex K = 0; K < owned; ++K)
    for (int m = 0; m < n; ++m) {
      const double xi = fit.xi[2 * m], eta = fit.xi[2 * m + 1], lambda[3] = {1 - xi - eta, xi, eta};
      double place[2] = {0, 0};
      for (int a = 0; a < 3; ++a)
        for (int d = 0; d < 2; ++d) place[d] += lambda[a] * host.coordinates(host.cell_vertices(K, a), d);
      x.push_back(place[0]);
      y.push_back(place[1]);
    }
  std::vector<double> value(x.size()), c(x.size(), 0.0);
  field.evaluate({x.size(), x.data(), y.data()}, 0, value.data());
  for (LocalIndex K = 0; K < owned; ++K)
    for (int k = 0; k < n; ++k)
      for (int m = 0; m < n; ++m) c[K * n + k] += fit.to_coefficients[k * n + m] * value[K * n + m];
  return c;
}

/// sum_k B_k/b_k at the points of a cell in place of 1/mu, where all b_k are positive.
struct BoundInverse {
  method::CellQuadrature quadrature;
  reference::Bernstein B;
  ConstCellTable b;
  View<double*> inverse;  ///< in and out
  KOKKOS_FUNCTION void operator()(int K) const {
    double reciprocal[reference::max_functions];
    for (int k = 0; k < B.size; ++k) {
      if (b(K, k) <= 0) return;
      reciprocal[k] = 1 / b(K, k);
    }
    const PointsOf points(quadrature, K);
    for (int q = 0; q < points.count; ++q) {
      const double xi = points.xi(q, 0), eta = points.xi(q, 1), lambda[3] = {1 - xi - eta, xi, eta};
      inverse(points.first + q) = B.value(reciprocal, lambda);
    }
  }
};

/// The least and the largest value at the points of a cell.
struct RangeOfCells {
  View<const GlobalIndex*> offset;
  View<const double*> mu;
  View<double* [2]> range;  ///< out, overwritten
  KOKKOS_FUNCTION void operator()(int K) const {
    double least = mu(offset(K)), most = least;
    for (GlobalIndex p = offset(K) + 1; p < offset(K + 1); ++p) {
      least = mu(p) < least ? mu(p) : least;
      most = mu(p) > most ? mu(p) : most;
    }
    range(K, 0) = least;
    range(K, 1) = most;
  }
};

TensionBounds at_points(const method::Space& space, const scene::Field& tension) {
  const LocalIndex owned = space.mesh().owned_cells;
  const auto& quadrature = space.quadrature();
  const View<const double*> mu = method::tension_at_points(space.mesh(), quadrature, tension);
  const View<double*> inverse("thixis::bound::inverse_tension", mu.extent(0));
  Kokkos::parallel_for(
      "thixis::bound::inverse_tension", Kokkos::RangePolicy<>(0, mu.extent_int(0)), KOKKOS_LAMBDA(int p) { inverse(p) = 1 / mu(p); });
  const View<double* [2]> range("thixis::bound::range_of_tension", owned);
  Kokkos::parallel_for("thixis::bound::range_of_tension", Kokkos::RangePolicy<>(0, owned), RangeOfCells{quadrature.offset, mu, range});
  TensionBounds bounds{std::vector<double>(owned), std::vector<double>(owned), mu, inverse, false};
  const auto of_cells = on_host(range);
  for (LocalIndex K = 0; K < owned; ++K) {
    bounds.least[K] = of_cells(K, 0);
    bounds.most[K] = of_cells(K, 1);
  }
  return bounds;
}

}  // namespace

TensionBounds tension_bounds(const method::Space& space, const scene::Field& tension) {
  const LocalIndex owned = space.mesh().owned_cells;
  if (const double* constant = tension.constant())
    return {std::vector<double>(owned, *constant), std::vector<double>(owned, *constant), {}, {}, true};
  TensionBounds bounds = at_points(space, tension);
  const core::Comm& comm = space.mesh().comm;
  const auto degree = tension.degree();
  const bool cut = comm.any(space.quadrature().cut_cells() > 0);
  if (!degree || degree->space > reference::max_degree || (cut && !degree->whole)) return bounds;
  bounds.proved = true;
  if (degree->space == 0) return bounds;

  const reference::CellBasis basis(degree->space, reference::Family::bernstein);
  const int n = basis.size();
  const auto b = comm.together([&] { return coefficients(space, tension, basis); });
  for (LocalIndex K = 0; K < owned; ++K) {
    const auto [least, most] = std::minmax_element(b.begin() + K * n, b.begin() + (K + 1) * n);
    if (*least <= 0) {
      bounds.proved = false;
      continue;
    }
    bounds.least[K] = *least;
    bounds.most[K] = *most;
  }
  const auto table = matrix_view("thixis::bound::tension_coefficients", owned, n, b);
  Kokkos::parallel_for("thixis::bound::bound_inverse", Kokkos::RangePolicy<>(0, owned),
                       BoundInverse{space.quadrature(), basis.bernstein(), table, bounds.inverse});
  bounds.proved = !comm.any(!bounds.proved);
  return bounds;
}

}  // namespace thixis::bound
