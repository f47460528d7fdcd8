/// What the error estimate costs beside the solver it steers: full form, GMRES(50) with ILU(0), an iterate in the middle of a Krylov loop.
///
///     bench_estimate LEVEL [degree] [case]        default: P1 to P4; S, D, disk
///
/// On T_LEVEL (criss-cross with 5 squares a side; disk: 4 rings) the start is the solution of the level before. "set-up": the first
/// estimate less a later one, beside assembly and factorization; "evaluation": the shortest of several estimates at X^{1,25}, where neither
/// residual vanishes, beside one iteration, the average over a whole cycle.
#include <fmt/format.h>

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cstdlib>

#include "problems.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/membranes/membranes.hpp"

namespace thixis::verification {
namespace {

using algebra::Vector;
constexpr int restart = 50;

std::unique_ptr<models::StationaryModel> model(const drive::RunParams& params, const algebra::LinearParams& linear) {
  return membranes::membranes(membranes::membrane_scene(params.scene), method_of(params.method.name), params.method, linear, {});
}

/// Sets up the system of the first Newton step at X; its residual goes to R. Seconds.
double linearize(complementarity::Problem& problem, const Vector& X, Vector& R) {
  Vector K(problem.points()), G(problem.points()), s(problem.points()), C(problem.points()), a(problem.points()), b(problem.points());
  problem.scaling(s);
  problem.equations(X, R);
  problem.arguments(X, K, G);
  const complementarity::ActiveSet active(K, G, s, complementarity::Ties::contact, 1e-12);
  evaluate(complementarity::CFunction::min, K, G, s, active, C);
  problem.insert(C, R);
  differentiate(complementarity::CFunction::min, K, G, s, active, a, b);
  const core::Stopwatch clock;
  problem.linearize(X, a, b);
  return clock.seconds();
}

/// Shortest of several runs.
template <class F>
double seconds(int runs, F f) {
  double best = 1e300;
  for (int run = 0; run < runs; ++run) {
    const core::Stopwatch clock;
    f();
    best = std::min(best, clock.seconds());
  }
  return best;
}

void measure(const std::string& name, int degree, int level) {
  auto params = catalogued(name, level);
  params.method = by("fem", degree);
  params.mesh.cells_per_side = 5;
  auto hierarchy = mesh::build(params.mesh, core::Comm(), INPUTS);
  const auto coarse_model = model(params, params.linear);
  algebra::LinearParams krylov;
  krylov.restart = krylov.max_iterations = restart;
  const auto fine_model = model(params, krylov);

  std::unique_ptr<models::Discretization> coarse;
  Teuchos::RCP<Vector> X;
  for (int j = std::max(0, level - 2); j < level; ++j) {
    auto next = coarse_model->discretize(hierarchy, j);
    X = X.is_null() ? next->cold_start() : next->nested_start(*coarse, *X);
    newton(next->problem(), *X, params.newton, {}, 0);
    coarse = std::move(next);
  }
  std::unique_ptr<models::Discretization> fine;
  const double assembly = seconds(1, [&] { fine = fine_model->discretize(hierarchy, level); });
  X = X.is_null() ? fine->cold_start() : fine->nested_start(*coarse, *X);
  coarse.reset();
  auto& problem = fine->problem();
  Vector R(problem.map()), dX(problem.map()), Xi(*X, Teuchos::Copy);
  const double factorization = linearize(problem, *X, R);

  algebra::LinearStop stop;
  stop.check_every = restart / 2;
  stop.criterion = [&](const Vector& dXi, int iteration, double) {
    if (iteration > 0) Xi.update(1, dXi, 1);
    return iteration > 0;
  };
  problem.solve(R, dX, stop);
  int iterations = 0;
  const double cycle = seconds(2, [&] { iterations = problem.solve(R, dX, {}).iterations; });
  const double iteration = cycle / iterations;

  complementarity::Estimate eta;
  const double first = seconds(1, [&] { eta = fine->estimate(Xi); });
  const double evaluation = seconds(5, [&] { eta = fine->estimate(Xi); });
  const double set_up = first - evaluation;
  fmt::print("{:26} P{} {:7} {:9.2f} {:9.2f} {:9.2f} {:9.2f} {:9.2f} {:9.2f} {:8} {:9.1e} {:9.1e} {:9.1e}\n", name, degree,
             hierarchy.finest().global_cells, assembly + factorization, set_up, set_up / (assembly + factorization), 1e3 * iteration,
             1e3 * evaluation, evaluation / iteration, fine->bytes_of_estimate() / hierarchy.finest().owned_cells, eta.discretization,
             eta.linearization, eta.algebraic);
  std::fflush(stdout);
}

}  // namespace
}  // namespace thixis::verification

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  const int level = argc > 1 ? std::atoi(argv[1]) : 5, degree = argc > 2 ? std::atoi(argv[2]) : 0;
  fmt::print("{:26} {:2} {:>7} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8} {:>9} {:>9} {:>9}\n", "case", "", "cells", "asm+ilu s", "set-up s",
             "ratio", "iter ms", "eval ms", "ratio", "bytes", "eta_disc", "eta_lin", "eta_alg");
  for (const std::string name : {"smooth contact", "discontinuous multiplier", "disk"}) {
    if (argc > 3 && name != argv[3]) continue;
    for (int p = 1; p <= 4; ++p)
      if (degree == 0 || p == degree) thixis::verification::measure(name, p, level);
  }
  return 0;
}
