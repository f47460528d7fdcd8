#include "step/step_flux.hpp"

#include "data/tables.hpp"
#include "estimate/square.hpp"
#include "step/way_density.hpp"

namespace thixis::bound {
namespace {

/// Densities of (u - before)/tau on the patch cells.
struct Rate {
  Kokkos::View<const LocalIndex**, Kokkos::LayoutRight> entries;
  method::Coefficients u, before;
  Matrix modal;  ///< (m, l)
  Metrics metric;
  double tau;
  CellTable rate;  ///< out, overwritten
  KOKKOS_FUNCTION void operator()(int k) const {
    const int n = modal.extent_int(0);
    double c[reference::max_functions];
    for (int l = 0; l < n; ++l) c[l] = (u(entries(k, l)) - before(entries(k, l))) * (metric(k).det / tau);
    for (int m = 0; m < n; ++m) {
      rate(k, m) = 0;
      for (int l = 0; l < n; ++l) rate(k, m) += modal(m, l) * c[l];
    }
  }
};

/// |(1 - Pi_q) ∂_t s_N|_K, ∂_t s_N = rate - (averages + closing - moved)/tau; tables of length 0 are 0.
struct RestOfRate {
  ConstCellTable rate;  ///< densities, the others functions
  ConstCellTable averages, closing, moved;
  Metrics metric;
  double tau;
  int first;           ///< dim P_q
  View<double*> norm;  ///< out, overwritten
  KOKKOS_FUNCTION void operator()(int K) const {
    double square = 0;
    for (int m = first; m < rate.extent_int(1); ++m) {
      double value = rate(K, m) / metric(K).det;
      if (averages.extent(0) > 0) value -= averages(K, m) / tau;
      if (closing.extent(0) > 0) value -= closing(K, m) / tau;
      if (moved.extent(0) > 0) value += moved(K, m) / tau;
      square += value * value;
    }
    norm(K) = root(square * metric(K).det);
  }
};

}  // namespace

StepFlux::StepFlux(const BoundParts& parts) {
  const method::Space& space = parts.space;
  const int functions = space.basis().size();
  modal_ = matrix_view("thixis::bound::to_modal", functions, functions, to_modal(space.basis(), reference::Modal(space.basis().degree())));
  remaining_ = CellTable("thixis::bound::remaining", parts.owned(), functions);
  extra_ = CellTable("thixis::bound::extra_flux", parts.owned(), 2 * reference::dimension(parts.q + 1));
  for (int alpha = 0; alpha < parts.problem.count; ++alpha) {
    of_[alpha].rate = CellTable("thixis::bound::rate", space.cells().extent(0), functions);
    of_[alpha].change = View<double*>("thixis::bound::change_in_step", parts.owned());
    if (!space.conforming()) of_[alpha].of_rate = View<double*>("thixis::bound::rest_of_rate", parts.owned());
  }
}

void StepFlux::operator()(BoundParts& parts, const StepBegin& before, const Iterate& iterate, const FeasiblePair::Way& way, int alpha,
                          const algebra::Vector& cut_off) {
  MembraneFlux& m = parts.membrane[alpha];
  const StepBegin::Membrane& then = before.membrane[alpha];
  Membrane& of = of_[alpha];
  const auto& u = iterate.u[alpha];
  lift_residuals(parts, before.tau(), iterate, way, alpha, cut_off);
  Rate rate;
  rate.entries = parts.space.coefficients().element_entries;
  rate.u = u;
  rate.before = then.u;
  rate.modal = modal_;
  rate.metric = parts.metric;
  rate.tau = before.tau();
  rate.rate = of.rate;
  Kokkos::parallel_for("thixis::bound::rate", Kokkos::RangePolicy<>(0, of.rate.extent_int(0)), rate);
  (*m.stress)(u, m.w);
  parts.balance(iterate, alpha, of.rate);
  add_moved(parts, before, way, alpha);
  m.stress->norms_between(u, m.w, then.u, then.w, m.fluxes(), m.norms, of.change);
  if (of.of_rate.extent(0) == 0) return;
  RestOfRate rest;
  rest.rate = of.rate;
  rest.averages = way.averages[alpha];
  rest.closing = way.closing[alpha];
  rest.moved = then.moved;
  rest.metric = parts.metric;
  rest.tau = before.tau();
  rest.first = reference::dimension(parts.q);
  rest.norm = of.of_rate;
  Kokkos::parallel_for("thixis::bound::rest_of_rate", Kokkos::RangePolicy<>(0, parts.owned()), rest);
}

/// The linearization takes in what closing the gaps at the nodes adds to the rate of change.
void StepFlux::lift_residuals(BoundParts& parts, double tau, const Iterate& iterate, const FeasiblePair::Way& way, int alpha,
                              const algebra::Vector& cut_off) {
  MembraneFlux& m = parts.membrane[alpha];
  parts.lift(*iterate.residual[alpha], m.alg);
  if (!density_of(parts.metric, 1 / tau, way.closing[alpha], 0, {}, remaining_)) return parts.lift(cut_off, m.lin);
  parts.lift.represent(cut_off, m.lin);
  add(1, m.lin.r, remaining_);
  parts.lift.lift(remaining_, m.lin);
}

/// And the discretization what the averages add, and what the pair at the begin is away from u_h.
void StepFlux::add_moved(const BoundParts& parts, const StepBegin& before, const FeasiblePair::Way& way, int alpha) {
  const StepBegin::Membrane& then = before.membrane[alpha];
  const CellTable& disc = parts.membrane[alpha].disc;
  of_[alpha].left = then.left;
  if (then.sigma.extent(0) > 0) add(1, then.sigma, disc);
  if (parts.discretization.on_patches() ||
      !density_of(parts.metric, 1 / before.tau(), way.averages[alpha], -1 / before.tau(), then.moved, remaining_))
    return;
  of_[alpha].left = parts.lift.flux(remaining_, extra_);
  add(1, extra_, disc);
}

FluxTerms StepFlux::terms(const BoundParts& parts, int alpha) const {
  FluxTerms terms = flux_terms(parts.membrane[alpha], parts.multiplier.rest());
  terms.of_rate = of_[alpha].of_rate;
  terms.change = of_[alpha].change;
  return terms;
}

CellTable StepFlux::lifted(const BoundParts& parts, const StepBegin& before, const FeasiblePair::Way& way, int alpha) const {
  const CellTable density("thixis::bound::residual_lin", parts.owned(), reference::dimension(parts.q));
  add(1, parts.membrane[alpha].lin.r, density);
  if (density_of(parts.metric, 1 / before.tau(), way.closing[alpha], 0, {}, remaining_)) add(1, remaining_, density);
  return density;
}

CellTable StepFlux::balanced(const BoundParts& parts, const StepBegin& before, const FeasiblePair::Way& way, int alpha) const {
  const CellTable density = parts.balanced_density(alpha);
  add(-1, of_[alpha].rate, density);
  if (density_of(parts.metric, 1 / before.tau(), way.averages[alpha], 1 / before.tau(), way.closing[alpha], remaining_))
    add(1, remaining_, density);
  if (density_of(parts.metric, -1 / before.tau(), before.membrane[alpha].moved, 0, {}, remaining_)) add(1, remaining_, density);
  return density;
}

std::size_t StepFlux::bytes() const {
  std::size_t tables = remaining_.size() + extra_.size();
  for (const Membrane& of : of_) tables += of.rate.size() + of.change.size() + of.of_rate.size();
  return sizeof(double) * tables;
}

}  // namespace thixis::bound
