#include "multiplier/multiplier_fit.hpp"

#include "multiplier/contact_vectors.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::bound {
namespace {

using algebra::Vector;

struct AddHeld {
  ConstCellTable held;
  CellTable moments;  ///< in and out
  KOKKOS_FUNCTION void operator()(int k) const {
    for (int l = 0; l < moments.extent_int(1); ++l) moments(k, l) += held(k, l);
  }
};

/// |ours - exact|_K of densities.
struct Distance {
  ConstCellTable ours, exact;
  Metrics metric;
  View<double*> norm;  ///< out, overwritten
  KOKKOS_FUNCTION void operator()(int K) const {
    double square = 0;
    for (int m = 0; m < ours.extent_int(1); ++m) square += (ours(K, m) - exact(K, m)) * (ours(K, m) - exact(K, m));
    norm(K) = Kokkos::Experimental::sqrt(square / metric(K).det);
  }
};

}  // namespace

MultiplierFit::MultiplierFit(const method::Space& space, int q, const View<const bool*>& avoid, const CellShares& shares,
                             const Metrics& metric)
    : space_(space),
      shares_(shares),
      metric_(metric),
      conforming_(space.conforming()),
      fit_(conforming_ ? patchwise_multiplier(space, avoid) : cellwise_multiplier(space)),
      lambda_("thixis::bound::lambda", space.mesh().owned_cells, reference::dimension(q)) {
  if (conforming_) {
    of_vertices_ = CellTable("thixis::bound::patch_lambda", space.cells().extent(0), 3 * reference::dimension(q));
  } else {
    positive_ = shares.make_density("thixis::bound::positive_multiplier");
    rest_ = View<double*>("thixis::bound::rest_of_multiplier", space.mesh().owned_cells);
  }
}

void MultiplierFit::split(const Vector& X3, Vector& above, Vector& below) const { split_multiplier(space_, X3, above, below); }

void MultiplierFit::operator()(const Vector& X3, Vector& above, Vector& cut_off) {
  split(X3, above, cut_off);
  (*fit_)(above, lambda_, of_vertices_);
  if (!conforming_) compare(above);
}

void MultiplierFit::compare(const Vector& above) {
  const Vector on_map = at_unknowns(space_, above);
  if (vanishes(on_map)) {
    Kokkos::deep_copy(positive_, 0);
    return Kokkos::deep_copy(rest_, 0);
  }
  const CellTable& moments = shares_(on_map);
  if (const auto held = fit_->held_moments(); held.extent(0) > 0)
    Kokkos::parallel_for("thixis::bound::held_moments", Kokkos::RangePolicy<>(0, moments.extent_int(0)), AddHeld{held, moments});
  shares_.represent(positive_);
  Kokkos::parallel_for("thixis::bound::compare_multipliers", Kokkos::RangePolicy<>(0, rest_.extent_int(0)),
                       Distance{lambda_, positive_, metric_, rest_});
}

std::size_t MultiplierFit::bytes() const {
  return sizeof(double) * (lambda_.size() + of_vertices_.size() + positive_.size() + rest_.size()) + fit_->bytes();
}

void contact_at_points(const method::Space& space, const CellShares& shares, const Vector& above, const Vector& gap,
                       const View<double*>& out) {
  const Vector product = contact_products(space, above, gap);
  if (vanishes(product)) return Kokkos::deep_copy(out, 0);
  const CellTable& part = shares(product);
  Kokkos::parallel_for(
      "thixis::bound::contact_at_points", Kokkos::RangePolicy<>(0, out.extent_int(0)), KOKKOS_LAMBDA(int K) {
        out(K) = 0;
        for (int l = 0; l < part.extent_int(1); ++l) out(K) += part(K, l);
      });
}

}  // namespace thixis::bound
