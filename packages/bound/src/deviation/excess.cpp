#include "data/on_host.hpp"
#include "deviation/deviation.hpp"
#include "deviation/deviation_points.hpp"

namespace thixis::bound {

Excess excess_of_majorant(const method::Space& space, const ContinuousNodes& nodes, const scene::Field& obstacle,
                          const std::vector<double>& majorant, const method::Jumps& jumps) {
  const mesh::Mesh& mesh = space.mesh();
  std::vector<LocalIndex> positions;
  for (LocalIndex k = 0; k < mesh.owned_cells; ++k)
    if (jumps.at(k)) positions.push_back(k);
  if (positions.empty()) return {};
  const auto of_cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), nodes.of_cells);
  const reference::Modal modal(space.basis().degree());
  const int n = space.basis().size();
  const Excess excess{nowhere(mesh), CellTable("thixis::bound::excess", positions.size(), n)};
  const auto place = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), excess.place);
  const auto moments = Kokkos::create_mirror_view(excess.moments);
  const auto quadrature = subset(space.quadrature(), positions);
  const View<double*> psi("thixis::bound::obstacle", quadrature.largest_block);
  method::for_each_block(quadrature, [&](const method::QuadratureBlock& block) {
    method::evaluate(obstacle, 0, block, psi);
    const auto cell = on_host(block.cell);
    const auto offset = on_host(block.offset);
    const auto xi = on_host(block.xi);
    const auto weight = on_host(block.weight), value = on_host(View<const double*>(psi));
    for (LocalIndex k = 0; k < block.cells; ++k) {
      const LocalIndex K = cell(k), at = block.first + k;
      place(K) = at;
      double local[reference::max_functions], c[reference::max_functions], area = 0;
      for (int l = 0; l < n; ++l) local[l] = majorant[of_cells(K, l)];
      space.basis().to_bernstein(local, c);
      for (int q = offset(k); q < offset(k + 1); ++q) area += weight(q);
      for (int q = offset(k); q < offset(k + 1); ++q) {
        const double lambda[3] = {1 - xi(q, 0) - xi(q, 1), xi(q, 0), xi(q, 1)};
        const double above = weight(q) / (2 * area) * (space.basis().bernstein().value(c, lambda) - value(q));
        const auto phi = modal.values(1, &xi(q, 0));
        for (int m = 0; m < n; ++m) moments(at, m) += above * phi[m];
      }
    }
  });
  Kokkos::deep_copy(excess.place, place);
  Kokkos::deep_copy(excess.moments, moments);
  return excess;
}

}  // namespace thixis::bound
