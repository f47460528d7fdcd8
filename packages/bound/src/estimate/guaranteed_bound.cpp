#include "thixis/bound/guaranteed_bound.hpp"

#include <cmath>

#include "estimate/bound_parts.hpp"
#include "estimate/pair_terms.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"

namespace thixis::bound {

using algebra::Vector;
using complementarity::Estimate;
using complementarity::Promise;

struct GuaranteedBound::Impl {
  BoundParts parts;
  bool at_points = false;  ///< FeasiblePair::Parts::at_points of the last iterate, on any rank

  /// The fluxes of a membrane and their norms.
  void equilibrate(const Iterate& iterate, int alpha, const Vector& cut_off) {
    MembraneFlux& of = parts.membrane[alpha];
    parts.lift(*iterate.residual[alpha], of.alg);
    parts.lift(cut_off, of.lin);
    if (of.alg.left + of.lin.left > 0)
      throw core::InputError(
          "mesh: the error is not bounded where nothing holds a piece of the mesh; hold a part of its boundary, or leave the estimate "
          "out.");
    (*of.stress)(iterate.u[alpha], of.w);
    parts.balance(iterate, alpha, {});
    of.measure(iterate.u[alpha]);
  }

  Sums<OfFlux> sum_of_fluxes() const {
    Sums<OfFlux> sum;
    const auto add = parts.empty_cells();
    for (int alpha = 0; alpha < parts.problem.count; ++alpha) {
      FluxTerms terms = flux_terms(parts.membrane[alpha], parts.multiplier.rest());
      terms.add = add;
      sum += sum_over_cells<OfFlux>("thixis::bound::flux_terms", parts.owned(), terms);
    }
    return sum.over(parts.comm());
  }
  /// After the fluxes.
  Sums<OfPair> sum_of_pair() const {
    PairTerms terms;
    terms.whole = parts.pair.whole;
    terms.rest = parts.pair.rest;
    terms.at_nodes = parts.pair.at_nodes;
    terms.contact = parts.pair.contact;
    terms.contact_lin = parts.contact_lin;
    terms.cells = parts.cells;
    return sum_over_cells<OfPair>("thixis::bound::pair_terms", parts.owned(), terms).over(parts.comm());
  }
  Estimate sum_up();
};

/// The bound, its parts, and those of every cell.
Estimate GuaranteedBound::Impl::sum_up() {
  const auto flux = sum_of_fluxes();
  const auto pair = sum_of_pair();
  at_points = parts.comm().any(parts.pair.at_points);
  const double contact = pair[OfPair::contact], of_points = pair[OfPair::contact_at_points];
  Estimate eta;
  eta.total = std::sqrt(flux[OfFlux::whole] + pair[OfPair::whole] + 2 * contact);
  eta.promise = parts.doubts.empty() && !at_points ? Promise::guaranteed : Promise::up_to_quadrature;
  eta.discretization = std::sqrt(flux[OfFlux::disc]) + std::sqrt(pair[OfPair::rest]) + std::sqrt(2 * std::abs(contact - of_points));
  eta.linearization = std::sqrt(flux[OfFlux::lin]) + std::sqrt(pair[OfPair::at_nodes]) + std::sqrt(2 * of_points);
  eta.algebraic = std::sqrt(flux[OfFlux::alg]);
  find_worst_cells(parts.cells, parts.space.mesh(), eta);
  return eta;
}

GuaranteedBound::GuaranteedBound(const method::Space& space, const ContactProblem& problem, const mesh::Hierarchy& hierarchy, int level)
    : impl_(new Impl{{space, problem, hierarchy, level}}) {}
GuaranteedBound::~GuaranteedBound() = default;

Estimate GuaranteedBound::operator()(const Iterate& iterate) {
  BoundParts& parts = impl_->parts;
  Vector above(parts.space.points()), cut_off(parts.space.map());
  parts.multiplier(*iterate.lambda, above, cut_off);
  for (int alpha = 0; alpha < parts.problem.count; ++alpha) {
    impl_->equilibrate(iterate, alpha, cut_off);  // R_lin = (-1)^alpha D min(X3, 0)
    cut_off.scale(-1);
  }
  parts.feasible->evaluate(iterate.u, parts.multiplier.density(), parts.q, parts.pair, negligible * parts.mean_flux_term(),
                           FeasiblePair::Gaps::pressed);
  contact_at_points(parts.space, parts.shares, above, *iterate.gap, parts.contact_lin);
  return impl_->sum_up();
}

const GuaranteedBound::CellParts& GuaranteedBound::cells() const { return impl_->parts.cells; }
std::vector<std::string> GuaranteedBound::doubts() const {
  std::vector<std::string> all = impl_->parts.doubts;
  if (impl_->at_points) all.emplace_back("where membranes come near each other the gap is integrated at points");
  return all;
}
int GuaranteedBound::flux_degree() const { return impl_->parts.q; }

GuaranteedBound::Fluxes GuaranteedBound::fluxes(int alpha) const {
  const MembraneFlux& of = impl_->parts.membrane[alpha];
  return {of.disc, of.lin.sigma, of.alg.sigma, impl_->parts.balanced_density(alpha), of.lin.r, of.alg.r};
}

std::size_t GuaranteedBound::bytes() const { return impl_->parts.bytes(); }

}  // namespace thixis::bound
