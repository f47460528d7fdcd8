#include "estimate/bound.hpp"

#include <algorithm>
#include <cmath>

#include "estimate/kernels.hpp"
#include "step/extremes.hpp"
#include "thixis/fv/flux_lift.hpp"
#include "thixis/fv/nodal_average.hpp"

namespace thixis::flow {
namespace {

using algebra::Vector;
using Range = Kokkos::RangePolicy<Vector::execution_space>;

std::vector<bool> held_faces(const TwoPhaseOperator& flow) {
  const auto kind = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), flow.face_kind());
  std::vector<bool> held(kind.extent(0));
  for (std::size_t F = 0; F < held.size(); ++F) held[F] = kind(F) == FlowBoundaryKind::state;
  return held;
}

/// Volume of the domain and the squared diagonal of the box around it. Collective.
struct Extent {
  double volume = 0, diagonal2 = 0;

  explicit Extent(const fv::Grid& grid) {
    const auto cell_volume = grid.volume;
    Kokkos::parallel_reduce(
        "thixis::flow::volume", Range(0, grid.owned_cells), KOKKOS_LAMBDA(LocalIndex K, double& sum) { sum += cell_volume(K); }, volume);
    volume = grid.comm.sum(volume);
    diagonal2 = squared_diagonal(grid);
  }
};

}  // namespace

struct TwoPhaseBound::Impl {
  const TwoPhaseOperator& flow;
  FlowScales scales;
  TwoPhaseBoundParams params;
  fv::NodalAverage average;
  fv::FluxLift lift;
  Extent extent;

  FlowStep step;
  Teuchos::RCP<const Vector> X_before;
  bool before_known = false;
  fv::View<PhaseState*> states_before;
  fv::View<fv::Quadratic**> p;
  fv::View<double*[most_faces][components]> broken, broken_before;
  fv::View<double**> given, distances, residuals, sigma, rest;
  fv::View<double* [components]> missed;
  fv::View<double* [parts]> errors;
  Cells cells;
  models::StepErrors of_step;

  Impl(const TwoPhaseOperator& of_flow, const FlowScales& of_scales, const TwoPhaseBoundParams& of_params)
      : flow(of_flow),
        scales(of_scales),
        params(of_params),
        average(flow.grid(), held_faces(flow)),
        lift(flow.grid(), held_faces(flow)),
        extent(flow.grid()) {
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
    errors = fv::View<double* [parts]>("thixis::flow::errors", owned);
    cells = {fv::View<double*>("thixis::flow::discretization", owned), fv::View<double*>("thixis::flow::linearization", owned),
             fv::View<double*>("thixis::flow::algebraic", owned), fv::View<double*>("thixis::flow::phase_transition", owned)};
  }

  bool literature() const { return params.measure == complementarity::Measure::literature; }
  const fv::Grid& grid() const { return flow.grid(); }

  /// Of all local cells; (2.1) but in the measure of the literature.
  fv::View<PhaseState*> settled(const fv::View<PhaseState*>& states) const {
    if (literature()) return states;
    const fv::View<PhaseState*> out("thixis::flow::settled_states", states.extent(0));
    Kokkos::deep_copy(out, states);
    Kokkos::parallel_for("thixis::flow::settle", Range(0, grid().cells), Settle{flow.laws(), out});
    return out;
  }

  Balanced balanced(const fv::View<PhaseState*>& states) const {
    const Balanced out = allocate();
    const auto fluxes = flow.fluxes(states, step);
    const auto values = out.fluxes;
    Kokkos::parallel_for("thixis::flow::masses", Range(0, grid().owned_cells), MassesAt{flow.laws(), states, out.masses});
    Kokkos::parallel_for(
        "thixis::flow::flux_values", Range(0, grid().faces), KOKKOS_LAMBDA(LocalIndex F) {
          for (int c = 0; c < components; ++c) values(F, c) = fluxes(F).value[c];
        });
    return out;
  }
  Balanced linearized(const fv::View<PhaseState*>& states, const TwoPhaseProblem::Linearization& at) const {
    const Balanced out = allocate();
    Kokkos::parallel_for("thixis::flow::linearized_masses", Range(0, grid().owned_cells),
                         LinearizedMasses{flow.laws(), states, at.states, out.masses});
    Kokkos::parallel_for("thixis::flow::linearized_fluxes", Range(0, grid().faces),
                         LinearizedFluxes{grid().face_cells, states, at.states, at.fluxes, out.fluxes});
    return out;
  }
  Balanced allocate() const {
    return {fv::View<double* [components]>("thixis::flow::masses", grid().owned_cells),
            fv::View<double* [components]>("thixis::flow::flux_values", grid().faces)};
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
    Kokkos::parallel_for("thixis::flow::broken_fluxes", Range(0, grid().owned_cells), kernel);
  }

  /// What of the step does not depend on the iterate.
  void prepare_step() {
    if (before_known) return;
    states_before = settled(flow.states(*X_before));
    broken_fluxes(states_before, broken_before);
    Kokkos::parallel_for("thixis::flow::given_potentials", Range(0, grid().faces), GivenPotentials{flow.face_kind(), step.outside, given});
    before_known = true;
  }

