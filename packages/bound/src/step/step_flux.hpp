#pragma once
#include "step/step_begin.hpp"

namespace thixis::bound {

/// The fluxes in a step, in equilibrium with f(t_n) - ∂_t s_N and lambda^, s_N the feasible pair at the nodes.
class StepFlux {
 public:
  explicit StepFlux(const BoundParts& parts);

  /// The fluxes of a membrane from an iterate at the end, whose pair goes this `way`; their norms in the middle of the step, and
  /// |mu^{1/2} grad (u_h - u_before)|_K. `cut_off`: R_lin. Collective.
  void operator()(BoundParts& parts, const StepBegin& before, const Iterate& iterate, const FeasiblePair::Way& way, int alpha,
                  const algebra::Vector& cut_off);
  /// Of a membrane, with all that a step has.
  FluxTerms terms(const BoundParts& parts, int alpha) const;

  /// The last iterate's: norms of means that no flux takes away.
  double left(int alpha) const { return of_[alpha].left; }
  /// (owned cell, dim P_q): densities of f - ∂_t s_N - (-1)^alpha lambda, and of what the linearization takes of it.
  CellTable balanced(const BoundParts& parts, const StepBegin& before, const FeasiblePair::Way& way, int alpha) const;
  CellTable lifted(const BoundParts& parts, const StepBegin& before, const FeasiblePair::Way& way, int alpha) const;
  const CellTable& scratch() const { return remaining_; }  ///< (owned cell, dim P_p)
  std::size_t bytes() const;

 private:
  struct Membrane {
    CellTable rate;
    View<double*> change;
    View<double*> of_rate;  ///< |(1 - Pi_q) ∂_t s_N|_K; of length 0 in conforming spaces, whose fluxes are of degree p
    double left = 0;
  };
  void lift_residuals(BoundParts& parts, double tau, const Iterate& iterate, const FeasiblePair::Way& way, int alpha,
                      const algebra::Vector& cut_off);
  void add_moved(const BoundParts& parts, const StepBegin& before, const FeasiblePair::Way& way, int alpha);

  Matrix modal_;  ///< (m, l): modal coefficients of the basis functions
  CellTable remaining_, extra_;
  Membrane of_[2];
};

}  // namespace thixis::bound
