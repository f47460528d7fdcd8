#include "step/step_evaluation.hpp"

#include <cmath>

#include "data/change_of_force.hpp"
#include "estimate/exactness.hpp"
#include "estimate/square.hpp"
#include "step/distance.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::bound {

using algebra::Vector;
using complementarity::Promise;
using method::Coefficients;

StepEvaluation::StepEvaluation(const method::Space& space, const ContactProblem& problem, const mesh::Hierarchy& hierarchy, int level,
                               std::optional<double> friedrichs)
    : parts_(space, problem, hierarchy, level),
      setting_(parts_, friedrichs),
      flux_(parts_),
      contact_before_("thixis::bound::contact_before", parts_.owned()),
      move_change_("thixis::bound::move_change", parts_.owned()) {}

std::shared_ptr<const FeasiblePair> StepEvaluation::pair_at(double time) const {
  if (setting_.steady_boundary || parts_.feasible->time() == time) return parts_.feasible;
  return parts_.feasible->at(time);
}

std::array<double, 2> StepEvaluation::distance(double time, const Coefficients (&u)[2]) {
  parts_.feasible = pair_at(time);
  return bound::distance(parts_, *parts_.feasible, u, move_change_);
}

void StepEvaluation::start(double begin, double end, const Coefficients (&u)[2]) {
  before_.begin = begin;
  before_.end = end;
  before_.feasible = parts_.feasible = pair_at(begin);
  parts_.feasible = pair_at(end);
  begin_step(parts_, u, flux_.scratch(), before_);
  change_data();
}

void StepEvaluation::change_data() {
  const FeasiblePair& then = *before_.feasible;
  data_.lift = parts_.feasible->change_of_lift(&then);
  data_.bulge = {};
  if (!setting_.steady_boundary) data_.bulge = parts_.feasible->at(0.5 * (before_.begin + before_.end))->bulge(then, *parts_.feasible);
  if (setting_.steady_force) return;
  if (parts_.problem.time != before_.end) parts_.set_sources(before_.end);
  data_.resolved = true;
  for (int alpha = 0; alpha < parts_.problem.count; ++alpha) {
    const auto [square, resolved] = change_of_force(parts_.space, *parts_.problem.force[alpha], before_.begin, before_.end);
    data_.force[alpha] = parts_.comm().sum(square);
    data_.resolved = data_.resolved && resolved;
  }
}

void StepEvaluation::operator()(const Iterate& iterate) {
  iterate_ = iterate;
  Vector above(parts_.space.points()), cut_off(parts_.space.map());
  parts_.multiplier(*iterate.lambda, above, cut_off);
  way_ = parts_.feasible->way(iterate.u, parts_.feasible->continuous(iterate.u));
  for (int alpha = 0; alpha < parts_.problem.count; ++alpha) {
    flux_(parts_, before_, iterate, way_, alpha, cut_off);  // R_lin = (-1)^alpha D min(X3, 0)
    cut_off.scale(-1);
  }
  const CellTable& lambda = parts_.multiplier.density();
  const double small = negligible * parts_.mean_flux_term();
  parts_.feasible->evaluate(iterate.u, lambda, parts_.q, parts_.pair, small);
  before_.feasible->contact(before_.s_c, lambda, parts_.q, contact_before_, small);
  parts_.feasible->change_of_move(way_.gap, data_.lift, before_.feasible.get(), before_.way.gap, move_change_);
  contact_at_points(parts_.space, parts_.shares, above, *iterate.gap, parts_.contact_lin);
  sum_up();
}

Sums<OfFlux> StepEvaluation::sum_of_fluxes() const {
  Sums<OfFlux> sum;
  const auto add = parts_.empty_cells();
  for (int alpha = 0; alpha < parts_.problem.count; ++alpha) {
    FluxTerms terms = flux_.terms(parts_, alpha);
    terms.add = add;
    sum += sum_over_cells<OfFlux>("thixis::bound::flux_terms", parts_.owned(), terms);
  }
  return sum.over(parts_.comm());
}

