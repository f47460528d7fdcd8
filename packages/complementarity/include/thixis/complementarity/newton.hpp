#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "thixis/complementarity/active_set.hpp"
#include "thixis/complementarity/estimate.hpp"
#include "thixis/complementarity/parameters.hpp"
#include "thixis/complementarity/problem.hpp"

namespace thixis::complementarity {

/// One Newton step, at the new iterate X^k.
struct NewtonRecord {
  int step = 0;                         ///< k = 1, 2, ...
  int linear_iterations = 0;            ///< of this step
  long long active = 0;                 ///< contact points
  long long changed = 0;                ///< points whose state differs from the one at X^{k-1}
  double residual = 0;                  ///< |(E(X) - F, C(X))|, in the norm of the problem as the next two
  double residual_equations = 0;        ///< |E(X) - F|
  double residual_complementarity = 0;  ///< |C(X)|, C = Fischer–Burmeister in damped steps
  double step_length = 1;               ///< below 1 only in damped steps
  double seconds = 0;                   ///< wall clock of the step
  std::optional<Estimate> estimate;     ///< where it was computed
};

/// One look into the linear solver.
struct LinearRecord {
  int step = 0;                      ///< Newton step k that is being computed
  int iteration = 0;                 ///< i
  double residual = 0;               ///< |B - A X^{k,i}|
  std::optional<Estimate> estimate;  ///< at X^{k,i}, where it was computed
};

/// Who wants to know; each function may be empty. Called on all ranks with equal values.
struct NewtonObserver {
  std::function<void(const NewtonRecord&)> step;
  std::function<void(const LinearRecord&)> linear;
  std::function<void(const std::string&)> message;        ///< a sentence for the log: fallbacks, failed linear solves
  std::function<void(const algebra::Vector& X)> iterate;  ///< X^k, after `step`
};

struct NewtonReport {
  int steps = 0;  ///< linear systems solved and used
  bool converged = false;
  bool settled = true;  ///< false: Newton-min met the residual test with a contact set that still changed, and a residual that says so
  std::string why;      ///< one sentence: why it ended
  std::string advice;   ///< not converged: one sentence, what to try
  int linear_iterations = 0;                                    ///< total
  std::vector<double> residuals;                                ///< |(E(X^k) - F, C(X^k))|, k = 0 ... steps
  double residual_equations = 0, residual_complementarity = 0;  ///< the parts of the last one
  long long active = 0;                                         ///< contact points at the last iterate
  ActiveSet active_set;                                         ///< at the last iterate
  int fallbacks = 0;                                            ///< changes from full to damped steps
  std::optional<Estimate> estimate;                             ///< at the last iterate, if that is what the estimator has seen last
};

/// Semismooth Newton (NOX, line-search based): from X, solves A^{k-1} (X^k - X^{k-1}) = -R(X^{k-1}), R = (E(X) - F, C(K(X), s G(X))), and
/// leaves the last iterate in X, converged or not.
///
/// **It has converged** as soon as
/// - |R(X^k)| <= eps_lin |(F, 0)| + absolute tolerance + Problem::noise, for k = 0, 1, ... (where (F, 0) = 0: eps_lin |R(X^0)|), in the
///   norm of the problem, which makes its rows comparable (Problem::weights); in full steps of Newton-min
///   only once what still changes in the contact set is within the residual of the linear solver, or after five such iterates, or
/// - Newton-min, full step: the contact set at X^k is the one that step k was computed with, the linear solver met its tolerance, and
///   |R(X^k)| is no more (at most twice as much, for round-off) than it left behind. With linear E, K, G the last condition holds by
///   itself: X^k solves the linear system of its own contact set. With nonlinear E it says that nothing is left to linearize.
///
/// **The linear solver** is stopped at |R_alg| <= eps_alg |B| (Problem::rhs_norm), but never asked for less than a tenth of the absolute
/// tolerance and of the round-off, nor for more than 14 digits; below the round-off at X^k, what stagnates is solved. Rule `inexact` stops
/// it earlier, asked every `check_every` iterations: at |R_alg|/|B| <= alpha |R(X^{k,i})|/|(F, 0)|. If it fails once but at least halves
/// the linear residual, the step is taken and the next system is the second try; two failures in a row or a worse one end the run.
///
/// **The rule `adaptive`** (docs/methods/estimates.md) stops the linear solver, asked every `check_every` iterations (seldomer where the
/// residual shows that it is still far away, unless `stopping/estimate` wants to see every look), and the Newton loop
/// at
///
///     eta_alg <= gamma_alg max(eta_disc, eta_lin),        and, for Newton, also        eta_lin <= gamma_lin eta_disc;
///
/// with `local` at worst_algebraic <= gamma_alg, worst_linearization <= gamma_lin. A linear solver that cannot get there ends at its
/// tolerance, and a run that meets one of the two conditions above has converged, too. Since eta_lin is not monotone, one iterate where it
/// is small is no evidence: the criterion must have held at the iterate before as well, or the last step must have left the contact set as
/// it was. That costs at most one step more than the criterion alone, a cheap one: it starts from an iterate that is good enough. Where an
/// estimate is `evident`, it is enough once.
/// Where Newton does not get ahead (eta_lin has not fallen to 0.8 of its value five steps before, or Newton-min has the contact set it had,
/// and eta_lin is not small) gamma_alg is a tenth for the linear systems that follow, and again a tenth, until eta_lin falls.
///
/// **The estimator** is called under `adaptive` and, with `estimate` = true, under every rule: at each look into the linear solver and at
/// each X^k, there only if the last look saw another iterate. Nobody else calls it. Its time goes to the region "estimate". The rule
/// `adaptive` without an estimator is an InputError.
///
/// **Smoothing.** With `sweeps` > 0 Problem::relax corrects X^k after each undamped Newton-min step; |R| and the contact set are those of
/// the corrected iterate, so that both conditions above keep their meaning. Not after a step that begins with the contact set of the step
/// before, whose linear system was solved: the set is found, and what is left is rounding.
///
/// **Globalization.** Undamped steps use `c_function` and are never judged by |R|: it grows by orders of magnitude in a good Newton-min
/// run. Damped steps use Fischer–Burmeister and Armijo backtracking on its merit function ½|R|². They last until |R| has fallen to a tenth
/// (in each further fallback: to the square of the factor before), then the undamped steps go on.
/// - `none`: undamped, but when Newton-min cycles, damped. A cycle is a contact set seen before, with another one in between, at the same
///   |R| (up to 0.1 %), all linear systems since then solved to their tolerance: for linear E, K, G and without smoothing a proof that
///   Newton-min does not end.
/// - `line search`: damped steps first; Fischer–Burmeister stays damped to the end.
/// - `hybrid`: as `none`; damped steps also, from the iterate where the undamped ones began, when |R| is not finite, or for ten successive
///   steps has been above its value ten steps before.
///
/// Undamped steps that lead to |R| > 1e20 max(|R^0|, |(F, 0)|) diverge: the run ends, not converged, or goes on damped (`hybrid`).
///
/// max iterations = 0 evaluates nothing and returns not converged. NaN in the problem's answers ends the run, not converged.
NewtonReport newton(Problem& problem, algebra::Vector& X, const NewtonParams& newton, const StoppingParams& stopping, int check_every,
                    const NewtonObserver& observer = {}, const Estimator& estimator = {});

}  // namespace thixis::complementarity
