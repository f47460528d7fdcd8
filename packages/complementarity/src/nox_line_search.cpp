#include "nox_line_search.hpp"

#include <NOX_Abstract_Group.H>
#include <NOX_Solver_Generic.H>
#include <fmt/format.h>

#include "system.hpp"

namespace thixis::complementarity {

bool Armijo::compute(NOX::Abstract::Group& group, double& step, const NOX::Abstract::Vector& direction,
                     const NOX::Solver::Generic& solver) {
  constexpr double sigma = 1e-4, shortest = 1e-8;
  const NOX::Abstract::Group& start = solver.getPreviousSolutionGroup();
  const double before = start.getNormF();
  for (step = 1; step >= shortest; step /= 2) {
    group.computeX(start, direction, step);
    group.computeF();
    const double after = group.getNormF();
    if (after * after <= (1 - 2 * sigma * step) * before * before) return true;
  }
  group = start;
  throw StepFailed{fmt::format("no step length lowers the Fischer-Burmeister residual {:.2e}", before)};
}

}  // namespace thixis::complementarity
