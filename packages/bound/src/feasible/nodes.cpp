#include "feasible/nodes.hpp"

#include "thixis/bound/shares.hpp"

namespace thixis::bound {

ContinuousNodes nodes_of(const method::Space& space, const std::vector<bool>& dirichlet) {
  if (!space.conforming()) return continuous_nodes(space.mesh(), space.cells(), space.basis(), space.basis().points(), dirichlet);
  ContinuousNodes nodes{space.coefficients().entries, space.coefficients().element_entries};
  nodes.entries.held = space.numbering().held;
  return nodes;
}

std::vector<double> ways_of_upper(const method::Space& space, const ContinuousNodes& nodes, const std::array<scene::FieldPtr, 2>& tension) {
  const auto host = mesh::on_host(space.mesh());
  const auto of_cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), nodes.of_cells);
  const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.cells());
  const auto& lattice = space.basis().lattice();
  const bool bernstein = space.basis().family() == reference::Family::bernstein;
  const std::size_t count = nodes.entries.size();
  std::vector<double> x(count), y(count);
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
  return ways_of_upper(tension, x, y);
}

}  // namespace thixis::bound
