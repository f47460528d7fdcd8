/// Laws, fluxes, Jacobian and steps of two-phase flow, against values of an independent program and against what must hold anyway.
#include "thixis/flow/two_phase.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "problem/increments.hpp"
#include "problem/problem.hpp"
#include "thixis/complementarity/newton.hpp"
#include "thixis/flow/scene.hpp"

namespace thixis::flow {
namespace {

using algebra::Vector;
using Json = nlohmann::json;

constexpr double year = 31557600;

const Json& vectors() {
  static const Json all = Json::parse(std::ifstream(TWO_PHASE_VECTORS));
  return all;
}

TwoPhaseScene catalogued(const std::string& name) {
  models::SceneParams params;
  params.model = "two-phase";
  params.case_name = name;
  return two_phase_scene(params);
}

std::unique_ptr<models::UnsteadyModel> made(const TwoPhaseScene& scene) {
  return two_phase(scene, algebra::LinearParams{}, year, TwoPhaseBoundParams{});
}

mesh::MeshParams interval(int cells, double length) {
  mesh::MeshParams params;
  params.generator = mesh::Generator::interval;
  params.lower = {0};
  params.upper = {length};
  params.cells = {cells};
  return params;
}
mesh::MeshParams tensor(int nx, int ny, double width, double height) {
  mesh::MeshParams params;
  params.generator = mesh::Generator::tensor;
  params.upper = {width, height};
  params.cells = {nx, ny};
  return params;
}

void expect_near(double a, double b, double relative, const std::string& what) {
  EXPECT_LE(std::abs(a - b), relative * std::max(std::abs(a), std::abs(b))) << what << ": " << a << " and " << b;
}

TEST(TwoPhaseLaws, are_those_of_the_independent_program) {
  const TwoPhaseLaws laws = two_phase_laws(catalogued("gas injection"));
  for (const Json& row : vectors()["laws"]) {
    const double s_g = row["Sg"];
    const std::string at = "s_g = " + std::to_string(s_g);
    const auto expect = [&](const Law& law, const char* value, const char* slope) {
      expect_near(law.value, row[value], 1e-10, at + " " + value);
      expect_near(-law.slope, row[slope], 1e-10, at + " " + slope);
    };
    expect(laws.capillary(s_g), "Pc", "dPc_dSl");
    expect(laws.k_rl(s_g), "krl", "dkrl_dSl");
    expect(laws.k_rg(s_g), "krg", "dkrg_dSl");
  }
}

TEST(TwoPhaseLaws, face_fluxes_are_those_of_the_independent_program) {
  const TwoPhaseLaws laws = two_phase_laws(catalogued("gas injection"));
  for (const Json& row : vectors()["fluxes_kg_per_m2_s"]) {
    const auto state = [&](const char* side) { return laws.state(row[side][0], row[side][1], row[side][2]); };
    const FaceFlux flux = laws.flux(state("left_Sg_P_chi"), state("right_Sg_P_chi"), row["dist"], 0);
    expect_near(flux.value[water], row["Phi_w"], 1e-10, "water");
    expect_near(flux.value[hydrogen], row["Phi_h"], 1e-10, "hydrogen");
  }
}

TEST(TwoPhaseLaws, the_quadratic_law_meets_the_other_one_with_its_slope) {
  const TwoPhaseLaws wet = two_phase_laws(catalogued("gas injection short")), laws = two_phase_laws(catalogued("gas injection"));
  EXPECT_EQ(wet.capillary(0).value, 0);
  expect_near(wet.a, 1.7024e7, 1e-4, "a");
  expect_near(wet.b, -6.695e6, 1e-4, "b");
  const Law before = wet.capillary(0.1 - 1e-12), after = wet.capillary(0.1 + 1e-12), other = laws.capillary(0.1);
  for (const Law& law : {before, after}) {
    expect_near(law.value, other.value, 1e-9, "value");
    expect_near(law.slope, other.slope, 1e-9, "slope");
  }
}

/// Gas up to S_gr does not move, but has a pressure that rises: the matrix of a step needs its slope.
TEST(TwoPhaseLaws, rise_from_zero_below_the_residual_saturation_of_the_gas) {
  TwoPhaseScene scene = catalogued("gas injection");
  scene.medium.S_gr = 0.2;
  const TwoPhaseLaws laws = two_phase_laws(scene);
  const double end = 0.2 + laws.eps * laws.width;
  EXPECT_EQ(laws.capillary(0).value, 0);
  expect_near(laws.capillary(end * (1 - 1e-12)).value, laws.capillary(end * (1 + 1e-12)).value, 1e-6, "where the line ends");
  double before = -1;
  for (double s_g = 0; s_g < 0.59; s_g += 0.01) {
    EXPECT_GT(laws.capillary(s_g).value, before) << s_g;
    EXPECT_GT(laws.capillary(s_g).slope, 0) << s_g;
    EXPECT_EQ(laws.k_rg(s_g).value > 0, laws.e_of(s_g) > 0) << s_g;
    before = laws.capillary(s_g).value;
  }
  scene.medium.S_gr = 0.0999;
  scene.capillary_law = CapillaryLaw::quadratic;
  EXPECT_THROW(two_phase_laws(scene), core::InputError);
}

TEST(TwoPhaseLaws, are_finite_and_continuous_far_outside) {
  for (const char* name : {"gas injection", "gas injection short"}) {
    const TwoPhaseLaws laws = two_phase_laws(catalogued(name));
    for (double s_g : {-1e6, -3., -0.5, 0.594, 0.6, 0.7, 1., 4., 1e6})
      for (const Law& law : {laws.capillary(s_g), laws.k_rl(s_g), laws.k_rg(s_g)}) {
        EXPECT_TRUE(std::isfinite(law.value)) << s_g;
        EXPECT_TRUE(std::isfinite(law.slope)) << s_g;
      }
    const double dry = TwoPhaseLaws::dry * laws.width;
    for (double kink : {0., dry, laws.width})
      for (auto law : {&TwoPhaseLaws::capillary, &TwoPhaseLaws::k_rl, &TwoPhaseLaws::k_rg})
        expect_near(1e3 + (laws.*law)(kink - 1e-13).value, 1e3 + (laws.*law)(kink + 1e-13).value, 1e-7, "at a kink");
  }
}

/// Central differences of the fluxes, sixth order, in both states, with gravity; at states between gas and no gas, away from kinks.
TEST(TwoPhaseLaws, fluxes_have_the_derivatives_they_claim) {
  TwoPhaseScene scene = catalogued("gas injection");
  const TwoPhaseLaws laws = two_phase_laws(scene);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    double x[2][unknowns_per_cell];
    for (auto& side : x) {
      const double s_g = trial % 3 == 0   ? 1e-3 + 0.05 * unit(random)
                         : trial % 3 == 1 ? -1e-3 - 1e-2 * unit(random)
                                          : 0.01 + 0.4 * unit(random);
      side[0] = s_g, side[1] = 8e5 + 4e5 * unit(random), side[2] = 1e-4 * unit(random);
    }
    const double g_n = 9.81 * (2 * unit(random) - 1);
    const auto flux = [&](int side, int u, double change) {
      double y[2][unknowns_per_cell];
      std::copy(&x[0][0], &x[0][0] + 2 * unknowns_per_cell, &y[0][0]);
      y[side][u] += change;
      return laws.flux(laws.state(y[0][0], y[0][1], y[0][2]), laws.state(y[1][0], y[1][1], y[1][2]), 0.2, g_n);
    };
    const FaceFlux claimed = flux(0, 0, 0);
    const double size[unknowns_per_cell] = {1, 1e6, 1e-4};
    for (int c = 0; c < components; ++c) {
      double largest = 0;
      for (int u = 0; u < unknowns_per_cell; ++u)
        largest = std::max({largest, std::abs(claimed.by_first[c][u]) * size[u], std::abs(claimed.by_second[c][u]) * size[u]});
      for (int side = 0; side < 2; ++side)
        for (int u = 0; u < unknowns_per_cell; ++u) {
          const double h = 1e-5 * size[u];
          const auto pair = [&](int k) { return flux(side, u, k * h).value[c] - flux(side, u, -k * h).value[c]; };
          const double difference = (45 * pair(1) - 9 * pair(2) + pair(3)) / (60 * h);
          const double exact = side == 0 ? claimed.by_first[c][u] : claimed.by_second[c][u];
          EXPECT_NEAR(difference * size[u] / largest, exact * size[u] / largest, 1e-6) << trial << " " << c << side << u;
        }
    }
  }
}

/// A step of a scene on a grid, with what the problem needs.
struct Step {
  TwoPhaseOperator flow;
  Teuchos::RCP<Vector> X;
  TwoPhaseProblem problem;

