#include <metis.h>

#include <algorithm>
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

/// The weight of the heaviest part over that of the mean one.
double imbalance(const std::vector<LocalIndex>& weight, const std::vector<int>& part, int parts) {
  std::vector<GlobalIndex> load(parts, 0);
  for (std::size_t K = 0; K < part.size(); ++K) load[part[K]] += weight[K];
  const GlobalIndex total = std::accumulate(load.begin(), load.end(), GlobalIndex{0});
  return static_cast<double>(*std::max_element(load.begin(), load.end())) * parts / static_cast<double>(total);
}

/// Gives each part the number, 0..parts-1, of an old part with which it has much in common: the largest intersections first.
void keep_numbers(const std::vector<LocalIndex>& weight, const std::vector<int>& old, int parts, std::vector<int>& part) {
  struct Intersection {
    GlobalIndex weight;
    int old, part;
  };
  std::vector<Intersection> common(static_cast<std::size_t>(parts) * parts);
  for (int o = 0; o < parts; ++o)
    for (int p = 0; p < parts; ++p) common[o * parts + p] = {0, o, p};
  for (std::size_t K = 0; K < part.size(); ++K) common[old[K] * parts + part[K]].weight += weight[K];
  std::stable_sort(common.begin(), common.end(), [](const Intersection& a, const Intersection& b) { return a.weight > b.weight; });

  std::vector<int> number(parts, -1);
  std::vector<char> given(parts, 0);
  for (const Intersection& c : common)
    if (number[c.part] < 0 && !given[c.old]) {
      number[c.part] = c.old;
      given[c.old] = 1;
    }
  for (int& p : part) p = number[p];
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

std::vector<int> repartition(const Mesh& whole, const core::Comm& comm, const std::vector<LocalIndex>& weight,
                             const std::vector<int>& owner) {
  constexpr double tolerated = 1.05;
  if (imbalance(weight, owner, comm.size()) <= tolerated) return owner;
  std::vector<int> part = partition(whole, comm, weight);
  keep_numbers(weight, owner, comm.size(), part);
  return part;
}

}  // namespace thixis::mesh
