#include "model/probes.hpp"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "thixis/core/error.hpp"
#include "thixis/core/text.hpp"
#include "thixis/fv/host.hpp"

namespace thixis::flow {
namespace {

constexpr double slack = 1e-9;  // of the diameter of a cell: points on its boundary belong to it

bool holds(const fv::Grid& grid, const fv::HostGrid& at, LocalIndex K, double x, double y) {
  const double tolerance = slack * at.diameter(K);
  const auto corner = [&](int i, int direction) { return at.vertex(at.cell_vertices(K, i % grid.corners()), direction); };
  if (grid.dimension == 1) return x >= corner(0, 0) - tolerance && x <= corner(1, 0) + tolerance;
  for (int i = 0; i < grid.corners(); ++i) {
    const double ex = corner(i + 1, 0) - corner(i, 0), ey = corner(i + 1, 1) - corner(i, 1);
    if (ex * (y - corner(i, 1)) - ey * (x - corner(i, 0)) < -tolerance * at.diameter(K)) return false;
  }
  return true;
}

/// Of the cells of all ranks that `key` lets pass (a finite number), the one with the smallest key, then the lowest id; -1 on other
/// ranks. Collective.
template <class Key>
LocalIndex first_cell(const fv::Grid& grid, Key key) {
  constexpr double none = std::numeric_limits<double>::infinity();
  std::pair<double, double> best = {none, none};
  LocalIndex found = -1;
  for (LocalIndex K = 0; K < grid.owned_cells; ++K)
    if (const std::pair<double, double> here = key(K); here < best) best = here, found = K;
  const double first = grid.comm.min(best.first);
  const double second = grid.comm.min(best.first == first ? best.second : none);
  return best == std::pair(first, second) && first < none ? found : -1;
}

}  // namespace

TwoPhaseProbes::TwoPhaseProbes(const fv::Grid& grid, const std::vector<models::Probe>& points) : comm_(grid.comm) {
  const auto at = fv::on_host(grid);
  if (points.empty()) {
    cell_.push_back(first_cell(grid, [&](LocalIndex K) { return std::pair(at.centre(K, 0), at.centre(K, 1)); }));
    return;
  }
  for (const auto& [path, at_point] : points) {
    const auto [x, y] = at_point;
    cell_.push_back(first_cell(grid, [&, x = x, y = y](LocalIndex K) {
      const double none = std::numeric_limits<double>::infinity();
      return holds(grid, at, K, x, y) ? std::pair(static_cast<double>(grid.cell_id[K]), 0.0) : std::pair(none, none);
    }));
    if (!comm_.any(cell_.back() >= 0))
      throw core::InputError(fmt::format("{}: the point ({}{}) lies outside of the mesh; take one inside.", path, core::to_text(x),
                                         grid.dimension == 1 ? "" : ", " + core::to_text(y)));
  }
}

std::vector<std::array<double, unknowns_per_cell>> TwoPhaseProbes::operator()(const algebra::Vector& X) const {
  const auto x = algebra::host_view(X);
  std::vector<double> values(unknowns_per_cell * cell_.size(), 0);
  for (std::size_t i = 0; i < cell_.size(); ++i)
    if (cell_[i] >= 0)
      for (int u = 0; u < unknowns_per_cell; ++u) values[unknowns_per_cell * i + u] = x(unknowns_per_cell * cell_[i] + u);
  comm_.sum(values);
  std::vector<std::array<double, unknowns_per_cell>> states(cell_.size());
  for (std::size_t i = 0; i < cell_.size(); ++i)
    for (int u = 0; u < unknowns_per_cell; ++u) states[i][u] = values[unknowns_per_cell * i + u];
  return states;
}

}  // namespace thixis::flow
