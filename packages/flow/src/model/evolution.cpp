#include "model/evolution.hpp"

#include <algorithm>

#include "step/extremes.hpp"
#include "step/predictor.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::flow {
namespace {

using algebra::Vector;

constexpr double unsettled = 1e-2;  // by which iterates of the rule adaptive may leave the range of a state, in its units

/// Size of the pressures that matter: the largest one at the beginning. Collective.
double reference_pressure(const TwoPhaseLaws& laws, const Vector& X0) {
  const double P = largest(X0, pressure);
  return P > 0 ? P : laws.P_r;
}

bool is_closed(const TwoPhaseScene& scene) {
  return std::none_of(scene.boundary.begin(), scene.boundary.end(),
                      [](const auto& part) { return part.second.kind == FlowBoundaryKind::state; });
}

}  // namespace

TwoPhaseEvolution::TwoPhaseEvolution(fv::Grid grid, const TwoPhaseScene& scene, const algebra::LinearParams& linear,
                                     double seconds_per_unit, const std::vector<models::Probe>& probes, const TwoPhaseBoundParams& bound)
    : bound_params_(bound),
      flow_(std::move(grid), scene, seconds_per_unit),
      initial_(flow_.initial()),
      problem_(flow_, FlowScales(flow_.laws(), reference_pressure(flow_.laws(), *initial_)), linear, initial_),
      verifier_(flow_.grid(), scene, seconds_per_unit, problem_.scales().pressure),
      probes_(flow_.grid(), probes),
      owed_("thixis::flow::owed", flow_.grid().owned_cells),
      jumps_(scene.jumps),
      closed_(is_closed(scene)) {
  require_definite_pressure();
}

models::Sizes TwoPhaseEvolution::sizes() const {
  const GlobalIndex unknowns = unknowns_per_cell * cells();
  return {unknowns, unknowns, problem_.nonzeros()};
}

Teuchos::RCP<Vector> TwoPhaseEvolution::initial() { return Teuchos::rcp(new Vector(*initial_, Teuchos::Copy)); }

/// The first time alone: where a later one is wrong, what was computed before it is kept.
void TwoPhaseEvolution::check(const std::vector<double>& times) const {
  if (!times.empty()) flow_.check(times.front());
}

void TwoPhaseEvolution::begin(const models::TimeStep& step, const Vector& before) {
  const core::Region region("assembly");
  FlowStep flow_step = flow_.step(step.begin, step.end, before);
  Kokkos::deep_copy(flow_step.owed, owed_);
  problem_.begin(std::move(flow_step));
  step_ = step;
  found_.reset();
  before_ = Teuchos::rcp(new Vector(before, Teuchos::Copy));
  of_step_.reset();
  bound_begun_ = false;
}

bool TwoPhaseEvolution::predict(Vector& X) {
  if (before_last_.is_null()) return start(X);
  Tpetra::deep_copy(X, *predicted(flow_, *before_, *before_last_, problem_.step().length / last_length_));
  return true;
}

/// The first step. Gas beside water that could dissolve it would leave at once for Newton's method, which takes the smaller of s_g and G
/// for zero; without gas the pressure in a closed domain has no level, and the system is singular.
bool TwoPhaseEvolution::start(Vector& X) const {
  if (!closed_) return false;
  Tpetra::deep_copy(X, *in_equilibrium(flow_, *before_));
  return true;
}

/// Without gas and without a part of the boundary where it is given, the pressure of incompressible water has no level. Collective.
void TwoPhaseEvolution::require_definite_pressure() const {
  if (!closed_ || largest(*initial_, gas_saturation) > 0) return;
  throw core::InputError(
      "scene/flow/boundary: no part has kind = state and there is no gas in the beginning, so nothing says what the pressure is; write "
      "kind = state somewhere, or initial/s_g above 0 in some place.");
}

