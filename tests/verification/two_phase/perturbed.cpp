/// The verifier of two-phase flow lets the steps of the solver pass, and none of them with a perturbation.
#include <gtest/gtest.h>

#include <functional>

#include "problem/problem.hpp"
#include "thixis/complementarity/newton.hpp"
#include "thixis/flow/scene.hpp"
#include "thixis/mesh/groups.hpp"
#include "verify/verifier.hpp"

namespace thixis::flow {
namespace {

using algebra::Vector;
using State = TwoPhaseVerifier::State;

constexpr double year = 31557600, tolerance = 1e-6;

TwoPhaseScene catalogued(const std::string& name) {
  models::SceneParams params;
  params.model = "two-phase";
  params.case_name = name;
  return two_phase_scene(params);
}

mesh::MeshParams slab() {
  mesh::MeshParams params;
  params.generator = mesh::Generator::tensor;
  params.upper = {200, 20};
  params.cells = {12, 4};
  return params;
}
mesh::MeshParams column() {
  mesh::MeshParams params;
  params.generator = mesh::Generator::interval;
  params.lower = {0};
  params.upper = {20};
  params.cells = {20};
  return params;
}

/// Steps of the solver, and what the verifier finds at the end of the last one.
class March {
 public:
  /// What becomes of a step before it is solved, of the state at its end, and of the scene that the verifier believes in.
  std::function<void(const fv::Grid&, FlowStep&)> meddle;
  std::function<void(Vector&)> perturb;
  /// What is owed before the last step, to the solver and the verifier alike, and to the verifier alone.
  std::array<double, 2> owing = {0, 0}, said_to_be_owed = {0, 0};
  std::function<void(TwoPhaseScene&)> believe;
  std::function<void(const fv::Grid&)> misbuild;  ///< the grid of the solver
  std::function<void(fv::Grid&)> regroup;         ///< that of both
  complementarity::CFunction c_function = complementarity::CFunction::min;

  March(const mesh::MeshParams& mesh, TwoPhaseScene scene, double length, int steps)
      : mesh_(mesh), scene_(std::move(scene)), length_(length), steps_(steps) {}

  FlowFindings found() const {
    fv::Grid solved_on = fv::build(mesh_, core::Comm(), "");
    if (misbuild) misbuild(solved_on);
    if (regroup) regroup(solved_on);
    const TwoPhaseOperator flow(solved_on, scene_, year);
    const auto X = flow.initial();
    TwoPhaseProblem problem(flow, FlowScales(flow.laws(), 1e6), algebra::LinearParams{}, X);
    Vector before(*X, Teuchos::Copy);
    std::vector<TwoPhaseVerifier::Owed> owed(solved_on.owned_cells, {0, 0});
    for (int n = 0; n < steps_; ++n) {
      Tpetra::deep_copy(before, *X);
      FlowStep step = flow.step(n * length_, (n + 1) * length_, before);
      if (n > 0) Kokkos::deep_copy(step.owed, left_);
      if (n == steps_ - 1) owe(solved_on, step);
      const auto debt = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), step.owed);
      for (std::size_t K = 0; K < owed.size(); ++K) owed[K] = {debt(K, 0), debt(K, 1)};
      if (meddle && n == steps_ - 1) meddle(solved_on, step);
      problem.begin(step);
      complementarity::NewtonParams newton;
      newton.c_function = c_function;
      const auto report = complementarity::newton(problem, *X, newton, {}, 0);
      EXPECT_TRUE(report.converged) << report.why;
      left_ = problem.left(*X);
    }
    if (perturb) perturb(*X);
    for (LocalIndex K = 0; K < solved_on.owned_cells; ++K)
      for (int c = 0; c < 2 && solved_on.cell_id[K] == 0; ++c) owed[K][c] += said_to_be_owed[c];
    TwoPhaseScene believed = scene_;
    if (believe) believe(believed);
    fv::Grid grid = fv::build(mesh_, core::Comm(), "");
    if (regroup) regroup(grid);
    const TwoPhaseVerifier verify(grid, believed, year, 1e6);
    return verify((steps_ - 1) * length_, steps_ * length_, of_cells(flow, before), of_cells(flow, *X), owed);
  }

 private:
  void owe(const fv::Grid& grid, FlowStep& step) const {
    const auto debt = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), step.owed);
    for (LocalIndex K = 0; K < grid.owned_cells; ++K)
      for (int c = 0; c < 2 && grid.cell_id[K] == 0; ++c) debt(K, c) += owing[c];
    Kokkos::deep_copy(step.owed, debt);
  }
  static std::vector<State> of_cells(const TwoPhaseOperator& flow, const Vector& X) {
    const Vector all = flow.with_ghosts(X);
    const auto x = algebra::host_view(all);
    std::vector<State> states(flow.grid().cells);
    for (LocalIndex K = 0; K < flow.grid().cells; ++K) states[K] = {x(3 * K), x(3 * K + 1), x(3 * K + 2)};
    return states;
  }

  mesh::MeshParams mesh_;
  TwoPhaseScene scene_;
  double length_;
  int steps_;
  mutable fv::View<double* [components]> left_;
};

