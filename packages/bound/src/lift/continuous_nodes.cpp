#include "lift/continuous_nodes.hpp"

#include <algorithm>
#include <limits>

namespace thixis::bound {
namespace {

using reference::Entity;

void evaluate_at(const method::Entries& entries, const std::vector<LocalIndex>& some, const scene::Field& field, double time,
                 std::vector<double>& values) {
  std::vector<double> x, y, value(some.size());
  for (const LocalIndex e : some) {
    x.push_back(entries.point[e][0]);
    y.push_back(entries.point[e][1]);
  }
  field.evaluate({some.size(), x.data(), y.data()}, time, value.data());
  for (std::size_t i = 0; i < some.size(); ++i) values[some[i]] = value[i];
}

}  // namespace

std::vector<double> boundary_coefficients(const method::Space& space, const ContinuousNodes& nodes,
                                          const std::vector<scene::FieldPtr>& by_tag, double time) {
  const method::Entries& entries = nodes.entries;
  std::vector<double> values(entries.size(), 0.0);
  for (std::size_t tag = 0; tag < by_tag.size(); ++tag) {
    if (!by_tag[tag]) continue;
    std::vector<LocalIndex> held;
    for (LocalIndex e = 0; e < entries.size(); ++e)
      if (entries.held[e] == static_cast<LocalIndex>(tag)) held.push_back(e);
    evaluate_at(entries, held, *by_tag[tag], time, values);
  }
  const reference::CellBasis& basis = space.basis();
  if (basis.family() != reference::Family::bernstein) return values;
  std::vector<double> coefficients = values;
  const auto of_cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), nodes.of_cells);
  const int n = basis.size();
  for (std::size_t k = 0; k < of_cells.extent(0); ++k)
    for (int l = 0; l < n; ++l) {
      const LocalIndex e = of_cells(k, l);
      if (basis.entities()[l].kind != Entity::face || entries.held[e] < 0) continue;
      coefficients[e] = 0;  // functions that are not on the face do not enter
      for (int m = 0; m < n; ++m) coefficients[e] += basis.from_values()[l * n + m] * values[of_cells(k, m)];
    }
  return coefficients;
}

std::vector<double> obstacle_coefficients(const method::Space& space, const ContinuousNodes& nodes, const scene::Field& psi,
                                          const method::Jumps& jumps) {
  std::vector<LocalIndex> all(nodes.entries.size());
  for (LocalIndex e = 0; e < nodes.entries.size(); ++e) all[e] = e;
  std::vector<double> values(all.size());
  evaluate_at(nodes.entries, all, psi, 0, values);
  const auto of_cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), nodes.of_cells);
  interpolate_with_jumps(space.basis(), of_cells, jumps, space.conforming() ? method::AtJumps::shared : method::AtJumps::lowest, values);
  return values;
}

std::vector<double> majorant(const method::Space& space, const ContinuousNodes& nodes, const method::Jumps& jumps,
                             const std::vector<double>& psi, const std::vector<double>& above) {
  if (!jumps.any()) return {};
  const reference::CellBasis& basis = space.basis();
  const auto& place = basis.family() == reference::Family::bernstein ? basis.lattice() : basis.points();
  const auto host = mesh::on_host(space.mesh());
  const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.cells());
  const auto of_cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), nodes.of_cells);
  const auto each = [&](auto f) {
    for (LocalIndex k = 0; k < static_cast<LocalIndex>(cells.extent(0)); ++k)
      if (jumps.at(k)) f(k, cells(k));
  };
  std::vector<double> top(space.mesh().vertices, -std::numeric_limits<double>::infinity()), highest = psi;
  each([&](LocalIndex k, LocalIndex K) {
    for (int a = 0; a < 3; ++a) top[host.cell_vertices(K, a)] = std::max(top[host.cell_vertices(K, a)], jumps.of_cells[k].high);
  });
  each([&](LocalIndex k, LocalIndex K) {
    for (int l = 0; l < basis.size(); ++l) {
      const double xi = place[2 * l], eta = place[2 * l + 1], lambda[3] = {1 - xi - eta, xi, eta};
      double& value = highest[of_cells(k, l)] = 0;
      for (int a = 0; a < 3; ++a) value += lambda[a] * top[host.cell_vertices(K, a)];
    }
  });
  for (LocalIndex e = 0; e < nodes.entries.size(); ++e)
    if (nodes.entries.held[e] >= 0) highest[e] = std::min(highest[e], above[e]);
  return highest;
}

}  // namespace thixis::bound