complementarity::Estimate TwoPhaseEvolution::estimate(const Vector& X) {
  if (!bound_) bound_ = std::make_unique<TwoPhaseBound>(flow_, problem_.scales(), bound_params_);
  if (!bound_begun_) bound_->begin(problem_.step(), *before_);
  bound_begun_ = true;
  of_step_ = (*bound_)(X, problem_.linearization());
  of_step_->time = bound_->step_errors().time;
  return *of_step_;
}

models::CellEstimates TwoPhaseEvolution::cell_estimates() const {
  if (!bound_) return {};
  const CellParts& cells = bound_->cells();
  return models::cell_estimates(cells.discretization, cells.linearization, cells.algebraic);
}

std::optional<models::StepErrors> TwoPhaseEvolution::step_errors() const {
  if (!of_step_) return std::nullopt;
  return bound_->step_errors();
}

models::Objection TwoPhaseEvolution::objection(const Vector& X, double tolerance, bool conditions) {
  found_ = verified(X);
  std::string why = found_->objection(conditions ? tolerance : std::max(tolerance, unsettled), false);
  if (!why.empty() || !conditions) return {why};
  why = found_->objection(tolerance, true);
  if (why.empty()) why = balance_.objection(*found_, tolerance);
  return {why, !why.empty() && !found_->diverged()};
}

void TwoPhaseEvolution::accept(const Vector& X) {
  balance_.add(found_ ? *found_ : verified(X));
  if (!bound_params_.adaptive) Kokkos::deep_copy(owed_, problem_.left(X));
  bound_so_far_.add(of_step_);
  before_last_ = before_last_.is_null() && closed_ ? in_equilibrium(flow_, *before_).getConst() : before_;  // no jump is extrapolated
  last_length_ = problem_.step().length;
}

/// What the verifier finds at the end of the step begun. Collective.
FlowFindings TwoPhaseEvolution::verified(const Vector& X) const {
  const auto owed = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), problem_.step().owed);
  std::vector<TwoPhaseVerifier::Owed> debts(owed.extent(0));
  for (std::size_t K = 0; K < debts.size(); ++K) debts[K] = {owed(K, water), owed(K, hydrogen)};
  return verifier_(step_.begin, step_.end, of_cells(before_.is_null() ? X : *before_), of_cells(X), debts);
}

std::vector<TwoPhaseVerifier::State> TwoPhaseEvolution::of_cells(const Vector& X) const {
  const Vector all = flow_.with_ghosts(X);
  const auto x = algebra::host_view(all);
  std::vector<TwoPhaseVerifier::State> states(flow_.grid().cells);
  for (LocalIndex K = 0; K < flow_.grid().cells; ++K)
    for (int u = 0; u < unknowns_per_cell; ++u) states[K][u] = x(unknowns_per_cell * K + u);
  return states;
}

/// The multiplier is G/(H P_ref), the gap s_g; both are of size 1 where they matter, but for saturations of a small gas zone. What the
/// multiplier is compared with, and the balances, are the verifier's.
complementarity::KktData TwoPhaseEvolution::kkt_data(const Vector& X) const {
  const auto gap = Teuchos::rcp(new Vector(flow_.cells())), claimed = Teuchos::rcp(new Vector(flow_.cells())),
             recomputed = Teuchos::rcp(new Vector(flow_.cells()));
  problem_.arguments(X, *gap, *claimed);
  claimed->scale(1 / (flow_.laws().H * problem_.scales().pressure));
  const FlowFindings found = verified(X);
  {
    const auto out = algebra::host_overwrite(*recomputed);
    std::copy(found.undersaturation.begin(), found.undersaturation.end(), out.data());
  }
  complementarity::KktData data;
  data.gap = gap;
  data.claimed = claimed;
  data.equilibrium = {recomputed};
  data.unbalanced = std::max(found.unbalanced[water].violation, found.unbalanced[hydrogen].violation);
  data.gap_scale = std::max(gap->normInf(), 1e-2);
  return data;
}

}  // namespace thixis::flow
