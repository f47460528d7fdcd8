#include "marking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

}  // namespace

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
