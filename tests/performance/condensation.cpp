/// What static condensation saves: the same nested HHO solve on the faces alone and with all unknowns, one after the other.
///
///     bench_condensation [degree] [level]        default: P3 on T_4
#include <fmt/format.h>

#include <Tpetra_Core.hpp>
#include <cstdlib>

#include "problems.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::verification {
namespace {

struct Way {
  const char* name;
  bool condensed;
  algebra::SystemForm form;
  algebra::SolverKind solver;
  algebra::PreconditionerKind preconditioner;
};

void measure(const Way& way, int degree, int level) {
  if (!is_built("hho")) return fmt::print("{:34} is not built\n", "hho");
  auto params = catalogued("smooth contact", level);
  params.method = by("hho", degree);
  params.method.condensation = way.condensed;
  params.linear.form = way.form;
  params.linear.solver = way.solver;
  params.linear.preconditioner = way.preconditioner;
  core::reset_regions();
  const core::Stopwatch clock;
  const Solved run = solve(params);
  const double total = clock.seconds();
  const double solve = core::seconds("preconditioner") + core::seconds("linear");
  fmt::print("{:34} {:10} {:10} {:8} {:8} {:10.2f} {:10.2f} {:10.2f} {:10.2f}{}\n", way.name,
             run.outcome.discretization->sizes().unknowns_global, run.outcome.discretization->sizes().nonzeros,
             run.outcome.at.newton_iterations, run.outcome.at.linear_iterations, core::seconds("preconditioner"), core::seconds("linear"),
             solve, total, run.outcome.solved ? "" : "   not solved");
}

}  // namespace
}  // namespace thixis::verification

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  using namespace thixis;
  using algebra::PreconditionerKind;
  using algebra::SolverKind;
  using algebra::SystemForm;
  const int degree = argc > 1 ? std::atoi(argv[1]) : 3, level = argc > 2 ? std::atoi(argv[2]) : 4;
  fmt::print("HHO P{} on T_{}, smooth contact, nested; seconds\n", degree, level);
  fmt::print("{:34} {:>10} {:>10} {:>8} {:>8} {:>10} {:>10} {:>10} {:>10}\n", "", "rows", "nonzeros", "Newton", "Krylov", "precond.",
             "Krylov", "solve", "total");
  const verification::Way ways[] = {
      {"condensed, CG + ILU(0)", true, SystemForm::reduced, SolverKind::cg, PreconditionerKind::ilu},
      {"uncondensed, reduced, CG + ILU(0)", false, SystemForm::reduced, SolverKind::cg, PreconditionerKind::ilu},
      {"condensed, GMRES + ILU(0)", true, SystemForm::reduced, SolverKind::gmres, PreconditionerKind::ilu},
      {"uncondensed, reduced, GMRES + ILU(0)", false, SystemForm::reduced, SolverKind::gmres, PreconditionerKind::ilu},
      {"uncondensed, full, GMRES + ILU(0)", false, SystemForm::full, SolverKind::gmres, PreconditionerKind::ilu},
      {"condensed, direct", true, SystemForm::reduced, SolverKind::direct, PreconditionerKind::none},
      {"uncondensed, reduced, direct", false, SystemForm::reduced, SolverKind::direct, PreconditionerKind::none}};
  for (const auto& way : ways) verification::measure(way, degree, level);
  return 0;
}
