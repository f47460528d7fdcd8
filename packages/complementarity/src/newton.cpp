#include "thixis/complementarity/newton.hpp"

#include <NOX_Solver_LineSearchBased.H>
#include <NOX_StatusTest_Combo.H>
#include <NOX_StatusTest_FiniteValue.H>
#include <NOX_StatusTest_MaxIters.H>
#include <fmt/format.h>

#include <Teuchos_ParameterList.hpp>
#include <Teuchos_oblackholestream.hpp>
#include <chrono>
#include <cmath>

#include "nox_group.hpp"
#include "nox_line_search.hpp"
#include "nox_status.hpp"
#include "system.hpp"

namespace thixis::complementarity {
namespace {

enum class Steps { full, damped };

/// Why a sequence of steps of one kind ended.
enum class Ending { converged, estimated, cycle, growing, diverged, fallen, not_finite, too_many, failed };

Teuchos::RCP<Teuchos::ParameterList> nox_parameters(Steps steps) {
  const auto list = Teuchos::rcp(new Teuchos::ParameterList);
  const Teuchos::RCP<std::ostream> nowhere = Teuchos::rcp(new Teuchos::oblackholestream);
  list->set("Nonlinear Solver", "Line Search Based");
  list->sublist("Printing").set("Output Information", 0);
  list->sublist("Printing").set("Output Stream", nowhere);
  list->sublist("Printing").set("Error Stream", nowhere);
  list->sublist("Direction").set("Method", "Newton");
  Teuchos::ParameterList& search = list->sublist("Line Search");
  if (steps == Steps::full) {
    search.set("Method", "Full Step");
  } else {
    const Teuchos::RCP<NOX::LineSearch::UserDefinedFactory> armijo = Teuchos::rcp(new Armijo::Factory);
    search.set("Method", "User Defined");
    search.set("User Defined Line Search Factory", armijo);
  }
  return list;
}

/// The status tests of one sequence of steps, asked in this order.
struct Tests {
  Teuchos::RCP<NOX::StatusTest::FiniteValue> finite = Teuchos::rcp(new NOX::StatusTest::FiniteValue);
  Teuchos::RCP<SmallResidual> small;
  Teuchos::RCP<SettledContactSet> settled;  ///< null where it does not apply, as the ones below
  Teuchos::RCP<SmallEstimate> estimated;
  Teuchos::RCP<Cycle> cycle;
  Teuchos::RCP<Growing> growing;
  Teuchos::RCP<Diverged> diverged;
  Teuchos::RCP<Fallen> fallen;
  Teuchos::RCP<NOX::StatusTest::MaxIters> most;
  Teuchos::RCP<NOX::StatusTest::Combo> all = Teuchos::rcp(new NOX::StatusTest::Combo(NOX::StatusTest::Combo::OR));

  Tests(System& system, Steps steps, const NewtonParams& params, double fall, int most_steps) {
    const bool full_min = steps == Steps::full && params.c_function == CFunction::min;
    const bool damped_to_the_end = params.c_function != CFunction::min && params.globalization == Globalization::line_search;
    all->addStatusTest(finite);
    add(small, new SmallResidual(system, full_min));
    if (full_min) add(settled, new SettledContactSet(system));
    if (system.stopping().rule == StoppingRule::adaptive) add(estimated, new SmallEstimate(system));
    if (full_min) add(cycle, new Cycle(system));
    if (steps == Steps::full && params.globalization == Globalization::hybrid) add(growing, new Growing);
    if (steps == Steps::full) add(diverged, new Diverged(system));
    if (steps == Steps::damped && !damped_to_the_end) add(fallen, new Fallen(fall));
    add(most, new NOX::StatusTest::MaxIters(most_steps));
  }

  Ending ending() const {
    if (small->answered() || (!settled.is_null() && settled->answered())) return Ending::converged;
    if (!estimated.is_null() && estimated->answered()) return Ending::estimated;
    if (finite->getStatus() == NOX::StatusTest::Failed) return Ending::not_finite;
    if (!cycle.is_null() && cycle->answered()) return Ending::cycle;
    if (!growing.is_null() && growing->answered()) return Ending::growing;
    if (!diverged.is_null() && diverged->answered()) return Ending::diverged;
    if (!fallen.is_null() && fallen->answered()) return Ending::fallen;
    return Ending::too_many;
  }

