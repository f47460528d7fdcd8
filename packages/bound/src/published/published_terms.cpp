#include "published/published_terms.hpp"

#include "data/tables.hpp"
#include "estimate/sums.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::bound {

using method::Coefficients;

CellTable of_vertices(const method::Space& space, const Coefficients& lambda, int q) {
  const auto& basis = space.basis();
  const int functions = basis.size(), n = reference::dimension(q);
  const reference::Modal modal(basis.degree());
  const auto T = matrix_view("thixis::bound::to_modal", functions, functions, to_modal(basis, modal));
  const auto times = times_hats(q);
  const auto metric = metrics(space.mesh(), space.cells());
  const auto entries = space.coefficients().element_entries;
  const CellTable density("thixis::bound::vertex_multiplier", space.cells().extent(0), 3 * n);
  const bool nodal = basis.degree() == 1;
  Kokkos::parallel_for(
      "thixis::bound::vertex_multiplier", Kokkos::RangePolicy<>(0, density.extent_int(0)), KOKKOS_LAMBDA(int k) {
        for (int i = 0; i < 3; ++i) {
          double c[reference::max_functions];
          for (int m = 0; m < functions; ++m) {
            c[m] = 0;
            for (int l = 0; l < functions; ++l) c[m] += T(m, l) * lambda(entries(k, nodal ? i : l));
          }
          for (int m = 0; m < n; ++m) {
            density(k, i * n + m) = 0;
            for (int j = 0; j < functions; ++j) density(k, i * n + m) += metric(k).det * times(i, m, j) * c[j];
          }
        }
      });
  return density;
}

namespace {

struct OfIntegrals {
  enum { positive, negative, rest, contact, whole, count };
};

struct IntegralTerms {
  Kokkos::View<const LocalIndex**, Kokkos::LayoutRight> entries;
  Metrics metric;
  Matrix value;  ///< (point, i)
  View<const double*> weight;
  Coefficients lambda, other, gap;

  KOKKOS_FUNCTION void operator()(int K, Sums<OfIntegrals>& sum) const {
    for (int q = 0; q < value.extent_int(0); ++q) {
      double l = 0, o = 0, g = 0;
      for (int i = 0; i < value.extent_int(1); ++i) {
        const LocalIndex e = entries(K, i);
        l += value(q, i) * lambda(e);
        o += value(q, i) * other(e);
        g += value(q, i) * gap(e);
      }
      const double scale = weight(q) * metric(K).det, above = l > 0 ? l : 0, below = l < 0 ? l : 0;
      sum[OfIntegrals::positive] += scale * above * above;
      sum[OfIntegrals::negative] += scale * below * below;
      sum[OfIntegrals::rest] += scale * (below - o) * (below - o);
      sum[OfIntegrals::contact] += scale * above * g;
      sum[OfIntegrals::whole] += scale * l * g;
    }
  }
};

/// The first of the cells that have an entry, for each of them.
View<const LocalIndex*> first_cells(const Kokkos::View<const LocalIndex**, Kokkos::LayoutRight>& entries, std::size_t count) {
  const View<LocalIndex*> first("thixis::bound::first_cells", count);
  Kokkos::deep_copy(first, entries.extent_int(0));
  Kokkos::parallel_for(
      "thixis::bound::first_cells", Kokkos::RangePolicy<>(0, entries.extent_int(0)), KOKKOS_LAMBDA(int k) {
        for (int l = 0; l < entries.extent_int(1); ++l) Kokkos::atomic_fetch_min(&first(entries(k, l)), k);
      });
  return first;
}

std::vector<double> identity(int n) {
  std::vector<double> I(n * n, 0.0);
  for (int i = 0; i < n; ++i) I[i * n + i] = 1;
  return I;
}

}  // namespace

Integrals integrals(const method::Space& space, const Coefficients& lambda, const Coefficients& other, const Coefficients& gap) {
  const auto rule = reference::triangle_quadrature(reference::max_quadrature_order);
  const auto table = space.basis().tabulate(rule.size(), rule.point.data());
  IntegralTerms terms;
  terms.entries = space.coefficients().element_entries;
  terms.metric = metrics(space.mesh(), space.cells());
  terms.value = matrix_view("thixis::bound::published_rule", rule.size(), space.basis().size(), table.value);
  terms.weight = to_view("thixis::bound::published_weight", rule.weight);
  terms.lambda = lambda;
  terms.other = other;
  terms.gap = gap;
  const auto sum =
      sum_over_cells<OfIntegrals>("thixis::bound::published_integrals", space.mesh().owned_cells, terms).over(space.mesh().comm);
  return {sum[OfIntegrals::positive], sum[OfIntegrals::negative], sum[OfIntegrals::rest], sum[OfIntegrals::contact],
          sum[OfIntegrals::whole]};
}

Coefficients closing(const method::Space& space, const Coefficients& gap, const std::vector<double>& to) {
  const int n = space.basis().size();
  const auto there = matrix_view("thixis::bound::to_compare", n, n, to),
             back = matrix_view("thixis::bound::from_compared", n, n, reference::inverse(n, to));
  const Kokkos::View<const LocalIndex**, Kokkos::LayoutRight> entries = space.coefficients().element_entries;
  const Coefficients closed("thixis::bound::closing", gap.extent(0));
  const View<const LocalIndex*> writer = first_cells(entries, gap.extent(0));
  Kokkos::parallel_for(
      "thixis::bound::closing", Kokkos::RangePolicy<>(0, entries.extent_int(0)), KOKKOS_LAMBDA(int k) {
        double c[reference::max_functions] = {};
        for (int b = 0; b < n; ++b) {
          for (int l = 0; l < n; ++l) c[b] += there(b, l) * gap(entries(k, l));
          c[b] = c[b] > 0 ? 0 : -c[b];
        }
        for (int l = 0; l < n; ++l) {
          if (writer(entries(k, l)) != k) continue;  // cells that share an entry agree on it, up to rounding
          double value = 0;
          for (int b = 0; b < n; ++b) value += back(l, b) * c[b];
          closed(entries(k, l)) = value;
        }
      });
  return closed;
}

Coefficients closing(const method::Space& space, const Coefficients& gap) { return closing(space, gap, identity(space.basis().size())); }

}  // namespace thixis::bound