  Step(const mesh::MeshParams& mesh, const TwoPhaseScene& scene, double years)
      : flow(fv::build(mesh, core::Comm(), ""), scene, year),
        X(flow.initial()),
        problem(flow, FlowScales(flow.laws(), 1e6), algebra::LinearParams{}, X) {
    problem.begin(flow.step(0, years, *X));
  }
};

/// A X' of the system against differences of R along a random direction, in 2D with gravity, gas, no gas, and all kinds of boundary.
TEST(TwoPhaseProblem, linearizes_its_equations_exactly) {
  Step step(tensor(7, 5, 200, 20), catalogued("gas injection 2d"), 5000);
  const fv::Grid& grid = step.flow.grid();
  {
    const auto x = algebra::host_view(*step.X);
    for (LocalIndex K = 0; K < grid.owned_cells; ++K) {
      std::mt19937 random(static_cast<unsigned>(grid.cell_id[K]) + 1);
      std::uniform_real_distribution<double> unit(0, 1);
      x(3 * K) = grid.cell_id[K] % 2 == 0 ? 0.01 + 0.1 * unit(random) : -0.001 - 0.01 * unit(random);
      x(3 * K + 1) += 1e5 * unit(random);
      x(3 * K + 2) = 1e-4 * unit(random);
    }
  }
  Vector K(step.problem.points()), G(step.problem.points()), a(step.problem.points()), b(step.problem.points());
  a.putScalar(0.3);
  b.putScalar(17);
  step.problem.linearize(*step.X, a, b);

  Vector y(step.flow.map()), Ay(step.flow.map()), difference(step.flow.map());
  {
    const auto direction = algebra::host_view(y);
    for (LocalIndex c = 0; c < grid.owned_cells; ++c)
      for (int u = 0; u < 3; ++u) direction(3 * c + u) = std::sin(1 + 3 * grid.cell_id[c] + u);
  }
  step.problem.matrix().apply(y, Ay);
  const double h = 1e-5, weight[] = {45, -9, 1};
  for (int k = 1; k <= 3; ++k)
    for (const double sign : {1., -1.}) {
      Vector X(*step.X, Teuchos::Copy), R(step.flow.map());
      {
        const auto x = algebra::host_view(X);
        const auto direction = algebra::host_view(y);
        for (LocalIndex i = 0; i < 3 * grid.owned_cells; ++i) x(i) += sign * k * h * step.problem.scales().unknown[i % 3] * direction(i);
      }
      step.problem.equations(X, R);
      step.problem.arguments(X, K, G);
      Vector C(step.problem.points());
      C.update(0.3, K, 17, G, 0);
      step.problem.insert(C, R);
      difference.update(sign * weight[k - 1] / (60 * h), R, 1);
    }
  difference.update(-1, Ay, 1);
  EXPECT_LE(difference.normInf(), 1e-7 * Ay.normInf());
}

/// All of it: the run of the independent program, through the evolution and the nonlinear solver.
void expect_run_of_ten_cells(complementarity::CFunction function, const char* name) {
  const auto model = made(catalogued("gas injection"));
  const auto evolution = model->evolve(interval(10, 200), core::Comm(), "", {});
  const auto X = evolution->initial();
  complementarity::NewtonParams newton;
  newton.c_function = function;
  complementarity::StoppingParams stopping;
  stopping.linear_tolerance = stopping.nonlinear_tolerance = 1e-13;
  double begin = 0;
  for (const Json& row : vectors()["N10_dt5000_first_8_steps"][name]) {
    const double end = row["t"];
    const Vector before(*X, Teuchos::Copy);
    evolution->begin({begin, end}, before);
    const auto report = complementarity::newton(evolution->problem(), *X, newton, stopping, 0);
    ASSERT_TRUE(report.converged) << report.why;
    evolution->accept(*X);
    const auto state = evolution->save(*X);
    for (std::size_t i = 0; i < state.blocks[0].ids.size(); ++i) {
      const auto id = static_cast<std::size_t>(state.blocks[0].ids[i]);
      EXPECT_NEAR(state.blocks[0].values[i], row["Sg"][id].get<double>(), 1e-10) << end << " " << id;
      EXPECT_NEAR(state.blocks[1].values[i] / row["Pl"][id].get<double>(), 1, 1e-10) << end << " " << id;
      EXPECT_NEAR(state.blocks[2].values[i] / 1e-4, row["chi"][id].get<double>() / 1e-4, 1e-10) << end << " " << id;
    }
    begin = end;
  }
  for (const models::Balance& balance : evolution->balances())
    EXPECT_LE(balance.worst_step, balance.name == "water" ? 1e-12 : 1e-9) << balance.name;
}
TEST(TwoPhaseEvolution, with_min_is_the_run_of_the_independent_program) { expect_run_of_ten_cells(complementarity::CFunction::min, "min"); }
TEST(TwoPhaseEvolution, with_fischer_burmeister_is_the_run_of_the_independent_program) {
  expect_run_of_ten_cells(complementarity::CFunction::fischer_burmeister, "fb");
}

/// Water under its weight and nothing else: the fluxes vanish up to rounding, in the slab and in the column.
TEST(TwoPhaseProblem, water_at_rest_stays_at_rest) {
  TwoPhaseScene scene = catalogued("gas injection 2d");
  scene.boundary.erase("left");
  Step step(tensor(8, 6, 200, 20), scene, 5000);
  Vector R(step.flow.map());
  step.problem.equations(*step.X, R);
  const double flow = 5000 * year * 5e-20 / 1e-3 * 1e6 / (0.15 * 3 * 3);  // what a fall of 1e6 Pa between two cells would bring
  EXPECT_LE(R.normInf(), 1e-14 * flow * step.problem.weight(water));
}

/// Gas in a closed column: nothing is lost, whatever it does.
TEST(TwoPhaseEvolution, keeps_all_masses_in_a_closed_column) {
  const auto model = made(catalogued("closed column"));
  const auto evolution = model->evolve(interval(40, 20), core::Comm(), "", {});
  const auto X = evolution->initial();
  complementarity::StoppingParams stopping;
  stopping.linear_tolerance = stopping.nonlinear_tolerance = 1e-12;
  for (int n = 0; n < 10; ++n) {
    const Vector before(*X, Teuchos::Copy);
    evolution->begin({50. * n, 50. * (n + 1)}, before);
    ASSERT_TRUE(complementarity::newton(evolution->problem(), *X, {}, stopping, 0).converged);
    evolution->accept(*X);
  }
  for (const models::Balance& balance : evolution->balances()) {
    EXPECT_LE(balance.worst_step, 1e-9) << balance.name;
    EXPECT_LE(balance.total, 1e-9) << balance.name;
  }
}

/// Linear systems solved loosely, without preconditioner and by incomplete factors: the sums of the rows vanish all the same.
TEST(TwoPhaseEvolution, closes_both_balances_whatever_the_linear_solver_leaves) {
  for (const auto preconditioner : {algebra::PreconditionerKind::none, algebra::PreconditionerKind::ilu}) {
    algebra::LinearParams linear;
    linear.preconditioner = preconditioner;
    const auto model = two_phase(catalogued("gas injection 2d"), linear, year, TwoPhaseBoundParams{});
    const auto evolution = model->evolve(tensor(12, 4, 200, 20), core::Comm(), "", {});
    const auto X = evolution->initial();
    complementarity::StoppingParams stopping;
    stopping.linear_tolerance = 1e-8;
    for (int n = 0; n < 4; ++n) {
      const Vector before(*X, Teuchos::Copy);
      evolution->begin({1e4 * n, 1e4 * (n + 1)}, before);
      const auto report = complementarity::newton(evolution->problem(), *X, {}, stopping, 0);
      ASSERT_TRUE(report.converged) << report.why;
      evolution->accept(*X);
    }
    for (const models::Balance& balance : evolution->balances())
      EXPECT_LE(balance.worst_step, balance.name == "water" ? 1e-12 : 1e-9) << balance.name;
  }
}

/// A tolerance that leaves much in every step: what is left is owed, not lost, so that all steps together miss what the last one leaves.
TEST(TwoPhaseEvolution, owes_what_a_step_leaves) {
  const auto model = made(catalogued("gas injection"));
  const auto evolution = model->evolve(interval(20, 200), core::Comm(), "", {});
  const auto X = evolution->initial();
  complementarity::StoppingParams stopping;
  stopping.nonlinear_tolerance = 1e-3;
  double worst = 0, owed = 0;
  for (int n = 0; n < 40; ++n) {
    const Vector before(*X, Teuchos::Copy);
    evolution->begin({1e3 * n, 1e3 * (n + 1)}, before);
    ASSERT_TRUE(complementarity::newton(evolution->problem(), *X, {}, stopping, 0).converged);
    evolution->accept(*X);
    owed = 0;
    for (const auto& block : evolution->save(*X).blocks)
      if (block.name == "owed hydrogen")
        for (const double value : block.values) owed += 10 * value;  // cells of 10 m
    owed = std::abs(core::Comm().sum(owed));
    worst = std::max(worst, owed);
  }
  const double brought = 4e4 * 5.57e-6;
  EXPECT_GT(worst, 1e-9 * brought) << "or else there is nothing to see";
  for (const models::Balance& balance : evolution->balances()) {
    if (balance.name != "hydrogen") continue;
    EXPECT_NEAR(balance.total, owed / brought, 1e-12);
  }
}

TEST(TwoPhaseIncrements, of_saturation_end_behind_the_next_corner) {
  TwoPhaseScene scene = catalogued("gas injection");
  scene.medium.S_gr = 0.02;
  const TwoPhaseLaws trapped = two_phase_laws(scene);
  const double low = 0.02, high = low + trapped.eps * trapped.width, past = 1e-2 * (high - low);
  EXPECT_DOUBLE_EQ(end_of_saturation(trapped, 0.005, 0.01), 0.015);
  for (const double from : {0.0, 0.01, low - past}) {
    const double end = end_of_saturation(trapped, from, 0.1);
    EXPECT_GT(end, low);
    EXPECT_LT(end, low + past);
  }
  const double up = end_of_saturation(trapped, 0.5 * (low + high), 0.1);
  EXPECT_TRUE(up > high && up < high + past) << up;
  const double down = end_of_saturation(trapped, 0.1, -0.1);
  EXPECT_TRUE(down < high && down > high - past) << down;
  const double further = end_of_saturation(trapped, down, -0.1);
  EXPECT_TRUE(further < low && further > low - past) << further;
  EXPECT_DOUBLE_EQ(end_of_saturation(trapped, 0.1, 0.05), 0.15);

  const TwoPhaseLaws mobile = two_phase_laws(catalogued("gas injection"));
  EXPECT_DOUBLE_EQ(end_of_saturation(mobile, 0.1, -0.15), -0.05) << "no corner but that of the contact conditions";
  EXPECT_DOUBLE_EQ(end_of_saturation(mobile, 0.1, 7), 0.3);
  EXPECT_DOUBLE_EQ(end_of_saturation(mobile, 0.1, -7), -0.1);
}

TEST(TwoPhaseIncrements, are_shortened_cell_by_cell) {
  const TwoPhaseOperator flow(fv::build(interval(6, 200), core::Comm(), ""), catalogued("gas injection"), year);
  const double unknown[unknowns_per_cell] = {1, 1e6, 1e-4};
  Vector X(flow.map()), dX(flow.map());
  X.putScalar(0);
  const auto first = flow.map()->getMinAllGlobalIndex();
  const auto set = [&](int cell, Unknown u, double value) {
    const auto row = flow.map()->getLocalElement(first + unknowns_per_cell * cell + u);
    if (row >= 0) algebra::host_view(dX)(row) = value;
  };
  const auto largest = [&] { return dX.normInf(); };
  set(2, pressure, -9e6);
  set(4, gas_saturation, 0.19);
  EXPECT_FALSE(shortened(flow.laws(), unknown, X, dX));
  EXPECT_EQ(largest(), 9e6);
  set(2, pressure, -9e9);
  EXPECT_TRUE(shortened(flow.laws(), unknown, X, dX)) << "on all ranks";
  EXPECT_EQ(largest(), 1e7);
  set(2, pressure, 0);
  set(5, dissolved, 1);
  EXPECT_TRUE(shortened(flow.laws(), unknown, X, dX));
  set(4, gas_saturation, 0);
  EXPECT_DOUBLE_EQ(largest(), 1e-3);
}

/// A row of A and what is left in it may have any unit.
TEST(TwoPhaseIncrements, that_a_residual_stands_for_have_the_units_of_unknowns) {
  const core::Comm comm;
  const auto first = static_cast<GlobalIndex>(2 * comm.rank());
  const auto map = algebra::map_of(std::vector<GlobalIndex>{first, first + 1}, comm);
  for (const double unit : {1.0, 1e-9, 1e12}) {
    algebra::Matrix A(map, 2);
    Vector r(map);
    for (int i = 0; i < 2; ++i) {
      const double scale = i == 0 ? unit : 1 / unit;
      const GlobalIndex columns[] = {first, first + 1};
      const double values[] = {i == 0 ? -2 * scale : 0.5 * scale, i == 0 ? 0.5 * scale : -2 * scale};
      A.insertGlobalValues(first + i, 2, values, columns);
      r.replaceGlobalValue(first + i, comm.rank() == comm.size() - 1 && i == 1 ? -6e-3 * scale : 1e-3 * scale);
    }
    A.fillComplete();
    EXPECT_NEAR(largest_left(A, r), 3e-3, 1e-15) << unit;
  }
}

TEST(TwoPhaseEvolution, refuses_parts_of_the_boundary_and_probes_that_are_not_there) {
  TwoPhaseScene scene = catalogued("gas injection");
  scene.boundary["lid"];
  EXPECT_THROW(made(scene)->evolve(interval(4, 200), core::Comm(), "", {}), core::InputError);
  EXPECT_THROW(made(catalogued("gas injection"))->evolve(interval(4, 200), core::Comm(), "", {{}, {}, {{"output/probes", {250, 0}}}}),
               core::InputError);
  EXPECT_THROW(made(catalogued("gas injection"))->evolve(interval(4, 200), core::Comm(), "", {{"u1"}, {}, {}}), core::InputError);
}

}  // namespace
}  // namespace thixis::flow
