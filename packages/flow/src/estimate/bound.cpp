#include "estimate/bound.hpp"

#include "estimate/balanced.hpp"
#include "laws/settle.hpp"
#include "step/vectors.hpp"
#include "thixis/fv/flux_lift.hpp"
#include "thixis/fv/nodal_average.hpp"

namespace thixis::flow {
namespace {

using algebra::Vector;

std::vector<bool> held_faces(const TwoPhaseOperator& flow) {
  const auto kind = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), flow.face_kind());
  std::vector<bool> held(kind.extent(0));
  for (std::size_t F = 0; F < held.size(); ++F) held[F] = kind(F) == FlowBoundaryKind::state;
  return held;
}

}  // namespace

struct TwoPhaseBound::Impl {
  const TwoPhaseOperator& flow;
  FlowScales scales;
  StepMeasure measure;
  fv::NodalAverage average;
  fv::FluxLift lift;

  FlowStep step;
  Teuchos::RCP<const Vector> X_before;
  bool before_known = false;
  fv::View<PhaseState*> states_before;
  fv::View<fv::Quadratic**> p;
  fv::View<double*[most_faces][components]> broken, broken_before;
  fv::View<double**> given, distances, residuals, sigma, rest;
  fv::View<double* [components]> missed;
  fv::View<double* [parts_of_cell]> errors;

  Impl(const TwoPhaseOperator& of_flow, const FlowScales& of_scales, const TwoPhaseBoundParams& of_params)
      : flow(of_flow),
        scales(of_scales),
        measure(of_flow.grid(), of_params),
        average(flow.grid(), held_faces(flow)),
        lift(flow.grid(), held_faces(flow)) {
    const std::size_t owned = flow.grid().owned_cells, faces = flow.grid().faces;
    p = fv::View<fv::Quadratic**>("thixis::flow::potentials", owned, potentials);
    broken = fv::View<double* [most_faces][components]>("thixis::flow::broken_fluxes", owned);
    broken_before = fv::View<double* [most_faces][components]>("thixis::flow::broken_fluxes_before", owned);
    given = fv::View<double**>("thixis::flow::given_potentials", faces, potentials);
    distances = fv::View<double**>("thixis::flow::nonconformity", owned, potentials);
    residuals = fv::View<double**>("thixis::flow::residuals", owned, 2 * components);
    sigma = fv::View<double**>("thixis::flow::lifted", faces, 2 * components);
    rest = fv::View<double**>("thixis::flow::lift_rest", owned, 2 * components);
    missed = fv::View<double* [components]>("thixis::flow::masses_missed", owned);
    errors = fv::View<double* [parts_of_cell]>("thixis::flow::errors", owned);
  }

  bool literature() const { return measure.literature(); }
  const fv::Grid& grid() const { return flow.grid(); }

  /// Of all local cells; (2.1) but in the measure of the literature.
  fv::View<PhaseState*> settled(const fv::View<PhaseState*>& states) const {
    if (literature()) return states;
    const fv::View<PhaseState*> out("thixis::flow::settled_states", states.extent(0));
    Kokkos::deep_copy(out, states);
    Kokkos::parallel_for("thixis::flow::settle", Cells(0, grid().cells), Settle{flow.laws(), out});
    return out;
  }

  Residual residual(const Balanced& of) const { return {fv::RaviartThomas(grid()), of, step.before, step.source, step.length}; }

  void broken_fluxes(const fv::View<PhaseState*>& states, const fv::View<double* [most_faces][components]>& out) const {
    BrokenFluxes kernel{fv::RaviartThomas(grid()), flow.laws()};
    kernel.distance = grid().face_distance;
    kernel.kind = flow.face_kind();
    kernel.states = states;
    kernel.outside = step.outside;
    kernel.p = p;
    kernel.fluxes = out;
    Kokkos::parallel_for("thixis::flow::broken_fluxes", Cells(0, grid().owned_cells), kernel);
  }

