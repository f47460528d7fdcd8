#include "multiplier/held_moments.hpp"

#include <map>

#include "data/tables.hpp"
#include "multiplier/least_squares.hpp"
#include "multiplier/multiplier_fits.hpp"

namespace thixis::bound {
namespace {

struct Fill {
  Kokkos::View<const LocalIndex**, Kokkos::LayoutRight> entries;
  View<const LocalIndex*> cells;
  View<const int*> pattern;
  Kokkos::View<const double***, Kokkos::LayoutRight> fit, held;
  View<const double*> moment;
  CellTable out;  ///< overwritten in these cells

  KOKKOS_FUNCTION void operator()(int i) const {
    const LocalIndex k = cells(i);
    const int at = pattern(i), n = out.extent_int(1), coefficients = fit.extent_int(1);
    double B[most_coefficients], mean = 0, lowest = 0;
    for (int b = 0; b < coefficients; ++b) {
      B[b] = 0;
      for (int l = 0; l < n; ++l) B[b] += fit(at, b, l) * moment(entries(k, l));
      mean += B[b] / coefficients;
      lowest = B[b] < lowest ? B[b] : lowest;
    }
    const double part = mean <= 0 ? 0 : mean / (mean - lowest);
    double of_free = 0, of_held = 0;
    for (int l = 0; l < n; ++l) {
      double sum = 0;
      for (int b = 0; b < coefficients && mean > 0; ++b) sum += held(at, l, b) * (part * B[b] + (1 - part) * mean);
      out(k, l) = sum;
      of_held += sum;
      of_free += moment(entries(k, l));
    }
    // the moments sum to the mean of the cell, which is not to be negative
    for (int l = 0; l < n && of_free + of_held < 0; ++l) out(k, l) *= of_free / -of_held;
  }
};

/// (l, b): (B_b, psi_l) on the reference triangle, B_b the Bernstein polynomials of a degree up to p.
std::vector<double> against_bernstein(const reference::CellBasis& basis, const reference::Bernstein& B) {
  const reference::Modal modal(basis.degree());
  const int n = basis.size();
  const auto T = bernstein_to_modal(B, modal, n), psi = to_modal(basis, modal);
  std::vector<double> A(n * B.size, 0.0);
  for (int l = 0; l < n; ++l)
    for (int b = 0; b < B.size; ++b)
      for (int m = 0; m < n; ++m) A[l * B.size + b] += psi[m * n + l] * T[m * B.size + b];
  return A;
}

/// (b, c): Bernstein coefficients of a lower degree -> those of a higher one.
std::vector<double> elevation(const reference::Bernstein& low, const reference::Bernstein& high) {
  const auto lattice = bernstein_lattice(high), coefficients = from_lattice(high);
  std::vector<double> E(high.size * low.size, 0.0);
  for (int v = 0; v < high.size; ++v) {
    double value[reference::max_functions];
    low.values({lattice[3 * v], lattice[3 * v + 1], lattice[3 * v + 2]}, value);
    for (int b = 0; b < high.size; ++b)
      for (int c = 0; c < low.size; ++c) E[b * low.size + c] += coefficients[b * high.size + v] * value[c];
  }
  return E;
}

/// (b, l): moments against the functions that are not held -> coefficients of degree p - 1; 0 where there is no such function.
std::vector<double> fit_of(const reference::CellBasis& basis, const std::vector<bool>& held) {
  const auto high = reference::bernstein(basis.degree() - 1);
  const int n = basis.size();
  std::vector<double> fit(high.size * n, 0.0);
  for (int degree = basis.degree() - 1; degree >= 0; --degree) {
    const auto low = reference::bernstein(degree);
    const auto all = against_bernstein(basis, low);
    std::vector<double> A, F;
    std::vector<int> free;
    for (int l = 0; l < n; ++l) {
      if (held[l]) continue;
      free.push_back(l);
      A.insert(A.end(), all.begin() + l * low.size, all.begin() + (l + 1) * low.size);
    }
    if (static_cast<int>(free.size()) < low.size || !append_fit(A, static_cast<LocalIndex>(free.size()), low.size, F)) continue;
    const auto E = elevation(low, high);
    for (int b = 0; b < high.size; ++b)
      for (std::size_t i = 0; i < free.size(); ++i)
        for (int c = 0; c < low.size; ++c) fit[b * n + free[i]] += E[b * low.size + c] * F[c * free.size() + i];
    break;
  }
  return fit;
}

}  // namespace

HeldMoments::HeldMoments(const method::Space& space) : entries_(space.coefficients().element_entries) {
  const reference::CellBasis& basis = space.basis();
  const int n = basis.size();
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), entries_);
  std::map<std::vector<bool>, int> number;
  std::vector<LocalIndex> cells;
  std::vector<int> pattern;
  for (LocalIndex k = 0; k < static_cast<LocalIndex>(entries.extent(0)); ++k) {
    std::vector<bool> held(n, false);
    bool any = false;
    for (int l = 0; l < n; ++l) any = (held[l] = space.numbering().held[entries(k, l)] >= 0) || any;
    if (!any) continue;
    cells.push_back(k);
    pattern.push_back(number.emplace(held, static_cast<int>(number.size())).first->second);
  }
  if (cells.empty()) return;
  cells_ = to_view("thixis::bound::cells_with_held", cells);
  pattern_ = to_view("thixis::bound::pattern_of_held", pattern);
  of_cells_ = CellTable("thixis::bound::held_moments", entries.extent(0), n);
  const auto B = reference::bernstein(basis.degree() - 1);
  fit_ = Kokkos::View<double***, Kokkos::LayoutRight>("thixis::bound::fit_of_free", number.size(), B.size, n);
  held_ = Kokkos::View<double***, Kokkos::LayoutRight>("thixis::bound::held_from_fit", number.size(), n, B.size);
  const auto fit_host = Kokkos::create_mirror_view(fit_), held_host = Kokkos::create_mirror_view(held_);
  const auto A = against_bernstein(basis, B);
  for (const auto& [held, at] : number) {
    const auto fit = fit_of(basis, held);
    for (int l = 0; l < n; ++l)
      for (int b = 0; b < B.size; ++b) {
        fit_host(at, b, l) = fit[b * n + l];
        if (held[l]) held_host(at, l, b) = A[l * B.size + b];
      }
  }
  Kokkos::deep_copy(fit_, fit_host);
  Kokkos::deep_copy(held_, held_host);
}

void HeldMoments::operator()(const View<const double*>& moments) const {
  Fill kernel;
  kernel.entries = entries_;
  kernel.cells = cells_;
  kernel.pattern = pattern_;
  kernel.fit = fit_;
  kernel.held = held_;
  kernel.moment = moments;
  kernel.out = of_cells_;
  Kokkos::parallel_for("thixis::bound::held_moments", Kokkos::RangePolicy<>(0, cells_.extent(0)), kernel);
}

}  // namespace thixis::bound