 private:
  template <class T>
  void add(Teuchos::RCP<T>& test, T* made) {
    test = Teuchos::rcp(made);
    all->addStatusTest(test);
  }
};

/// A run of `newton`: sequences of full or damped steps, one after the other, from the X of the caller.
class Run {
 public:
  Run(Problem& problem, algebra::Vector& X, const NewtonParams& params, const StoppingParams& stopping, int check_every,
      const NewtonObserver& observer, const Estimator& estimator)
      : params_(params), observer_(observer), system_(problem, params, stopping, check_every, observer, estimator), X_(X) {}

  NewtonReport solve() {
    Steps steps = params_.globalization == Globalization::line_search ? Steps::damped : Steps::full;
    for (;;) {
      const Ending ending = take(steps);
      if (!goes_on_) return conclude(ending);
      steps = steps == Steps::full ? Steps::damped : Steps::full;
      announce(ending);
    }
  }

 private:
  /// Steps of one kind until a test stops them; the last iterate goes to X unless the damped steps begin before it.
  Ending take(Steps steps) {
    system_.use(steps == Steps::damped ? CFunction::fischer_burmeister : params_.c_function);
    const auto group = Teuchos::rcp(new NoxGroup(system_, X_));
    const Tests tests(system_, steps, params_, fall_, params_.max_iterations - report_.steps);
    NOX::Solver::LineSearchBased solver(group, tests.all, nox_parameters(steps));
    Ending ending = Ending::failed;
    try {
      while (step(solver) == NOX::StatusTest::Unconverged) {
      }
      ending = tests.ending();
    } catch (const StepFailed& failure) {
      why_ = failure.why;
      report_.estimate.reset();  // the estimator has seen iterates that are given up
    }
    grown_by_ = tests.diverged.is_null() ? 0 : tests.diverged->factor();
    period_ = tests.cycle.is_null() ? 0 : tests.cycle->period();
    goes_on_ = report_.steps < params_.max_iterations &&
               (steps == Steps::full ? falls_back(ending, solver.getNumIterations()) : ending == Ending::fallen);
    keep(solver, ending);
    return ending;
  }

  NOX::StatusTest::StatusType step(NOX::Solver::LineSearchBased& solver) {
    const int k = solver.getNumIterations(), iterations = system_.linear_iterations();
    const auto start = std::chrono::steady_clock::now();
    system_.begin_step(report_.steps + 1);
    const NOX::StatusTest::StatusType status = solver.step();

    const State& now = dynamic_cast<const NoxGroup&>(solver.getSolutionGroup()).state();
    if (solver.getNumIterations() == k) {
      if (report_.residuals.empty()) report_.residuals.push_back(now.residual);
      return status;
    }
    const State& before = dynamic_cast<const NoxGroup&>(solver.getPreviousSolutionGroup()).state();
    if (report_.residuals.empty()) report_.residuals.push_back(before.residual);
    report_.residuals.push_back(now.residual);
    ++report_.steps;
    changed_ = now.active.changed(before.active);
    const algebra::Vector& X = dynamic_cast<const NoxGroup&>(solver.getSolutionGroup()).X();
    report_.estimate.reset();
    if (std::isfinite(now.residual)) report_.estimate = system_.estimate(X);
    system_.end_step(changed_);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    if (observer_.step)
      observer_.step({report_.steps, system_.linear_iterations() - iterations, now.active.count(), changed_, now.residual, now.equations,
                      now.complementarity, solver.getStepSize(), elapsed.count(), report_.estimate});
    if (observer_.iterate) observer_.iterate(X);
    return status;
  }

  void keep(const NOX::Solver::LineSearchBased& solver, Ending ending) {
    const bool step_before = ending == Ending::not_finite && solver.getNumIterations() > 0;
    const auto& group = dynamic_cast<const NoxGroup&>(step_before ? solver.getPreviousSolutionGroup() : solver.getSolutionGroup());
    last_ = group.state();
    const bool back = goes_on_ && (ending == Ending::growing || ending == Ending::diverged || ending == Ending::not_finite);
    if (!back) Tpetra::deep_copy(X_, group.X());
  }

  bool falls_back(Ending ending, int steps_taken) const {
    if (ending == Ending::cycle) return true;
    if (params_.globalization != Globalization::hybrid) return false;
    return ending == Ending::growing || ending == Ending::diverged || (ending == Ending::not_finite && steps_taken > 0);
  }

