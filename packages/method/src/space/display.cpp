#include <array>
#include <cmath>

#include "kernels/polynomial_kernels.hpp"
#include "thixis/method/space.hpp"

namespace thixis::method {
namespace {

/// The p² pieces into which the lattice of a cell divides it, by functions.
std::vector<std::array<int, 3>> pieces_of(const reference::CellBasis& basis) {
  const int p = basis.degree();
  std::vector<int> at((p + 1) * (p + 1));
  for (int l = 0; l < basis.size(); ++l)
    at[std::lround(p * basis.lattice()[2 * l]) * (p + 1) + std::lround(p * basis.lattice()[2 * l + 1])] = l;
  const auto point = [&](int i, int j) { return at[i * (p + 1) + j]; };
  std::vector<std::array<int, 3>> pieces;
  for (int i = 0; i < p; ++i)
    for (int j = 0; i + j < p; ++j) {
      pieces.push_back({point(i, j), point(i + 1, j), point(i, j + 1)});
      if (i + j + 1 < p) pieces.push_back({point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
    }
  return pieces;
}

}  // namespace

output::Grid Space::display() const {
  output::Grid grid;
  const int n = basis_.size(), p = basis_.degree(), c = components();
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), structure_.element_entries);
  const auto point = [&](LocalIndex k, int l) { return entries(k, c * l) / c; };
  grid.global_points = structure_.global_cell_entries / c;
  grid.global_triangles = mesh_.global_cells * p * p;
  grid.points.resize(structure_.cell_entries / c);
  for (LocalIndex e = 0; e < structure_.cell_entries; e += c) {
    grid.point_id.push_back(structure_.entries.id[e] / c);
    grid.point_owner.push_back(structure_.entries.owner[e]);
  }
  const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), cells_);
  for (LocalIndex k = 0; k < cells.extent_int(0); ++k)
    for (int l = 0; l < n; ++l) {
      const double xi = basis_.lattice()[2 * l], eta = basis_.lattice()[2 * l + 1], lambda[3] = {1 - xi - eta, xi, eta};
      for (int d = 0; d < 2; ++d) {
        double& coordinate = grid.points[point(k, l)][d] = 0;
        for (int a = 0; a < 3; ++a) coordinate += lambda[a] * host_.coordinates(host_.cell_vertices(cells(k), a), d);
      }
    }
  const auto pieces = pieces_of(basis_);
  for (LocalIndex K = 0; K < mesh_.owned_cells; ++K)
    for (int s = 0; s < p * p; ++s) {
      grid.triangles.push_back({point(K, pieces[s][0]), point(K, pieces[s][1]), point(K, pieces[s][2])});
      grid.triangle_id.push_back(mesh_.cell_id[K] * p * p + s);
      grid.triangle_owner.push_back(mesh_.comm.rank());
    }
  return grid;
}

std::vector<double> Space::shown(const Coefficients& u, int component) const {
  const int n = basis_.size();
  const auto table = basis_.tabulate(n, basis_.lattice().data());
  const Coefficients values("thixis::method::shown", structure_.entries.size());
  transform(matrix_view("thixis::method::at_lattice", n, n, table.value), mesh_.owned_cells, components(), structure_.element_entries, u,
            values);
  return coefficients_shown(values, component);
}

std::vector<double> Space::coefficients_shown(const Coefficients& u, int component) const {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), u);
  std::vector<double> shown;
  shown.reserve(structure_.cell_entries / components());
  for (LocalIndex e = component; e < structure_.cell_entries; e += components()) shown.push_back(host(e));
  return shown;
}

}  // namespace thixis::method
