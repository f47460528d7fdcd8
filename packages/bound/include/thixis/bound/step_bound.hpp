#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "thixis/bound/guaranteed_bound.hpp"

namespace thixis::bound {

/// The bound on the error of backward Euler over time (docs/methods/parabolic_estimates.md), guaranteed where doubts() is empty (section 8
/// there), else up to quadrature of the data: u_h is affine in time between the iterates that were accepted, whatever they are, and
///
///     ∫_0^{t_N} |||u - u_h|||² dt + |(u - s)(t_N)|² <= |(u - s)(0)|² + sum_n eta_n²,
///
/// s a feasible pair, eta_n² what `operator()` bounds over the step ]t_{n-1}, t_n]: with fluxes in equilibrium with f(t_n) - ∂_t u_h and a
/// multiplier lambda^ >= 0,
///
///     eta_n² = ∫ (A(t)² + |||s - u_h|||² + 2 (lambda^, s_1 - s_2)) dt.
///
/// What the mesh needs is set up once; data that do not depend on time are looked at once.
class StepBound {
 public:
  /// The space and the hierarchy must outlive it. `friedrichs`: C in |v| <= C |grad v| for v that vanish where the membranes are held; not
  /// given: that of the box around the mesh, where the whole boundary is held, else none, and what the step does not balance enters by its
  /// norm in L1(L2), as does always what no flux takes away from a piece that nothing holds. Collective; throws InputError for methods
  /// without such a bound and for tractions or tensions that depend on time.
  StepBound(const method::Space& space, const ContactProblem& problem, const mesh::Hierarchy& hierarchy, int level,
            std::optional<double> friedrichs = {});
  ~StepBound();
  StepBound(const StepBound&) = delete;
  StepBound& operator=(const StepBound&) = delete;

  /// The bound so far is that at time 0: |u_alpha(0) - s_alpha(0)| with the initial values u_alpha(0) at `time` (null: u itself).
  /// Collective.
  void start(double time, const method::Coefficients (&u)[2], const std::array<scene::FieldPtr, 2>& initial);
  /// A step, from the iterate that was accepted at its begin: any number of evaluations follow. Collective.
  void begin(double begin, double end, const method::Coefficients (&before)[2]);

  /// eta_n and its parts at an iterate at the end of the step. Its residual is that of the step, F(t_n) - (u - u_before)/tau - (-1)^alpha D
  /// lambda - S u_alpha. Collective.
  complementarity::Estimate operator()(const Iterate& iterate);
  /// Whether the change of the forces in the step begun is as smooth as its integral needs (ForceChange).
  bool resolved() const;
  /// What keeps the bound from being guaranteed, a clause each; behind a restart nothing of the error at time 0.
  std::vector<std::string> doubts() const;
  /// Of the last iterate, on the owned cells.
  const GuaranteedBound::CellParts& cells() const;
  /// Of the last iterate, with exact solvers: what comes from replacing the solution in the step by its value at the end, and the rest.
  struct Errors {
    double time = 0, space = 0;
  };
  Errors errors();  ///< collective

  /// The last iterate ends the step: the bound so far takes it in.
  void accept();
  /// Before the first step on a finer mesh, at the time of its begin: `coarse` is the bound on the mesh before. The function is the same on
  /// both but for its boundary values; s jumps by no more than it is away from it. Collective.
  void take_over(const StepBound& coarse, double time, const method::Coefficients (&coarse_u)[2], const method::Coefficients (&u)[2]);
  /// Over all steps accepted since `start`: total <= discretization + linearization + algebraic; the error at time 0 is part of
  /// discretization.
  complementarity::Estimate so_far() const;
  /// The sums that so_far is made of, for checkpoints; all else follows from the iterate at the begin of a step.
  std::map<std::string, double> sums() const;
  void restore(const std::map<std::string, double>& sums);  ///< all of names_of_sums()
  static const std::vector<std::string>& names_of_sums();

  /// The fluxes of the last iterate, for tests; `density`: of f - ∂_t s_N - (-1)^alpha lambda, s_N the feasible pair at the nodes.
  GuaranteedBound::Fluxes fluxes(int alpha) const;
  int flux_degree() const;  ///< q
  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::bound