  /// What of the step does not depend on the iterate.
  void prepare_step() {
    if (before_known) return;
    states_before = settled(flow.states(*X_before));
    broken_fluxes(states_before, broken_before);
    Kokkos::parallel_for("thixis::flow::given_potentials", Cells(0, grid().faces), GivenPotentials{flow.face_kind(), step.outside, given});
    before_known = true;
  }

  /// Residuals and their fluxes: (2.3), (4.1). Literature: linearized fluxes less those at U, which need no lift.
  void lift_residuals(const Balanced& now, const Balanced& linear, bool solves_a_system) const {
    const Residual whole = residual(now), left = residual(linear);
    const auto r = residuals;
    const bool apart = solves_a_system, only_algebraic = literature();
    Kokkos::parallel_for(
        "thixis::flow::residuals", Cells(0, grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
          for (int c = 0; c < components; ++c) {
            const double algebraic_part = apart ? left(K, c) : 0;
            r(K, components + c) = algebraic_part;
            r(K, c) = only_algebraic ? 0 : whole(K, c) - algebraic_part;
          }
        });
    lift(residuals, sigma, rest);
    if (!literature()) return;
    const auto flux_of = sigma;
    Kokkos::parallel_for(
        "thixis::flow::linearization_flux", Cells(0, grid().faces), KOKKOS_LAMBDA(LocalIndex F) {
          for (int c = 0; c < components; ++c) flux_of(F, c) = linear.fluxes(F, c) - now.fluxes(F, c);
        });
    const auto out = missed;
    Kokkos::parallel_for(
        "thixis::flow::masses_missed", Cells(0, grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
          for (int c = 0; c < components; ++c) out(K, c) = now.masses(K, c) - linear.masses(K, c);
        });
  }

  void find_cell_errors(const fv::View<PhaseState*>& now, const fv::View<double* [components]>& fluxes) const {
    const bool plain = literature();
    CellErrors kernel{fv::RaviartThomas(grid()), flow.laws()};
    for (int c = 0; c < components; ++c) kernel.mass[c] = plain ? 1 : scales.mass[c];
    kernel.content = plain ? 1 : flow.laws().H * scales.pressure;
    kernel.length = step.length;
    kernel.lifted = !plain;
    kernel.diameter = grid().diameter;
    kernel.states = now;
    kernel.states_before = states_before;
    kernel.face_fluxes = fluxes;
    kernel.fluxes = broken;
    kernel.fluxes_before = broken_before;
    kernel.distances = distances;
    kernel.sigma = sigma;
    kernel.rest = rest;
    kernel.masses_missed = missed;
    kernel.out = errors;
    Kokkos::parallel_for("thixis::flow::cell_errors", Cells(0, grid().owned_cells), kernel);
  }

  complementarity::Estimate estimate(const Vector& X, const Linearization& at) {
    prepare_step();
    const auto states = flow.states(X), now = settled(states);
    broken_fluxes(now, broken);
    average(p, given, distances);
    const Balanced there = balanced(flow, step, now);
    const bool solves_a_system = !at.X.is_null();
    lift_residuals(there, solves_a_system ? linearized(flow, states, at) : there, solves_a_system);

    find_cell_errors(now, there.fluxes);
    return measure(errors, step.length);
  }
};

TwoPhaseBound::TwoPhaseBound(const TwoPhaseOperator& flow, const FlowScales& scales, const TwoPhaseBoundParams& params)
    : impl_(std::make_unique<Impl>(flow, scales, params)) {}
TwoPhaseBound::~TwoPhaseBound() = default;

void TwoPhaseBound::begin(const FlowStep& step, const Vector& before) {
  impl_->step = step;
  impl_->X_before = Teuchos::rcp(new Vector(before, Teuchos::Copy));
  impl_->before_known = false;
}

complementarity::Estimate TwoPhaseBound::operator()(const Vector& X, const Linearization& at) { return impl_->estimate(X, at); }

models::StepErrors TwoPhaseBound::step_errors() const { return impl_->measure.step_errors(); }
const CellParts& TwoPhaseBound::cells() const { return impl_->measure.cells(); }

}  // namespace thixis::flow
