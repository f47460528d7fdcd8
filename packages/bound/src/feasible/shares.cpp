#include "feasible/shares.hpp"

#include <algorithm>

namespace thixis::bound {

ContinuousNodes nodes_of(const method::Space& space, const std::vector<bool>& dirichlet) {
  if (!space.conforming()) return continuous_nodes(space.mesh(), space.cells(), space.basis(), space.basis().points(), dirichlet);
  ContinuousNodes nodes{space.coefficients().entries, space.coefficients().element_entries};
  nodes.entries.held = space.numbering().held;
  return nodes;
}

std::vector<double> shares(const method::Space& space, const ContinuousNodes& nodes, const std::array<scene::FieldPtr, 2>& tension) {
  const auto host = mesh::on_host(space.mesh());
  const auto of_cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), nodes.of_cells);
  const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.cells());
  const auto& lattice = space.basis().lattice();
  const bool bernstein = space.basis().family() == reference::Family::bernstein;
  const std::size_t count = nodes.entries.size();
  std::vector<double> x(count), y(count), mu[2];
  for (std::size_t e = 0; e < count; ++e) {
    x[e] = nodes.entries.point[e][0];
    y[e] = nodes.entries.point[e][1];
  }
  for (std::size_t k = 0; bernstein && k < of_cells.extent(0); ++k)
    for (int l = 0; l < space.basis().size(); ++l) {
      const double xi = lattice[2 * l], eta = lattice[2 * l + 1], lambda[3] = {1 - xi - eta, xi, eta};
      double place[2] = {0, 0};
      for (int a = 0; a < 3; ++a)
        for (int d = 0; d < 2; ++d) place[d] += lambda[a] * host.coordinates(host.cell_vertices(cells(k), a), d);
      x[of_cells(k, l)] = place[0];
      y[of_cells(k, l)] = place[1];
    }
  for (int alpha = 0; alpha < 2; ++alpha) {
    mu[alpha].resize(count);
    tension[alpha]->evaluate({count, x.data(), y.data()}, 0, mu[alpha].data());
  }
  std::vector<double> share(count);
  for (std::size_t e = 0; e < count; ++e) {
    const double both = mu[0][e] + mu[1][e];
    share[e] = both > 0 ? std::clamp(mu[1][e] / both, 0.0, 1.0) : 0.5;
  }
  return share;
}

}  // namespace thixis::bound
