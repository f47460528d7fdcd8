#include "thixis/complementarity/parameters.hpp"

namespace thixis::complementarity {

const core::Schema<NewtonParams>& NewtonParams::schema() {
  static const auto s =
      core::Schema<NewtonParams>("newton", "How the nonlinear system is solved.")
          .choice("c-function", &NewtonParams::c_function, {{"min", CFunction::min}, {"fischer-burmeister", CFunction::fischer_burmeister}},
                  "Function of gap and multiplier whose zeros are the contact conditions.")
          .parameter("max iterations", &NewtonParams::max_iterations, core::at_least(0),
                     "Newton steps after which the run ends without convergence; 0 solves nothing and only counts unknowns.")
          .choice("start", &NewtonParams::start, {{"cold", Start::cold}, {"nested", Start::nested}},
                  "Begin with the functions of 'initial', or with the solution on the next coarser mesh.")
          .choice("globalization", &NewtonParams::globalization,
                  {{"none", Globalization::none}, {"line search", Globalization::line_search}, {"hybrid", Globalization::hybrid}},
                  "Full steps with a damped fallback at a cycle; damped steps from the start; full steps with the fallback also at growing "
                  "residuals.")
          .choice("ties", &NewtonParams::ties, {{"contact", Ties::contact}, {"free", Ties::free}},
                  "What becomes of points where gap and scaled multiplier are equal.")
          .parameter("tie tolerance", &NewtonParams::tie_tolerance, core::between(0, 1e-3),
                     "Gap and scaled multiplier count as equal up to this part of the largest way of what may touch, or of the largest "
                     "scaled multiplier: where a basis function has no mean, both vanish up to round-off.")
          .choice("scaling", &NewtonParams::scaling, {{"none", Scaling::none}, {"physical", Scaling::physical}},
                  "Compare the gap with the multiplier itself, or with the multiplier scaled to a length.")
          .parameter("sweeps", &NewtonParams::sweeps, core::between(0, 10000),
                     "Sweeps of nonlinear smoothing after each undamped step of c-function min, for symmetric methods; if not given, 10 "
                     "with nested "
                     "starts, otherwise none, which is plain Newton-min.");
  return s;
}

const core::Schema<StoppingParams>& StoppingParams::schema() {
  using Params = StoppingParams;
  static const auto s =
      core::Schema<Params>("stopping", "When the linear and the nonlinear solver stop.")
          .choice("rule", &Params::rule,
                  {{"exact", StoppingRule::exact}, {"inexact", StoppingRule::inexact}, {"adaptive", StoppingRule::adaptive}},
                  "Both solvers to their tolerances, the linear one in proportion to the nonlinear residual, or by the parts of the error "
                  "estimate.")
          .parameter("linear tolerance", &Params::linear_tolerance, core::strictly_between(0, 1),
                     "Linear residual, relative to the right-hand side of the Newton system.")
          .parameter("nonlinear tolerance", &Params::nonlinear_tolerance, core::strictly_between(0, 1),
                     "Nonlinear residual, relative to the data of the problem.")
          .parameter("absolute tolerance", &Params::absolute_tolerance, core::at_least(0),
                     "Added to the bound of the nonlinear residual, in the units of the equations.")
          .parameter("kkt tolerance", &Params::kkt_tolerance, core::strictly_between(0, 1),
                     "Largest relative violation of the contact conditions that the verifier lets pass; if not given, 1e-6 or, where that "
                     "is more, "
                     "what the nonlinear tolerance allows at one point.")
          .parameter("gamma algebraic", &Params::gamma_algebraic, core::strictly_between(0, 1),
                     "Algebraic error, relative to the larger one of discretization and linearization error.")
          .parameter("gamma linearization", &Params::gamma_linearization, core::strictly_between(0, 1),
                     "Linearization error, relative to the discretization error.")
          .parameter("local", &Params::local,
                     "Whether the rule adaptive wants its two conditions in every cell, and not only in the sum over them.")
          .parameter("inexact factor", &Params::inexact_factor, core::strictly_between(0, 1),
                     "Relative linear residual, as a part of the relative nonlinear residual (rule inexact).")
          .parameter(
              "estimate", &Params::estimate,
              "Estimate the error after every Newton step and at every look into the linear solver; if not given, only where rule, target "
              "or adaptivity need it.")
          .parameter("target", &Params::target, core::above(0),
                     "The mesh is refined until the bound on the energy error is at most this; the verdict says what the bound promises.")
          .choice(
              "measure", &Params::measure, {{"residual", Measure::residual}, {"literature", Measure::literature}},
              "Two-phase flow: what the estimate measures, dual norms of the residuals without units, or the sum of the literature in SI "
              "units.")
          .parameter("time scale", &Params::time_scale, core::above(0),
                     "Two-phase flow: the time in units of which the estimate counts, in the unit of time of the deck; if not given, 2500 "
                     "years.")
          .parameter("friedrichs constant", &Params::friedrichs, core::above(0),
                     "C in |v| <= C |grad v| for the bounds in time and of the literature, a length; if not given, that of the box around "
                     "the domain, which serves where the whole boundary is held.");
  return s;
}

}  // namespace thixis::complementarity
