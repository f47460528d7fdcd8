#include "refine/marking.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "thixis/mesh/host.hpp"

namespace thixis::drive {
namespace {

struct Candidate {
  double steps;  ///< eta_K in steps of 1e-6 of the largest one: a whole number
  GlobalIndex id;
};

/// Of this rank, those that count.
std::vector<Candidate> candidates(const mesh::Mesh& mesh, const std::vector<double>& eta) {
  constexpr double resolution = 1e6;
  double largest = 0;
  for (const double value : eta) largest = std::isfinite(value) ? std::max(largest, value) : std::numeric_limits<double>::infinity();
  largest = mesh.comm.max(largest);
  if (!std::isfinite(largest)) throw core::Error(core::ExitCode::internal, "The error estimate of a cell is not a finite number.");
  std::vector<Candidate> found;
  for (LocalIndex K = 0; K < mesh.owned_cells && largest > 0; ++K)
    if (const double steps = std::round(resolution * (eta[K] / largest)); steps > 0) found.push_back({steps, mesh.cell_id[K]});
  return found;
}

/// Σ steps² >= theta² Σ_all steps²; sums of whole numbers, in an order that does not depend on the number of ranks.
std::vector<GlobalIndex> largest_share(std::vector<Candidate> all, double theta) {
  std::sort(all.begin(), all.end(),
            [](const Candidate& a, const Candidate& b) { return a.steps > b.steps || (a.steps == b.steps && a.id < b.id); });
  double wanted = 0, sum = 0;
  for (const Candidate& cell : all) wanted += cell.steps * cell.steps;
  wanted *= theta * theta;
  std::vector<GlobalIndex> ids;
  for (auto cell = all.begin(); cell != all.end() && sum < wanted; ++cell) {
    sum += cell->steps * cell->steps;
    ids.push_back(cell->id);
  }
  return ids;
}

/// Cells (global ids, rising) that are too small to be refined: longest face below 1e-8 of the mesh's width.
std::vector<GlobalIndex> smallest(const mesh::Mesh& mesh) {
  const auto host = mesh::on_host(mesh);
  std::vector<double> corner(4, -std::numeric_limits<double>::infinity());
  for (LocalIndex v = 0; v < mesh.vertices; ++v)
    for (int i = 0; i < 2; ++i) {
      corner[i] = std::max(corner[i], host.coordinates(v, i));
      corner[2 + i] = std::max(corner[2 + i], -host.coordinates(v, i));
    }
  mesh.comm.max(corner);
  const double least = 1e-8 * std::max(corner[0] + corner[2], corner[1] + corner[3]);
  std::vector<GlobalIndex> found;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
    double longest = 0;
    for (int i = 0; i < 3; ++i) {
      const LocalIndex a = host.cell_vertices(K, i), b = host.cell_vertices(K, (i + 1) % 3);
      longest =
          std::max(longest, std::hypot(host.coordinates(b, 0) - host.coordinates(a, 0), host.coordinates(b, 1) - host.coordinates(a, 1)));
    }
    if (longest < least) found.push_back(mesh.cell_id[K]);
  }
  found = mesh.comm.gather(found);
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

std::vector<GlobalIndex> refinable(const mesh::Mesh& mesh, const std::vector<GlobalIndex>& ids) {
  const auto small = smallest(mesh);
  std::vector<GlobalIndex> left;
  std::set_difference(ids.begin(), ids.end(), small.begin(), small.end(), std::back_inserter(left));
  return left;
}

std::vector<GlobalIndex> mark(const mesh::Mesh& mesh, const AdaptParams& params, const std::vector<double>& eta) {
  const auto all = mesh.comm.gather(candidates(mesh, eta));
  if (all.empty()) return {};
  auto ids = params.marking == Marking::dorfler
                 ? largest_share(all, params.theta)
                 : mesh.comm.gather(std::vector<GlobalIndex>(mesh.cell_id.begin(), mesh.cell_id.begin() + mesh.owned_cells));
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::vector<LocalIndex> owned(const mesh::Mesh& mesh, const std::vector<GlobalIndex>& ids) {
  std::vector<LocalIndex> cells;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    if (std::binary_search(ids.begin(), ids.end(), mesh.cell_id[K])) cells.push_back(K);
  return cells;
}

}  // namespace thixis::drive
