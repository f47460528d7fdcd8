/// How near the bound is to the error, at the solution and on the way to it.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <map>

#include "iterates.hpp"

namespace thixis::verification {
namespace {

/// The bound of the discrete solution, solved exactly. Every one is a row of bounds.csv in the working folder.
Seen at_convergence(drive::RunParams params, const std::string& problem, int level, const std::string& name) {
  const method::MethodParams& method = params.method;
  params.stopping.linear_tolerance = 1e-12;
  params.stopping.nonlinear_tolerance = 1e-11;
  if (level > 2 && (method.name != "fem" || level > 4)) {
    params.linear.solver = method_of(method.name).symmetric(method) ? algebra::SolverKind::cg : algebra::SolverKind::gmres;
    params.linear.preconditioner = algebra::PreconditionerKind::ilu;
    if (method.name == "fem") params.linear.preconditioner = algebra::PreconditionerKind::muelu;
  }
  const Solved run = solve(params);
  EXPECT_TRUE(run.outcome.solved) << problem << ", T_" << level << ", " << name << ": " << run.outcome.finest.why;
  const Seen seen = {run.outcome.discretization->estimate(*run.outcome.X), *run.outcome.energy_error};
  const std::string where = problem + ", T_" + std::to_string(level) + ", " + name;
  EXPECT_GE(seen.effectivity(), 1) << where;
  // eta_lin holds the root of multiplier times gap: where GMRES or a matrix without symmetry leaves 1e-13 of it, 1e-6 is seen
  const double round_off = 1e-8 * run.outcome.energy_norm;  // the root of a unit in the last place of the gap
  const bool exact = method_of(method.name).symmetric(method) && params.linear.solver == algebra::SolverKind::direct;
  EXPECT_LE(seen.eta.linearization, (exact ? 1e-9 : 1e-6) * seen.eta.discretization + round_off) << where;
  EXPECT_LE(seen.eta.algebraic, (exact ? 1e-7 : 1e-5) * seen.eta.discretization + round_off) << where;
  std::ofstream("bounds.csv", std::ios::app) << problem << ',' << name << ',' << level << ',' << seen.error << ',' << seen.eta.total << ','
                                             << seen.effectivity() << '\n';
  return seen;
}

Seen at_convergence(const std::string& problem, int level, const std::string& name, const method::MethodParams& method) {
  return at_convergence(known_case(problem, level, method), problem, level, name);
}

struct Limits {
  const char* problem;
  double degree_2, degree_3_and_4;
};
const Limits limits[] = {{"smooth contact", 6, 2.5}, {"discontinuous multiplier", 6, 10}, {"disk b", 6, 10}};

/// The indices of finite elements of a degree on the meshes up to `finest` are below the limits, and from T_1 on none is more than twice
/// as large as that on T_1.
void expect_sharp(int degree, int finest) {
  for (const Limits& limit : limits) {
    double first = 0;
    for (int level = 0; level <= finest; ++level) {
      const double index = at_convergence(limit.problem, level, "fem P" + std::to_string(degree), by("fem", degree)).effectivity();
      const std::string where = std::string(limit.problem) + ", P" + std::to_string(degree) + ", T_" + std::to_string(level);
      if (level == 1) first = index;
      if (level > 1) {
        EXPECT_LE(index, 2 * first) << where;
      }
      if (degree > 1) {
        EXPECT_LE(index, degree == 2 ? limit.degree_2 : limit.degree_3_and_4) << where;
      } else if (level >= 3) {
        EXPECT_LE(index, level >= 5 ? 1.1 : 1.2) << where;
      }
    }
  }
}

}  // namespace

TEST(Sharpness, of_finite_elements_of_degree_1_is_one_fifth_on_T_3) { expect_sharp(1, 3); }
TEST(Sharpness, of_finite_elements_of_degree_2_is_bounded) { expect_sharp(2, 3); }
TEST(Sharpness, of_finite_elements_of_degree_3_is_bounded) { expect_sharp(3, 2); }
TEST(Sharpness, of_finite_elements_of_degree_4_is_bounded) { expect_sharp(4, 2); }
TEST(FarSharpness, of_finite_elements_of_degree_1_is_one_tenth_on_T_5) { expect_sharp(1, 5); }
TEST(FarSharpness, of_finite_elements_of_higher_degree_is_bounded_up_to_T_4) {
  for (int p = 2; p <= 4; ++p) expect_sharp(p, 4);
}

namespace {

const std::map<std::string, std::string> wave = {{"u", "0.3*sin(x+2*y)"}, {"x", "0.3*cos(x+2*y)"}, {"y", "0.6*cos(x+2*y)"}};

/// Both membranes are the wave, pressed on each other by 2 + xy: with what else the scene has.
drive::RunParams one_wave(std::map<std::string, std::string> scene, int level) {
  for (const std::string u : {"u1", "u2"}) {
    scene[u] = wave.at("u");
    for (const std::string d : {"x", "y"}) scene[u + "_" + d] = wave.at(d);
  }
  scene["lambda"] = "2+x*y";
  return data(scene, level);
}

/// Two membranes on each other everywhere, also where they are held: there boundary nodes have no multiplier. Their moments against vertex
/// functions of degree 2, which have no mean, are of both signs.
drive::RunParams contact_everywhere(int level) {
  return one_wave({{"f1", "1.5*sin(x+2*y)-(2+x*y)"}, {"f2", "1.5*sin(x+2*y)+(2+x*y)"}}, level);
}

/// The same with tensions that vary, each in its way: what the data on the boundary have beyond their interpolant is lifted differently.
drive::RunParams varying_tensions(int level) {
  return one_wave({{"mu1", "1+x"},
                   {"mu2", "2-y"},
                   {"f1", "(1+x)*1.5*sin(x+2*y)-0.3*cos(x+2*y)-(2+x*y)"},
                   {"f2", "(2-y)*1.5*sin(x+2*y)+0.6*cos(x+2*y)+(2+x*y)"}},
                  level);
}

/// A membrane on an obstacle that is no polynomial, everywhere.
drive::RunParams on_a_curved_obstacle(int level) {
  return data({{"f", "1.5*sin(x+2*y)-(2+x*y)"},
               {"psi", wave.at("u")},
               {"u", wave.at("u")},
               {"u_x", wave.at("x")},
               {"u_y", wave.at("y")},
               {"lambda", "2+x*y"}},
              level, "obstacle");
}

/// Every method, on the meshes up to `finest`: at most 3, and none grows by more than a tenth from mesh to mesh. On a curved obstacle NIPG
/// with weak data has multipliers of both signs on the coarsest mesh, and up to 3.7.
void expect_at_most_3(const std::string& problem, const std::function<drive::RunParams(int)>& on_level, int finest, int lowest = 1) {
  for (int p = lowest; p <= 4; ++p)
    for (const auto& [name, method] : all_variants(p)) {
      double before = 10;
      for (int level = 0; level <= finest; ++level) {
        auto params = on_level(level);
        params.method = method;
        const double index = at_convergence(params, problem, level, name).effectivity();
        const bool signs = level == 0 && params.scene.model == "obstacle" && name.find("nipg, weak") == 0;
        EXPECT_LE(index, signs ? 4 : 3) << problem << ", T_" << level << ", " << name;
        EXPECT_LE(index, 1.1 * before) << problem << ", T_" << level << ", " << name;
        before = index;
      }
    }
}

}  // namespace

TEST(Sharpness, of_contact_up_to_the_held_boundary_is_three_at_most) { expect_at_most_3("contact everywhere", contact_everywhere, 1); }
TEST(Sharpness, of_contact_with_varying_tensions_is_three_at_most) { expect_at_most_3("varying tensions", varying_tensions, 1, 4); }
TEST(Sharpness, of_contact_with_a_curved_obstacle_is_three_at_most) { expect_at_most_3("curved obstacle", on_a_curved_obstacle, 1); }
TEST(FarSharpness, of_contact_up_to_the_held_boundary_is_three_at_most) { expect_at_most_3("contact everywhere", contact_everywhere, 2); }
TEST(FarSharpness, of_contact_with_varying_tensions_is_three_at_most) { expect_at_most_3("varying tensions", varying_tensions, 2); }
TEST(FarSharpness, of_contact_with_a_curved_obstacle_is_three_at_most) { expect_at_most_3("curved obstacle", on_a_curved_obstacle, 2); }

namespace {

void expect_bounds_of_all(const std::string& problem, int coarsest, int finest) {
  for (int level = coarsest; level <= finest; ++level)
    for (int p = 1; p <= 4; ++p)
      for (const auto& [name, method] : all_variants(p))
        if (name.find("fem P") == std::string::npos && name.find("strong") == std::string::npos)
          at_convergence(problem, level, name, method);
}

}  // namespace

TEST(Sharpness, of_dg_and_hho_is_no_less_than_1_at_the_solution) {
  for (const Limits& limit : limits) expect_bounds_of_all(limit.problem, 0, 1);
}
TEST(FarSharpness, of_dg_and_hho_is_no_less_than_1_on_smooth_contact) { expect_bounds_of_all("smooth contact", 2, 3); }
TEST(FarSharpness, of_dg_and_hho_is_no_less_than_1_with_the_discontinuous_multiplier) {
  expect_bounds_of_all("discontinuous multiplier", 2, 3);
}
TEST(FarSharpness, of_dg_and_hho_is_no_less_than_1_on_the_disk) { expect_bounds_of_all("disk b", 2, 3); }

/// The published bound is 24 times the error there, because of its global constants.
TEST(Sharpness, of_the_disk_after_the_first_step_of_a_cold_start_is_8_at_most) {
  auto params = known_case("disk", 0, by("fem", 1));
  params.mesh.rings = 36;
  params.newton.start = complementarity::Start::cold;
  const Laid laid = lay(params);
  EXPECT_EQ(laid.hierarchy.finest().global_cells, 7776);
  for (const auto function : {complementarity::CFunction::min, complementarity::CFunction::fischer_burmeister}) {
    auto newton = params.newton;
    newton.c_function = function;
    newton.max_iterations = 1;
    const auto X = laid->cold_start();
    complementarity::newton(laid->problem(), *X, newton, params.stopping, 10);
    const Seen seen = laid.look(*X);
    EXPECT_GE(seen.effectivity(), 1);
    EXPECT_LE(seen.effectivity(), 8);
    std::cout << "first step on the disk, 7776 cells: bound " << seen.eta.total << ", error " << seen.error << ", index "
              << seen.effectivity() << '\n';
  }
}

namespace {

/// Krylov iterations decrease eta_alg, Newton steps eta_lin, both to nothing. In reduced form contact points have no gap at all; otherwise
/// a gap of the size of round-off is left there, and eta_lin holds the root of gap times multiplier.
void expect_decay(const std::string& problem, const std::string& name, const method::MethodParams& method, algebra::SystemForm form) {
  auto params = known_case(problem, 1, method);
  params.newton.start = complementarity::Start::cold;
  params.linear = {};
  params.linear.form = form;
  params.stopping.estimate = true;
  params.stopping.linear_tolerance = 1e-13;
  params.stopping.nonlinear_tolerance = 1e-11;
  std::vector<std::vector<complementarity::Estimate>> within(1);
  std::vector<complementarity::Estimate> steps;
  complementarity::NewtonObserver observer;
  observer.linear = [&](const complementarity::LinearRecord& record) { within.back().push_back(*record.estimate); };
  observer.step = [&](const complementarity::NewtonRecord& record) {
    steps.push_back(*record.estimate);
    within.emplace_back();
  };
  const Laid laid = lay(params);
  const auto X = laid->cold_start();
  const auto report = complementarity::newton(laid->problem(), *X, params.newton, params.stopping, 5, observer,
                                              [&](const algebra::Vector& at) { return laid->estimate(at); });
  ASSERT_TRUE(report.converged) << name << ": " << report.why;
  ASSERT_GE(steps.size(), 2u) << name;
  EXPECT_LE(steps.back().linearization, (form == algebra::SystemForm::reduced ? 1e-9 : 1e-5) * steps.back().discretization) << name;
  EXPECT_LE(steps.back().algebraic, 1e-8 * steps.back().discretization) << name;
  EXPECT_GT(steps.front().linearization, 1e-3 * steps.front().discretization) << name;
  for (const auto& looks : within)
    if (looks.size() > 1 && looks.front().algebraic > 1e-6 * looks.front().discretization) {
      EXPECT_LT(looks.back().algebraic, 0.1 * looks.front().algebraic) << name;
    }
}

}  // namespace

TEST(Components, of_the_bound_decrease_with_the_iterations_that_they_belong_to_and_vanish) {
  for (const auto form : {algebra::SystemForm::full, algebra::SystemForm::reduced})
    for (int p = 1; p <= 2; ++p)
      for (const auto& [name, method] : all_variants(p)) expect_decay("discontinuous multiplier", name, method, form);
}

}  // namespace thixis::verification
