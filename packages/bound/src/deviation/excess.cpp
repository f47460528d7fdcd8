#include "data/on_host.hpp"
#include "deviation/deviation.hpp"
#include "deviation/deviation_points.hpp"
#include "thixis/method/cell_functions.hpp"

namespace thixis::bound {

Excess excess_of_majorant(const method::Space& space, const ContinuousNodes& nodes, const scene::Field& obstacle,
                          const std::vector<double>& majorant, const method::Jumps& jumps) {
  const mesh::Mesh& mesh = space.mesh();
  std::vector<LocalIndex> positions;
  for (LocalIndex k = 0; k < mesh.owned_cells; ++k)
    if (jumps.at(k)) positions.push_back(k);
  if (positions.empty()) return {};
  const auto of_cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), nodes.of_cells);
  const auto functions = method::cell_functions(space.basis());
  const reference::Modal modal(space.basis().degree());
  const int n = space.basis().size();
  Excess excess{nowhere(mesh), CellTable("thixis::bound::excess", positions.size(), n)};
  const auto quadrature = subset(space.quadrature(), positions);
  const View<double*> psi("thixis::bound::obstacle", quadrature.largest_block);
  method::for_each_block(quadrature, [&](const method::QuadratureBlock& block) {
    method::evaluate(obstacle, 0, block, psi);
    for (LocalIndex k = 0; k < block.cells; ++k) {
      const LocalIndex K = block.cell(k), at = block.first + k;
      excess.place(K) = at;
      double local[reference::max_functions], c[reference::max_functions], area = 0;
      for (int l = 0; l < n; ++l) local[l] = majorant[of_cells(K, l)];
      functions.to_bernstein(local, c);
      for (int q = block.offset(k); q < block.offset(k + 1); ++q) area += block.weight(q);
      for (int q = block.offset(k); q < block.offset(k + 1); ++q) {
        const double xi = block.xi(q, 0), eta = block.xi(q, 1), lambda[3] = {1 - xi - eta, xi, eta};
        const double above = block.weight(q) / (2 * area) * (functions.B.value(c, lambda) - psi(q));
        const auto phi = modal.values(1, &block.xi(q, 0));
        for (int m = 0; m < n; ++m) excess.moments(at, m) += above * phi[m];
      }
    }
  });
  return excess;
}

}  // namespace thixis::bound
