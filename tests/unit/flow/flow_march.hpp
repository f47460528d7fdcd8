#pragma once
#include "estimate/bound.hpp"
#include "problem/problem.hpp"
#include "step/predictor.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/complementarity/newton.hpp"
#include "thixis/flow/scene.hpp"

namespace thixis::flow {

constexpr double year = 31557600;

inline fv::Grid interval(int cells, double length, const core::Comm& comm) {
  mesh::MeshParams params;
  params.generator = mesh::Generator::interval;
  params.cells = {cells};
  params.lower = {0};
  params.upper = {length};
  return fv::build(params, comm, ".");
}

inline TwoPhaseScene catalogued(const std::string& name) {
  models::SceneParams params;
  params.model = "two-phase";
  params.case_name = name;
  return two_phase_scene(params);
}

/// A flow with its problem and its estimate, step by step without a driver.
struct Flow {
  TwoPhaseOperator flow;
  FlowScales scales;
  Teuchos::RCP<algebra::Vector> X;
  TwoPhaseProblem problem;
  TwoPhaseBound bound;
  complementarity::NewtonParams newton;
  complementarity::StoppingParams stopping;
  int check_every = 10;
  bool predict = false;
  double t = 0, last_length = 0;
  Teuchos::RCP<algebra::Vector> X_before;
  complementarity::Estimate eta;

  Flow(const fv::Grid& grid, const TwoPhaseScene& scene, const TwoPhaseBoundParams& params = {}, double unit = year,
       const algebra::LinearParams& linear = {})
      : flow(grid, scene, unit),
        scales(flow.laws(), 1e6),
        X(flow.initial()),
        problem(flow, scales, linear, flow.initial()),
        bound(flow, scales, params) {}

  complementarity::Estimate estimate(const algebra::Vector& at) { return bound(at, problem.linearization()); }

  /// Sets up the step of this length from X.
  void begin(double length) {
    problem.begin(flow.step(t, t + length, *X));
    bound.begin(problem.step(), *X);
  }

  complementarity::NewtonReport step(double length, const complementarity::NewtonObserver& observer = {}) {
    begin(length);
    auto next = Teuchos::rcp(new algebra::Vector(*X, Teuchos::Copy));
    if (predict && !X_before.is_null()) next = predicted(flow, *X, *X_before, length / last_length);
    const auto report = complementarity::newton(problem, *next, newton, stopping, check_every, observer,
                                                [this](const algebra::Vector& at) { return eta = estimate(at); });
    X_before = X;
    X = next;
    t += length;
    last_length = length;
    return report;
  }

  /// The largest x of a cell with gas, its right end (intervals).
  double front() const {
    const auto x = algebra::host_view(std::as_const(*X));
    double most = 0;
    for (LocalIndex K = 0; K < flow.grid().owned_cells; ++K)
      if (x(unknowns_per_cell * K) > 1e-8) most = std::max(most, flow.grid().centre(K, 0) + flow.grid().volume(K) / 2);
    return flow.grid().comm.max(most);
  }
};

}  // namespace thixis::flow