  /// Residuals and their fluxes: (2.3), (4.1). Literature: linearized fluxes less those at U, which need no lift.
  void lift_residuals(const Balanced& now, const Balanced& linear, bool solves_a_system) const {
    const Residual whole = residual(now), left = residual(linear);
    const auto r = residuals;
    const bool apart = solves_a_system, only_algebraic = literature();
    Kokkos::parallel_for(
        "thixis::flow::residuals", Range(0, grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
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
        "thixis::flow::linearization_flux", Range(0, grid().faces), KOKKOS_LAMBDA(LocalIndex F) {
          for (int c = 0; c < components; ++c) flux_of(F, c) = linear.fluxes(F, c) - now.fluxes(F, c);
        });
    const auto out = missed;
    Kokkos::parallel_for(
        "thixis::flow::masses_missed", Range(0, grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
          for (int c = 0; c < components; ++c) out(K, c) = now.masses(K, c) - linear.masses(K, c);
        });
  }

  std::vector<double> sums() const {
    std::vector<double> sum(parts);
    const auto e = errors;
    for (int i = 0; i < parts; ++i)
      Kokkos::parallel_reduce(
          "thixis::flow::sum", Range(0, grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K, double& s) { s += e(K, i); }, sum[i]);
    grid().comm.sum(sum);
    return sum;
  }

  /// (5.2): without units.
  complementarity::Estimate of_residuals() {
    const double alpha = params.time_scale, tau = step.length;
    const double residual_unit = tau * alpha / (extent.diagonal2 * extent.volume), transition_unit = tau / (alpha * extent.volume);
    fill_cells(residual_unit, residual_unit, transition_unit);
    const std::vector<double> sum = sums();
    const auto norm = [&](Part part) { return std::sqrt(residual_unit * sum[part]); };
    of_step.space = norm(space);
    of_step.time = norm(in_time) + std::sqrt(transition_unit * sum[appearing]);
    complementarity::Estimate eta;
    eta.discretization = of_step.space + of_step.time;
    eta.linearization = norm(linearization);
    eta.algebraic = norm(algebraic);
    eta.total = norm(all_residuals) + of_step.time;
    return eta;
  }

  /// (6.1)
  complementarity::Estimate of_literature() {
    const double alpha = params.time_scale, tau = step.length;
    fill_cells(tau, 2 * tau, std::pow(tau / alpha, 2));
    const std::vector<double> sum = sums();
    of_step.space = std::sqrt(2 * tau) * (std::sqrt(sum[space]) + std::sqrt(sum[bent]));
    of_step.time = std::sqrt(2 * tau * sum[in_time]) + tau / alpha * sum[appearing];
    complementarity::Estimate eta;
    eta.discretization = of_step.space + of_step.time;
    eta.linearization = std::sqrt(tau * sum[linearization]) + tau / alpha * sum[disappearing];
    eta.algebraic = std::sqrt(tau * sum[algebraic]);
    eta.total = eta.discretization + eta.linearization + eta.algebraic;
    return eta;
  }

  void fill_cells(double iteration_unit, double discretization_unit, double transition_unit) {
    const Cells out = cells;
    const auto e = errors;
    const auto volume = grid().volume;
    const double bent_unit = literature() ? discretization_unit : 0;
    Kokkos::parallel_for(
        "thixis::flow::cell_estimates", Range(0, grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
          using Kokkos::Experimental::sqrt;
          out.discretization(K) = sqrt(discretization_unit * e(K, space)) + sqrt(discretization_unit * e(K, in_time)) +
                                  sqrt(bent_unit * e(K, bent)) + sqrt(transition_unit * e(K, appearing));
          out.linearization(K) = sqrt(iteration_unit * e(K, linearization));
          out.algebraic(K) = sqrt(iteration_unit * e(K, algebraic));
          out.phase_transition(K) = e(K, appearing) / volume(K);
        });
  }

  /// In cells where next to nothing happens a thousandth of the mean estimate stands in for theirs.
  void find_worst_cells(complementarity::Estimate& eta) const {
    const double least = 1e-3 * eta.discretization / std::sqrt(static_cast<double>(grid().global_cells));
    const Cells of = cells;
    double alg = 0, lin = 0;
    Kokkos::parallel_reduce(
        "thixis::flow::worst_cells", Range(0, grid().owned_cells),
        KOKKOS_LAMBDA(LocalIndex K, double& worst_alg, double& worst_lin) {
          const double disc = of.discretization(K) > least ? of.discretization(K) : least;
          const double compared = of.linearization(K) > disc ? of.linearization(K) : disc;
          if (of.algebraic(K) > worst_alg * compared) worst_alg = of.algebraic(K) / compared;
          if (of.linearization(K) > worst_lin * disc) worst_lin = of.linearization(K) / disc;
        },
        Kokkos::Max<double>(alg), Kokkos::Max<double>(lin));
    eta.worst_algebraic = grid().comm.max(alg);
    eta.worst_linearization = grid().comm.max(lin);
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
    Kokkos::parallel_for("thixis::flow::cell_errors", Range(0, grid().owned_cells), kernel);
  }

  complementarity::Estimate estimate(const Vector& X, const TwoPhaseProblem::Linearization& at) {
    prepare_step();
    const auto states = flow.states(X), now = settled(states);
    broken_fluxes(now, broken);
    average(p, given, distances);
    const Balanced there = balanced(now);
    const bool solves_a_system = !at.X.is_null();
    lift_residuals(there, solves_a_system ? linearized(states, at) : there, solves_a_system);

    find_cell_errors(now, there.fluxes);
    complementarity::Estimate eta = literature() ? of_literature() : of_residuals();
    find_worst_cells(eta);
    eta.evident = true;
    return eta;
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

complementarity::Estimate TwoPhaseBound::operator()(const Vector& X, const TwoPhaseProblem::Linearization& at) {
  return impl_->estimate(X, at);
}

models::StepErrors TwoPhaseBound::step_errors() const { return impl_->of_step; }
const TwoPhaseBound::Cells& TwoPhaseBound::cells() const { return impl_->cells; }

}  // namespace thixis::flow
