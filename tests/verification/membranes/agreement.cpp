/// One answer whatever the linear algebra, the C-function and the number of ranks.
#include <gtest/gtest.h>

#include <cmath>

#include "problems.hpp"

namespace thixis::verification {
namespace {

using algebra::PreconditionerKind;
using algebra::SolverKind;
using algebra::SystemForm;

struct Way {
  const char* name;
  SystemForm form;
  SolverKind solver;
  PreconditionerKind preconditioner;
  double tolerance;  ///< of the linear solver
};
const Way ways[] = {
    {"full, GMRES, ILU", SystemForm::full, SolverKind::gmres, PreconditionerKind::ilu, 1e-12},
    {"full, direct", SystemForm::full, SolverKind::direct, PreconditionerKind::none, 1e-12},
    {"reduced, GMRES, ILU", SystemForm::reduced, SolverKind::gmres, PreconditionerKind::ilu, 1e-12},
    {"reduced, CG, MueLu", SystemForm::reduced, SolverKind::cg, PreconditionerKind::muelu, 1e-12},
    {"reduced, direct", SystemForm::reduced, SolverKind::direct, PreconditionerKind::none, 1e-12},
};

drive::RunParams by(drive::RunParams params, const Way& way) {
  params.linear.form = way.form;
  params.linear.solver = way.solver;
  params.linear.preconditioner = way.preconditioner;
  params.stopping.linear_tolerance = way.tolerance;
  params.stopping.nonlinear_tolerance = 1e-11;
  params.mesh.cells_per_rank = 50;
  return params;
}

/// All ways with Newton-min, cold and nested, and Fischer-Burmeister, on all ranks together; and each rank alone by the first way.
void expect_agreement(drive::RunParams params) {
  for (const auto start : {complementarity::Start::cold, complementarity::Start::nested}) {
    params.newton.start = start;
    const Solved alone = solve(by(params, ways[4]), core::Comm(MPI_COMM_SELF));
    ASSERT_TRUE(alone.outcome.solved) << alone.outcome.finest.why;
    const double norm = alone.outcome.energy_norm;
    ASSERT_GT(norm, 0);
    for (const Way& way : ways) {
      const Solved together = solve(by(params, way));
      EXPECT_TRUE(together.outcome.solved) << way.name << ": " << together.outcome.finest.why;
      EXPECT_NEAR(together.outcome.energy_norm, norm, 1e-8 * norm) << way.name;
      EXPECT_EQ(together.outcome.at.newton_iterations, alone.outcome.at.newton_iterations) << way.name;
      EXPECT_EQ(together.outcome.finest.active, alone.outcome.finest.active) << way.name;
      EXPECT_LE(together.outcome.kkt->worst(), 1e-8) << way.name;
    }
    if (start == complementarity::Start::cold) continue;
    auto fischer_burmeister = params;
    fischer_burmeister.newton.c_function = complementarity::CFunction::fischer_burmeister;
    for (const Way& way : {ways[0], ways[3], ways[4]}) {
      const Solved run = solve(by(fischer_burmeister, way));
      EXPECT_TRUE(run.outcome.solved) << "Fischer-Burmeister, " << way.name << ": " << run.outcome.finest.why;
      EXPECT_NEAR(run.outcome.energy_norm, norm, 1e-8 * norm) << "Fischer-Burmeister, " << way.name;
    }
  }
}

}  // namespace

TEST(Agreement, of_all_ways_on_smooth_contact) { expect_agreement(catalogued("smooth contact", 2)); }
TEST(Agreement, of_all_ways_on_the_discontinuous_multiplier) { expect_agreement(catalogued("discontinuous multiplier", 2)); }
TEST(Agreement, of_all_ways_with_two_different_tensions) { expect_agreement(pressed("1", "3", 2)); }
TEST(Agreement, of_all_ways_with_varying_tensions) { expect_agreement(pressed("1 + x", "2 - sin(pi*y)", 2)); }

/// The known solution is not the same thing as an agreed one: contact must be there, and not everywhere.
TEST(Agreement, is_about_problems_with_contact_in_a_part_of_the_domain) {
  for (const auto& params : {pressed("1", "3", 2), pressed("1 + x", "2 - sin(pi*y)", 2)}) {
    const Solved run = solve(params);
    const auto points = run.outcome.discretization->sizes().unknowns_all / 3;
    EXPECT_GT(run.outcome.finest.active, points / 20);
    EXPECT_LT(run.outcome.finest.active, points * 9 / 10);
  }
}

}  // namespace thixis::verification
