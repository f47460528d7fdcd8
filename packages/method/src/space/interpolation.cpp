#include <algorithm>

#include "kernels/polynomial_kernels.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/method/jumps.hpp"
#include "thixis/method/space.hpp"

namespace thixis::method {
namespace {

using algebra::Vector;

/// The entries of a component of the cells' polynomials.
std::vector<LocalIndex> entries_of(const Space& space, int component) {
  std::vector<LocalIndex> entries;
  for (LocalIndex e = component; e < space.coefficients().cell_entries; e += space.components()) entries.push_back(e);
  return entries;
}

}  // namespace

std::vector<double> Space::at_entries(const scene::Field& field, const std::vector<LocalIndex>& entries, double t) const {
  std::vector<double> x(entries.size()), y(entries.size()), values(entries.size());
  for (std::size_t k = 0; k < entries.size(); ++k) {
    x[k] = structure_.entries.point[entries[k]][0];
    y[k] = structure_.entries.point[entries[k]][1];
  }
  field.evaluate({entries.size(), x.data(), y.data()}, t, values.data());
  return values;
}

void Space::interpolate(const Function& u, double t, Vector& values) const {
  THIXIS_ASSERT_EQ(u.components(), components(), "a function for each component");
  Coefficients coefficients("thixis::method::interpolant", structure_.entries.size());
  mesh_.comm.together([&] {
    const auto host = Kokkos::create_mirror_view(coefficients);
    for (int i = 0; i < components(); ++i) {
      const auto entries = entries_of(*this, i);
      const auto value = at_entries(u[i], entries, t);
      for (std::size_t k = 0; k < entries.size(); ++k) host(entries[k]) = value[k];
    }
    Kokkos::deep_copy(coefficients, host);
  });
  if (basis_.family() == reference::Family::bernstein) {
    const Coefficients at_points = coefficients;
    coefficients = Coefficients("thixis::method::interpolant", structure_.entries.size());
    const auto from_values = matrix_view("thixis::method::from_values", basis_.size(), basis_.size(), basis_.from_values());
    transform(from_values, cells_.extent_int(0), components(), structure_.element_entries, at_points, coefficients);
  }
  restrict_to_unknowns(coefficients, values);
  layout_->interpolate_traces(*this, u, t, values);
}

void Space::interpolate_obstacle(const scene::Field& psi, Vector& values) const {
  interpolate(psi, 0, values);  // unknowns on faces, where there are some, stay as these are
  const Coefficients coefficients("thixis::method::obstacle", structure_.entries.size());
  mesh_.comm.together([&] {
    auto value = at_entries(psi, entries_of(*this, 0), 0);
    const auto rule = conforming() ? AtJumps::shared : AtJumps::lowest;
    const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), structure_.element_entries);
    interpolate_with_jumps(basis_, entries, jumps_in_cells(quadrature_, psi, 0), rule, value);
    const auto host = Kokkos::create_mirror_view(coefficients);
    std::copy(value.begin(), value.end(), host.data());
    Kokkos::deep_copy(coefficients, host);
  });
  Vector in_cells(values.getMap());
  restrict_to_unknowns(coefficients, in_cells);
  const auto from = std::as_const(in_cells).getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto to = values.getLocalViewDevice(Tpetra::Access::ReadWrite);
  Kokkos::parallel_for(
      "thixis::method::obstacle", Kokkos::RangePolicy<>(0, algebra::local_size(*points())),
      KOKKOS_LAMBDA(int l) { to(l, 0) = from(l, 0); });
}

}  // namespace thixis::method
