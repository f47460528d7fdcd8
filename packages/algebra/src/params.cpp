#include "thixis/algebra/solver.hpp"

namespace thixis::algebra {

const core::Schema<LinearParams>& LinearParams::schema() {
  using P = LinearParams;
  static const auto schema =
      core::Schema<P>("linear", "How the linear system of a Newton step is solved.")
          .choice("solver", &P::solver, {{"gmres", SolverKind::gmres}, {"cg", SolverKind::cg}, {"direct", SolverKind::direct}},
                  "Krylov method, or a direct solver (LU on one rank); cg needs a symmetric positive definite system: form 'reduced'.")
          .choice("form", &P::form, {{"full", SystemForm::full}, {"reduced", SystemForm::reduced}},
                  "Solve for all unknowns and the multiplier together, or for what is left after the contact conditions are eliminated.")
          .choice("preconditioner", &P::preconditioner,
                  {{"none", PreconditionerKind::none},
                   {"ilu", PreconditionerKind::ilu},
                   {"ilut", PreconditionerKind::ilut},
                   {"multigrid", PreconditionerKind::multigrid},
                   {"muelu", PreconditionerKind::muelu}},
                  "Incomplete LU by level or by fill, multigrid on the levels of the mesh, or by aggregation (MueLu), both for the form "
                  "'reduced'; "
                  "a direct solver has none.")
          .parameter("ilu level", &P::ilu_level, core::between(0, 10), "Level of fill of 'ilu': 0 keeps the pattern of the matrix.")
          .parameter("overlap", &P::overlap, core::between(0, 10),
                     "Layers of rows that neighbouring ranks share in 'ilu' and 'ilut'; without effect on one rank.")
          .parameter("ilut fill", &P::ilut_fill, core::between(1, 100),
                     "Entries per row that 'ilut' keeps, as a multiple of those of the matrix.")
          .parameter("restart", &P::restart, core::between(1, 10000), "Dimension of the Krylov space at which gmres starts anew.")
          .parameter("max iterations", &P::max_iterations, core::at_least(1), "Krylov iterations after which a solve gives up.")
          .parameter("check every", &P::check_every, core::at_least(1),
                     "Krylov iterations between two looks at the iterate, where the stopping rule asks for the error estimate.")
          .check([](const P& p, core::Problems& problems) {
            if (p.solver == SolverKind::cg && p.preconditioner == PreconditionerKind::ilut)
              problems.add("preconditioner",
                           "cg needs a symmetric preconditioner: write 'multigrid', 'muelu' or 'ilu', or the solver 'gmres'.");
          });
  return schema;
}

}  // namespace thixis::algebra