/// Gas on the left of a slab with gravity, water that has dissolved some of it, and water; the right side is held.
March slab_with_gas() { return {slab(), catalogued("gas injection 2d"), 1e4, 6}; }

/// In the slab: gas at the foot of the injection, wet cells far from it.
constexpr GlobalIndex with_gas = 0, wet = 30;

/// u of cell `id` becomes change(u).
std::function<void(Vector&)> in_cell(GlobalIndex id, int u, const std::function<double(double)>& change) {
  return [=](Vector& X) {
    const auto x = algebra::host_view(X);
    const auto local = X.getMap()->getLocalElement(3 * id + u);
    if (local != Teuchos::OrdinalTraits<LocalIndex>::invalid()) x(local) = change(x(local));
  };
}

void expect_refused(const March& run, const std::string& word = "balance") {
  const FlowFindings found = run.found();
  EXPECT_GT(found.worst(), tolerance);
  const std::string why = found.objection(tolerance, true);
  EXPECT_NE(why.find(word), std::string::npos) << why;
}

TEST(Verifier, lets_steps_of_the_solver_pass) {
  March by_fischer_burmeister = slab_with_gas();
  by_fischer_burmeister.c_function = complementarity::CFunction::fischer_burmeister;
  int number = 0;
  for (const March& run : {slab_with_gas(), by_fischer_burmeister, March(slab(), catalogued("gas injection 2d"), 1e-6, 3),
                           March(column(), catalogued("closed column"), 50, 12)}) {
    const FlowFindings found = run.found();
    EXPECT_LE(found.worst(), tolerance) << number;
    EXPECT_EQ(found.objection(tolerance, true), "") << number;
    for (const auto& account : found.accounts) EXPECT_LE(std::abs(account.defect), 1e-9 * account.in_place) << number;
    ++number;
  }
}

/// A part of the boundary may lie in several groups of a mesh file, of which the deck names one.
TEST(Verifier, knows_the_groups_that_a_part_of_the_boundary_lies_in) {
  March run = slab_with_gas();
  run.regroup = [](fv::Grid& grid) {
    for (std::string& tag : grid.tags) tag += std::string(mesh::intersection) + "rim";
  };
  EXPECT_EQ(run.found().objection(tolerance, true), "");
}

/// More is in place than has come in, in the first cell: the step has to take it back.
TEST(Verifier, lets_a_step_pass_that_pays_what_is_owed_and_no_other) {
  March paying = slab_with_gas();
  paying.owing = {0.3, 2e-3};
  const FlowFindings found = paying.found();
  EXPECT_EQ(found.objection(tolerance, true), "");
  EXPECT_LE(found.worst(), tolerance);
  March silent = slab_with_gas();
  silent.owing = {0.3, 2e-3};
  silent.said_to_be_owed = {-0.3, -2e-3};
  expect_refused(silent);
}

TEST(Verifier, counts_what_is_missed_in_proportion_down_to_the_tolerance) {
  const auto missed = [](double share) {
    March run = slab_with_gas();
    run.said_to_be_owed = {3 * share, 2e-2 * share};
    const FlowFindings found = run.found();
    return std::array<double, 2>{found.unbalanced[0].violation, found.unbalanced[1].violation};
  };
  const auto whole = missed(1);
  double share = 1;
  while (share * std::min(whole[0], whole[1]) > 1e-4) share *= 0.1;
  const auto little = missed(share);
  for (int c = 0; c < 2; ++c) EXPECT_NEAR(little[c], share * whole[c], 0.05 * share * whole[c]) << c << ": " << whole[c];
}

TEST(Verifier, sees_gas_where_the_tests_want_it) {
  const FlowFindings found = slab_with_gas().found();
  EXPECT_NEAR(found.both_open.violation, 0, tolerance);
  std::vector<double> seen = {0, 0};
  const fv::Grid grid = fv::build(slab(), core::Comm(), "");
  for (LocalIndex K = 0; K < grid.owned_cells; ++K) {
    if (grid.cell_id[K] == with_gas) seen[0] = std::abs(found.undersaturation[K]) < 1e-6;
    if (grid.cell_id[K] == wet) seen[1] = found.undersaturation[K] > 1e-3;
  }
  core::Comm().sum(seen);
  EXPECT_EQ(seen, (std::vector<double>{1, 1}));
}

