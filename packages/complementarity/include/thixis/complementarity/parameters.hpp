#pragma once
#include <optional>

#include "thixis/complementarity/active_set.hpp"
#include "thixis/complementarity/c_function.hpp"
#include "thixis/core/schema.hpp"

namespace thixis::complementarity {

enum class Start { cold, nested };
enum class Globalization { none, line_search, hybrid };
enum class Scaling { none, physical };

/// Block `newton`. What the globalizations do is written at `newton()` in newton.hpp; `start` is read by the drivers.
struct NewtonParams {
  CFunction c_function = CFunction::min;
  int max_iterations = 200;
  Start start = Start::cold;
  Globalization globalization = Globalization::none;
  Ties ties = Ties::contact;
  double tie_tolerance = 1e-12;
  Scaling scaling = Scaling::physical;
  std::optional<int> sweeps;  ///< of nonlinear smoothing after a step; not given: 10 in nested runs of symmetric methods, otherwise none
  core::Extras own;           ///< what models have for themselves
  static const core::Schema<NewtonParams>& schema();
};

enum class StoppingRule { exact, inexact, adaptive };
/// Of two-phase flow (docs/methods/two_phase_estimates.md): dual norms of residuals without units, or the sum of the literature.
enum class Measure { residual, literature };

/// Block `stopping`; what the rules mean is written at `newton()` in newton.hpp.
struct StoppingParams {
  StoppingRule rule = StoppingRule::exact;
  double linear_tolerance = 1e-10;    ///< eps_alg
  double nonlinear_tolerance = 1e-9;  ///< eps_lin
  double absolute_tolerance = 0;      ///< of the nonlinear residual, in the units of the equations
  std::optional<double>
      kkt_tolerance;  ///< of the verifier, relative; not given: 1e-6, or what the nonlinear tolerance allows at one point (at most 1e-3)
  double gamma_algebraic = 0.3;
  double gamma_linearization = 0.3;
  bool local = false;            ///< rule adaptive: in every cell
  double inexact_factor = 0.3;   ///< alpha
  std::optional<bool> estimate;  ///< not given: only where rule, target or adaptivity need it
  std::optional<double> target;
  Measure measure = Measure::residual;  ///< two-phase flow
  std::optional<double> time_scale;     ///< alpha, two-phase flow, in the unit of time of the deck; not given: 2500 years
  std::optional<double>
      friedrichs;  ///< h_Omega C_PF of the bounds in time and of the literature; not given: that of the box around the domain
  /// The nonlinear residual that ends Newton's method: of the data's norm `reference`, and what rounding leaves.
  double nonlinear_residual(double reference, double rounding) const {
    return nonlinear_tolerance * reference + absolute_tolerance + rounding;
  }
  static const core::Schema<StoppingParams>& schema();
};

}  // namespace thixis::complementarity
