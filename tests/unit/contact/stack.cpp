/// Three membranes over each other, and two that meet at scattered points only: full, reduced and smoothed runs find the same solution,
/// which fulfils the contact conditions.
#include <gtest/gtest.h>

#include <cmath>

#include "setting.hpp"
#include "thixis/complementarity/newton.hpp"

namespace thixis::contact {
namespace {

using algebra::SolverKind;
using algebra::SystemForm;

/// f pushes the upper membrane down and the lower one up onto the one between them.
System stack(const Square& square) {
  System system{operators(square.space(), {scene::constant(1), scene::constant(2), scene::constant(0.5)}, false),
                constraint(square.space(), 2, Frames({make_frame(3, 2, of_rows({{1, 0}, {-1, 1}, {0, -1}}), {1, 2, 0.5})})),
                zero_load(square.space(), 3)};
  const double forces[] = {-8, 0.5, 5};
  for (int i = 0; i < 3; ++i) {
    const double f = forces[i];
    system.load->getVectorNonConst(i)->assign(
        square.load(scene::formula([f](double x, double y) { return f * (x < 0.6 ? 1 : -0.3) * (1 + y); })));
  }
  auto offset = Teuchos::rcp(new MultiVector(system.points(), 2));
  offset->getVectorNonConst(0)->putScalar(0.05);
  offset->getVectorNonConst(1)->putScalar(0.02);
  system.constraint.offset = offset;
  return system;
}

System scattered(const Square& square) {
  System system{operators(square.space(), {scene::constant(1), scene::constant(3)}, false),
                constraint(square.space(), 1, Frames({make_frame(2, 1, of_rows({{1}, {-1}}), {1, 3})}), 1, 3),
                zero_load(square.space(), 2)};
  system.load->getVectorNonConst(0)->assign(square.load(scene::constant(-8)));
  auto offset = Teuchos::rcp(new MultiVector(system.points(), 1));
  offset->putScalar(0.05);
  system.constraint.offset = offset;
  return system;
}

struct Found {
  Vector X;
  complementarity::NewtonReport report;
};

Found solve(const Square& square, const System& system, SystemForm form, SolverKind solver, int sweeps = 0,
            complementarity::CFunction function = complementarity::CFunction::min) {
  algebra::LinearParams params;
  params.form = form;
  params.solver = solver;
  Problem problem(std::make_shared<System>(system), params, square.nodes());
  complementarity::NewtonParams newton;
  newton.c_function = function;
  newton.sweeps = sweeps;
  Found found{Vector(problem.map()), {}};
  found.report = complementarity::newton(problem, found.X, newton, {}, 0);
  return found;
}

/// |E(X) - F|, and what gaps and multipliers violate.
void expect_solution(const Square& square, const System& system, const Vector& X) {
  const Problem problem(std::make_shared<System>(system), {}, square.nodes());
  Vector R(problem.map()), K(problem.points()), G(problem.points()), s(problem.points());
  problem.equations(X, R);
  problem.arguments(X, K, G);
  problem.scaling(s);
  EXPECT_LT(R.norm2(), 1e-8 * problem.reference_norm());
  const auto gap = algebra::host_view(K), lambda = algebra::host_view(G), scale = algebra::host_view(s);
  long long contact = 0, open = 0;
  for (std::size_t p = 0; p < gap.extent(0); ++p) {
    EXPECT_LT(std::abs(std::min(gap(p), scale(p) * lambda(p))), 1e-9);
    contact += lambda(p) > 0;
    open += gap(p) > 1e-6;
  }
  EXPECT_GT(core::Comm().sum(contact), 0);
  EXPECT_GT(core::Comm().sum(open), 0);
}

void expect_same(const Vector& X, const Vector& Y, const char* name) {
  Vector difference(X, Teuchos::Copy);
  difference.update(-1, Y, 1);
  EXPECT_LT(difference.norm2(), 1e-7 * X.norm2()) << name;
}

void expect_all_forms_agree(const Square& square, const System& system) {
  const Found full = solve(square, system, SystemForm::full, SolverKind::direct);
  ASSERT_TRUE(full.report.converged) << full.report.why;
  expect_solution(square, system, full.X);
  const std::pair<const char*, Found> others[] = {{"reduced, direct", solve(square, system, SystemForm::reduced, SolverKind::direct)},
                                                  {"reduced, GMRES", solve(square, system, SystemForm::reduced, SolverKind::gmres)},
                                                  {"full, GMRES", solve(square, system, SystemForm::full, SolverKind::gmres)},
                                                  {"smoothed", solve(square, system, SystemForm::reduced, SolverKind::direct, 2)},
                                                  {"Fischer-Burmeister", solve(square, system, SystemForm::reduced, SolverKind::direct, 0,
                                                                               complementarity::CFunction::fischer_burmeister)}};
  for (const auto& [name, found] : others) {
    EXPECT_TRUE(found.report.converged) << name << ": " << found.report.why;
    expect_same(full.X, found.X, name);
  }
}

}  // namespace

TEST(Stack, of_three_membranes_is_solved_in_all_forms) {
  const Square square(1, 3);
  expect_all_forms_agree(square, stack(square));
}

TEST(Stack, points_that_are_not_the_first_unknowns_are_solved_in_all_forms) {
  const Square square(2, 2);
  expect_all_forms_agree(square, scattered(square));
}

TEST(Stack, solutions_are_fixed_points_of_projected_jacobi) {
  const Square square(1, 3);
  for (const System& system : {stack(square), scattered(square)}) {
    const Found found = solve(square, system, SystemForm::reduced, SolverKind::direct);
    Vector X(found.X, Teuchos::Copy);
    ProjectedJacobi smooth(system);
    smooth(3, X);
    expect_same(found.X, X, "three sweeps");
  }
}

}  // namespace thixis::contact