TEST(Verifier, refuses_a_saturation_that_is_off_in_one_cell) {
  March run = slab_with_gas();
  run.perturb = in_cell(with_gas, gas_saturation, [](double s_g) { return s_g + 1e-5; });
  expect_refused(run);
}
TEST(Verifier, refuses_a_pressure_that_is_off_in_one_cell) {
  March run = slab_with_gas();
  run.perturb = in_cell(wet, pressure, [](double P) { return P + 100; });
  expect_refused(run);
}
TEST(Verifier, refuses_a_molar_fraction_that_is_off_in_one_cell) {
  March run = slab_with_gas();
  run.perturb = in_cell(wet, dissolved, [](double chi) { return chi + 1e-9; });
  expect_refused(run);
}
TEST(Verifier, refuses_the_solution_of_a_solver_with_one_wrong_flux) {
  March run = slab_with_gas();
  run.misbuild = [](const fv::Grid& grid) {
    const fv::HostGrid host = fv::on_host(grid);
    for (LocalIndex F = 0; F < grid.faces; ++F)
      if (grid.face_id[F] == 20) host.face_distance(F) *= 1.01;
    fv::Grid same = grid;
    fv::commit(host, same);
  };
  expect_refused(run);
}
TEST(Verifier, refuses_the_solution_of_a_solver_with_one_wrong_balance) {
  March run = slab_with_gas();
  run.meddle = [](const fv::Grid& grid, FlowStep& step) {
    const auto before = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), step.before);
    for (LocalIndex K = 0; K < grid.owned_cells; ++K)
      if (grid.cell_id[K] == wet) before(K, hydrogen) += 1e-6;
    Kokkos::deep_copy(step.before, before);
  };
  expect_refused(run);
}
TEST(Verifier, refuses_gravity_of_the_other_sign) {
  March run = slab_with_gas();
  run.believe = [](TwoPhaseScene& scene) { scene.gravity[1] *= -1; };
  expect_refused(run);
}
TEST(Verifier, refuses_a_source_that_is_dropped) {
  March run = slab_with_gas();
  run.believe = [](TwoPhaseScene& scene) { scene.hydrogen_source = scene::formula([](double x, double) { return x < 20 ? 1e-9 : 0.; }); };
  expect_refused(run);
}
TEST(Verifier, refuses_what_enters_through_the_boundary_and_is_dropped) {
  March run = slab_with_gas();
  run.believe = [](TwoPhaseScene& scene) { scene.boundary.erase("left"); };
  expect_refused(run);
}
TEST(Verifier, refuses_a_boundary_that_is_held_in_another_state) {
  March run = slab_with_gas();
  run.believe = [](TwoPhaseScene& scene) { scene.boundary["right"].state.chi = scene::constant(1e-6); };
  expect_refused(run);
}
TEST(Verifier, refuses_states_that_are_swapped) {
  March run = slab_with_gas();
  run.perturb = [](Vector& X) {
    // cells of the lowest and the next row, one above the other: on any ranks, by way of sums
    std::vector<double> of_both(6, 0);
    const GlobalIndex ids[] = {1, 13};
    for (const bool put : {false, true}) {
      for (int i = 0; i < 2; ++i)
        for (int u = 0; u < 3; ++u) {
          const auto local = X.getMap()->getLocalElement(3 * ids[i] + u);
          if (local == Teuchos::OrdinalTraits<LocalIndex>::invalid()) continue;
          const auto x = algebra::host_view(X);
          if (put) x(local) = of_both[3 * (1 - i) + u];
          else of_both[3 * i + u] = x(local);
        }
      if (!put) core::Comm().sum(of_both);
    }
  };
  expect_refused(run);
}
TEST(Verifier, refuses_steps_that_are_not_as_long) {
  March run = slab_with_gas();
  run.meddle = [](const fv::Grid&, FlowStep& step) { step.length *= 1 + 1e-4; };
  expect_refused(run);
}

/// What belongs to a state alone, whatever the balances say.
TEST(Verifier, names_what_no_solution_can_be) {
  const auto worst_of = [](int u, GlobalIndex id, double value, FlowFindings::Worst FlowFindings::*what) {
    March run = slab_with_gas();
    run.perturb = in_cell(id, u, [=](double) { return value; });
    const FlowFindings found = run.found();
    EXPECT_NE(found.objection(tolerance, true), "");
    EXPECT_EQ((found.*what).cell, id);
    return (found.*what).violation;
  };
  EXPECT_GT(worst_of(gas_saturation, with_gas, -1e-4, &FlowFindings::negative_gas), 1e-3);
  EXPECT_GT(worst_of(dissolved, wet, 1e-2, &FlowFindings::supersaturated), 1);
  EXPECT_GT(worst_of(gas_saturation, wet, 1e-2, &FlowFindings::both_open), 1e-3);
  EXPECT_GT(worst_of(dissolved, wet, -1e-8, &FlowFindings::negative_dissolved), 1e-5);
  EXPECT_GT(worst_of(dissolved, wet, 1.5, &FlowFindings::all_dissolved), 0.4);
  EXPECT_GT(worst_of(pressure, wet, -1e5, &FlowFindings::negative_pressure), 0.09);
  EXPECT_GT(worst_of(gas_saturation, with_gas, 0.7, &FlowFindings::dry), 0.1);
  EXPECT_GT(worst_of(pressure, wet, std::nan(""), &FlowFindings::not_finite), 1);
}

}  // namespace
}  // namespace thixis::flow