  void announce(Ending ending) {
    if (ending == Ending::fallen) {
      system_.say(fmt::format("The residual has fallen to {:.2e} after step {}: full steps again.", last_.residual, report_.steps));
      fall_ *= fall_;
      return;
    }
    ++report_.fallbacks;
    const std::string why = ending == Ending::cycle      ? fmt::format("Newton-min cycles with period {}", period_)
                            : ending == Ending::growing  ? std::string("The residual keeps growing")
                            : ending == Ending::diverged ? std::string("The residual has grown without bound")
                                                         : std::string("The residual is not finite");
    system_.say(fmt::format("{} (step {}): damped Fischer-Burmeister steps until the residual has fallen to {:g} of what it is now.", why,
                            report_.steps, fall_));
  }

  NewtonReport conclude(Ending ending) {
    report_.converged = ending == Ending::converged || ending == Ending::estimated;
    if (report_.residuals.empty()) report_.residuals.push_back(last_.residual);
    report_.why = sentence(ending);
    if (!report_.converged) report_.advice = advice(ending);
    report_.linear_iterations = system_.linear_iterations();
    report_.residual_equations = last_.equations;
    report_.residual_complementarity = last_.complementarity;
    report_.active = last_.active.count();
    const bool still_changing = changed_ > 0 && last_.residual > 2 * system_.left();
    report_.settled = !(ending == Ending::converged && params_.c_function == CFunction::min && still_changing);
    report_.active_set = last_.active;
    return report_;
  }

  std::string sentence(Ending ending) const {
    const double bound = system_.nonlinear_bound(last_);
    switch (ending) {
      case Ending::converged:
        if (last_.residual <= bound) return fmt::format("The residual {:.2e} is below {:.2e}.", last_.residual, bound);
        return fmt::format("The contact set did not change in step {}: its linear system is solved, and with it the problem.",
                           report_.steps);
      case Ending::estimated:
        return fmt::format(
            "Step {}: the linearization error {:.2e} and the algebraic error {:.2e} do not count beside the discretization "
            "error {:.2e}.",
            report_.steps, report_.estimate->linearization, report_.estimate->algebraic, report_.estimate->discretization);
      case Ending::not_finite:
        if (report_.steps == 0) return "The residual at the start is not a finite number.";
        return fmt::format("Step {} gives a residual that is not a finite number; the iterate before it is kept.", report_.steps);
      case Ending::diverged:
        return fmt::format("Newton's method diverges: after step {} the residual is {:.2e}, {:.0e} times what it was or the data are.",
                           report_.steps, last_.residual, grown_by_);
      case Ending::failed:
        return fmt::format("Step {} was not possible: {}.", report_.steps + 1, why_);
      default:
        return fmt::format("No convergence in {} step{} (newton/max iterations): the residual is {:.2e}, not below {:.2e}.", report_.steps,
                           report_.steps == 1 ? "" : "s", last_.residual, bound);
    }
  }

  /// What a user can do about it.
  std::string advice(Ending ending) const {
    if (ending == Ending::failed && system_.failed())
      return "Try linear/solver = direct, another linear/preconditioner, more linear/max iterations, or a larger stopping/linear "
             "tolerance.";
    if (ending == Ending::failed) return "Try newton/c-function = min with newton/globalization = none, or newton/start = nested.";
    if (ending == Ending::not_finite || ending == Ending::diverged)
      return report_.steps == 0 ? "Look at the data and at newton/initial."
                                : "Try newton/globalization = hybrid, or newton/start = nested.";
    std::string steps = "Try more newton/max iterations";
    if (params_.globalization == Globalization::none) steps += ", newton/globalization = hybrid";
    if (params_.start == Start::cold) steps += ", newton/start = nested";
    return steps + ", or, where the linear systems are the reason, linear/solver = direct.";
  }

  const NewtonParams& params_;
  const NewtonObserver& observer_;
  System system_;
  algebra::Vector& X_;
  NewtonReport report_;
  State last_;
  std::string why_;
  long long changed_ = 0;  ///< contact points that the last step changed
  double fall_ = 0.1;
  int period_ = 0;
  double grown_by_ = 0;
  bool goes_on_ = false;
};

}  // namespace

NewtonReport newton(Problem& problem, algebra::Vector& X, const NewtonParams& params, const StoppingParams& stopping, int check_every,
                    const NewtonObserver& observer, const Estimator& estimator) {
  if (stopping.rule == StoppingRule::adaptive && !estimator)
    throw core::InputError("stopping/rule = adaptive needs an error estimate inside the solver; write exact or inexact here.");
  if (params.max_iterations == 0) {
    NewtonReport report;
    report.why = "Not solved: newton/max iterations is 0.";
    return report;
  }
  return Run(problem, X, params, stopping, check_every, observer, estimator).solve();
}

}  // namespace thixis::complementarity
