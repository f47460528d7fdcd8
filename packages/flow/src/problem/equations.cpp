#include <algorithm>
#include <cmath>

#include "problem/around.hpp"
#include "problem/problem.hpp"
#include "step/turnover.hpp"
#include "step/vectors.hpp"

namespace thixis::flow {
namespace {

using algebra::Vector;

constexpr double largest_weight = 1e60;  // nothing overflows
constexpr double resolved = 1e10;        // units in the last place that a step must move for its tolerance to be relative to them

struct Equations {
  Around around;
  TwoPhaseLaws laws;
  fv::View<PhaseState*> states;
  fv::View<FaceFlux*> fluxes;
  fv::View<double*[components]> before, owed, source;
  VectorOut R;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex K) const {
    const Masses l = laws.masses(states(K));
    double out[components] = {0, 0};
    for (LocalIndex f = around.begin(K); f < around.begin(K + 1); ++f) {
      const LocalIndex F = around.faces(f);
      for (int c = 0; c < components; ++c) out[c] += around.outward(F, K) * fluxes(F).value[c];
    }
    R(unknowns_per_cell * K + contact_row, 0) = 0;
    for (int c = 0; c < components; ++c)
      R(unknowns_per_cell * K + first_equation + c, 0) =
          (l.value[c] - before(K, c) + owed(K, c) + around.length * (out[c] / around.volume(K) - source(K, c))) / around.mass[c];
  }
};

/// |F|² over the owned cells.
struct Reference {
  Around around;
  double rock_filled;  ///< phi rho_w: the masses of water are counted from it
  fv::View<double*[components]> before, source, inflow;

  KOKKOS_FUNCTION void operator()(LocalIndex K, double& sum) const {
    for (int c = 0; c < components; ++c) {
      double in = 0;
      for (LocalIndex f = around.begin(K); f < around.begin(K + 1); ++f)
        if (around.cells(around.faces(f), 1) < 0) in += around.area(around.faces(f)) * inflow(around.faces(f), c);
      const double l = before(K, c) + (c == water ? rock_filled : 0);
      const double F = (l + around.length * (source(K, c) + in / around.volume(K))) / around.mass[c];
      sum += F * F;
    }
  }
};

}  // namespace

FlowScales TwoPhaseProblem::row_scales() const {
  FlowScales scales = scales_;
  for (int c = 0; c < components; ++c) scales.mass[c] /= weight_[c];
  return scales;
}

/// w_c = |l^{n-1}|/moved_c where that is more than 1; of water, of which there is plenty, no more than of hydrogen.
void TwoPhaseProblem::set_weights(double in_place) {
  const Turnover of = turnover(flow_, step_);
  double moved[components], rounding[components];
  for (int c = 0; c < components; ++c) {
    moved[c] = of.moved[c] / scales_.mass[c];
    rounding[c] = of.rounding[c] / scales_.mass[c];
  }
  moved[water] = std::max(moved[water], moved[hydrogen]);
  for (int c = 0; c < components; ++c) {
    const double counts = std::max(moved[c], resolved * rounding[c]);
    weight_[c] = counts > 0 ? std::clamp(in_place / counts, 1.0, largest_weight) : 1;
  }
  round_off_ = weight_[water] * rounding[water];
}

void TwoPhaseProblem::begin(FlowStep step) {
  step_ = std::move(step);
  at_ = {};
  reference_norm_ = brought_norm(step_.length);
  set_weights(brought_norm(0));
}

/// |F| of a step of this length.
double TwoPhaseProblem::brought_norm(double length) const {
  double sum = 0;
  Kokkos::parallel_reduce("thixis::flow::reference", Cells(0, flow_.grid().owned_cells),
                          Reference{Around(flow_.grid(), length, scales_), flow_.laws().porosity * flow_.laws().rho_w, step_.before,
                                    step_.source, step_.inflow},
                          sum);
  return std::sqrt(flow_.grid().comm.sum(sum));
}

void TwoPhaseProblem::equations(const Vector& X, Vector& R) const {
  const auto states = flow_.states(X);
  Equations kernel{Around(flow_.grid(), step_.length, row_scales()), flow_.laws()};
  kernel.states = states;
  kernel.fluxes = flow_.fluxes(states, step_);
  kernel.before = step_.before;
  kernel.owed = step_.owed;
  kernel.source = step_.source;
  kernel.R = write(R);
  Kokkos::parallel_for("thixis::flow::equations", Cells(0, flow_.grid().owned_cells), kernel);
}

fv::View<double* [components]> TwoPhaseProblem::left(const Vector& X) const {
  Vector R(flow_.map());
  equations(X, R);
  const auto r = read(R);
  const FlowScales scales = row_scales();
  const fv::View<double* [components]> left("thixis::flow::left", flow_.grid().owned_cells);
  Kokkos::parallel_for(
      "thixis::flow::left", Cells(0, flow_.grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
        for (int c = 0; c < components; ++c) left(K, c) = scales.mass[c] * r(unknowns_per_cell * K + first_equation + c, 0);
      });
  return left;
}

void TwoPhaseProblem::arguments(const Vector& X, Vector& K, Vector& G) const {
  const auto x = read(X);
  const auto gap = write(K), undersaturation = write(G);
  const TwoPhaseLaws laws = flow_.laws();
  Kokkos::parallel_for(
      "thixis::flow::arguments", Cells(0, flow_.grid().owned_cells), KOKKOS_LAMBDA(LocalIndex i) {
        const LocalIndex k = unknowns_per_cell * i;
        gap(i, 0) = x(k + gas_saturation, 0);
        undersaturation(i, 0) = laws.undersaturation(laws.state(x(k, 0), x(k + 1, 0), x(k + 2, 0)));
      });
}

void TwoPhaseProblem::scaling(Vector& s) const { s.putScalar(1 / (flow_.laws().H * scales_.pressure)); }

void TwoPhaseProblem::insert(const Vector& C, Vector& R) const {
  const auto c = read(C);
  const auto r = write(R);
  Kokkos::parallel_for(
      "thixis::flow::insert", Cells(0, c.extent_int(0)),
      KOKKOS_LAMBDA(LocalIndex K) { r(unknowns_per_cell * K + contact_row, 0) = c(K, 0); });
}

}  // namespace thixis::flow
