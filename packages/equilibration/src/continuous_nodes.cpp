#include "continuous_nodes.hpp"

namespace thixis::equilibration {
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

std::vector<double> boundary_coefficients(const method::PolynomialSpace& space, const ContinuousNodes& nodes,
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

std::vector<double> interpolant(const method::PolynomialSpace& space, const ContinuousNodes& nodes, const scene::Field& field) {
  std::vector<LocalIndex> all(nodes.entries.size());
  for (LocalIndex e = 0; e < nodes.entries.size(); ++e) all[e] = e;
  std::vector<double> values(all.size());
  evaluate_at(nodes.entries, all, field, 0, values);
  const reference::CellBasis& basis = space.basis();
  if (basis.family() != reference::Family::bernstein) return values;
  std::vector<double> coefficients = values;
  const auto of_cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), nodes.of_cells);
  const int n = basis.size();
  for (std::size_t k = 0; k < of_cells.extent(0); ++k)
    for (int l = 0; l < n; ++l) {
      double sum = 0;
      for (int m = 0; m < n; ++m) sum += basis.from_values()[l * n + m] * values[of_cells(k, m)];
      coefficients[of_cells(k, l)] = sum;
    }
  return coefficients;
}

}  // namespace thixis::equilibration
