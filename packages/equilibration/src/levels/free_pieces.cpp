#include "levels/free_pieces.hpp"

#include <cmath>
#include <numeric>

#include "thixis/mesh/host.hpp"
#include "thixis/method/space.hpp"

namespace thixis::equilibration {

FreePieces::FreePieces(const mesh::Mesh& mesh, const std::vector<bool>& held, const Metrics& metric) : of_cell(mesh.cells, -1) {
  const auto host = mesh::on_host(mesh);
  const auto tag = method::held_vertices(mesh, held);
  const auto det = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), metric);
  std::vector<LocalIndex> above(mesh.vertices);  // towards the one that stands for the piece
  std::iota(above.begin(), above.end(), 0);
  const auto top = [&](LocalIndex v) {
    while (above[v] != v) v = above[v] = above[above[v]];
    return v;
  };
  for (LocalIndex K = 0; K < mesh.cells; ++K)
    for (int i = 1; i < 3; ++i) above[top(host.cell_vertices(K, i))] = top(host.cell_vertices(K, 0));
  std::vector<bool> is_held(mesh.vertices, false);
  for (LocalIndex v = 0; v < mesh.vertices; ++v)
    if (tag[v] >= 0) is_held[top(v)] = true;
  std::vector<int> piece(mesh.vertices, -1);
  for (LocalIndex K = 0; K < mesh.cells; ++K) {
    const LocalIndex v = top(host.cell_vertices(K, 0));
    if (is_held[v]) continue;
    if (piece[v] < 0) {
      piece[v] = static_cast<int>(area.size());
      area.push_back(0);
      vertex.push_back(v);
    }
    of_cell[K] = piece[v];
    area[piece[v]] += det(K).det / 2;
  }
}

double FreePieces::take_means(const CellTable& r, const Metrics& metric) const {
  const auto values = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), r);
  const auto det = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), metric);
  std::vector<double> mean(area.size(), 0.0);
  for (std::size_t K = 0; K < of_cell.size(); ++K)
    if (of_cell[K] >= 0) mean[of_cell[K]] += std::sqrt(0.5) * values(K, 0) / area[of_cell[K]];
  for (std::size_t K = 0; K < of_cell.size(); ++K)
    if (of_cell[K] >= 0) values(K, 0) -= std::sqrt(0.5) * det(K).det * mean[of_cell[K]];
  Kokkos::deep_copy(r, values);
  double square = 0;
  for (std::size_t i = 0; i < area.size(); ++i) square += area[i] * mean[i] * mean[i];
  return std::sqrt(square);
}

}  // namespace thixis::equilibration
