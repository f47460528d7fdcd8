#include <metis.h>

#include <numeric>

#include "distribute.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::mesh {
namespace {

/// Neighbours of each cell across its faces, as compressed rows.
struct DualGraph {
  std::vector<idx_t> row = {0}, neighbour;
};

DualGraph dual_graph(const Mesh& mesh) {
  const HostMesh host = on_host(mesh);
  DualGraph graph;
  for (LocalIndex K = 0; K < mesh.cells; ++K) {
    for (int i = 0; i < 3; ++i) {
      const LocalIndex other = neighbour(host.face_cells, host.cell_faces(K, i), K);
      if (other >= 0) graph.neighbour.push_back(other);
    }
    graph.row.push_back(static_cast<idx_t>(graph.neighbour.size()));
  }
  return graph;
}

std::vector<int> cut_graph(DualGraph graph, std::vector<idx_t> weight, int ranks) {
  idx_t cells = static_cast<idx_t>(graph.row.size()) - 1, constraints = 1, parts = ranks, edges_cut = 0;
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  // The k-way method is for many parts with many cells each.
  const auto cut = parts <= 8 || cells < 100 * parts ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  std::vector<idx_t> part(cells);
  const int status = cut(&cells, &constraints, graph.row.data(), graph.neighbour.data(), weight.empty() ? nullptr : weight.data(), nullptr,
                         nullptr, &parts, nullptr, nullptr, options, &edges_cut, part.data());
  if (status != METIS_OK) throw core::Error(core::ExitCode::internal, "METIS could not partition the mesh.");
  return std::vector<int>(part.begin(), part.end());
}

}  // namespace

std::vector<int> partition(const Mesh& whole, const core::Comm& comm, const std::vector<LocalIndex>& weight) {
  const int ranks = comm.size();
  std::vector<int> owner(whole.cells, 0);
  if (ranks == 1) return owner;
  if (whole.cells <= ranks) {
    std::iota(owner.begin(), owner.end(), 0);
    return owner;
  }
  return comm.on_root([&] { return cut_graph(dual_graph(whole), {weight.begin(), weight.end()}, ranks); });
}

}  // namespace thixis::mesh