/// After the fluxes.
Sums<OfStep> StepEvaluation::sum_of_pair() const {
  StepTerms terms;
  terms.whole = parts_.pair.whole;
  terms.rest = parts_.pair.rest;
  terms.at_nodes = parts_.pair.at_nodes;
  terms.contact = parts_.pair.contact;
  terms.whole_then = before_.pair.whole;
  terms.contact_then = contact_before_;
  terms.contact_lin = parts_.contact_lin;
  terms.move_change = move_change_;
  terms.lift_change = data_.lift;
  terms.bulge = data_.bulge;
  terms.lambda = parts_.multiplier.density();
  terms.count = parts_.problem.count;
  terms.tau = before_.tau();
  terms.of_move = 0;
  const auto apart = parts_.feasible->apart();
  for (int alpha = 0; alpha < terms.count; ++alpha) terms.of_move += squared(setting_.friedrichs * apart[alpha]) / setting_.least[alpha];
  terms.cells = parts_.cells;
  return sum_over_cells<OfStep>("thixis::bound::step_terms", parts_.owned(), terms).over(parts_.comm());
}

void StepEvaluation::sum_up() {
  StepFigures figures;
  figures.count = parts_.problem.count;
  figures.tau = before_.tau();
  figures.friedrichs = setting_.friedrichs;
  figures.apart = parts_.feasible->apart();
  for (int alpha = 0; alpha < figures.count; ++alpha) {
    figures.least[alpha] = setting_.least[alpha];
    figures.force[alpha] = data_.force[alpha];
    figures.left_disc[alpha] = flux_.left(alpha);
    figures.left_lin[alpha] = parts_.membrane[alpha].lin.left;
    figures.left_alg[alpha] = parts_.membrane[alpha].alg.left;
  }
  figures.flux = sum_of_fluxes();
  figures.sum = sum_of_pair();
  step_ = bound::estimate(figures);
  step_.eta.evident = parts_.space.conforming();  // the proof is for continuous elements
  step_.eta.promise = doubts().empty() ? Promise::guaranteed : Promise::up_to_quadrature;
  find_worst_cells(parts_.cells, parts_.space.mesh(), step_.eta);
}

/// The estimate has all of it but the flux at the end of the step.
StepBound::Errors StepEvaluation::errors() const {
  Sums<OfFlux> sum;
  for (int alpha = 0; alpha < parts_.problem.count; ++alpha) {
    parts_.membrane[alpha].measure(iterate_.u[alpha]);
    FluxTerms terms = flux_.terms(parts_, alpha);
    terms.change = {};
    sum += sum_over_cells<OfFlux>("thixis::bound::flux_at_end", parts_.owned(), terms);
  }
  StepBound::Errors errors = step_.errors;
  errors.space += std::sqrt(before_.tau() * sum.over(parts_.comm())[OfFlux::disc]);
  return errors;
}

std::vector<std::string> StepEvaluation::doubts() const {
  std::vector<std::string> clauses = parts_.doubts;
  for (auto& clause : doubts_in_time(parts_.problem, before_.feasible ? *before_.feasible : *parts_.feasible, *parts_.feasible))
    clauses.push_back(std::move(clause));
  return clauses;
}

GuaranteedBound::Fluxes StepEvaluation::fluxes(int alpha) const {
  const MembraneFlux& of = parts_.membrane[alpha];
  return {of.disc, of.lin.sigma, of.alg.sigma, flux_.balanced(parts_, before_, way_, alpha), flux_.lifted(parts_, before_, way_, alpha),
          of.alg.r};
}

std::size_t StepEvaluation::bytes() const {
  std::size_t tables = way_.gap.size() + 6 * parts_.owned();
  for (int alpha = 0; alpha < parts_.problem.count; ++alpha) tables += way_.averages[alpha].size() + way_.closing[alpha].size();
  return parts_.bytes() + before_.bytes() + flux_.bytes() + sizeof(double) * tables;
}

}  // namespace thixis::bound
