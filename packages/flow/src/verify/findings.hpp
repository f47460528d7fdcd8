#pragma once
#include <array>
#include <string>
#include <vector>

#include "thixis/core/types.hpp"

namespace thixis::flow {

/// What a verifier finds out about the end of a step, from the states at its two ends alone. Maxima and sums over all ranks; what is not
/// finite counts as infinitely wrong. [0]: water, [1]: hydrogen.
struct FlowFindings {
  /// A worst cell, by its global id; -1: nothing is wrong anywhere.
  struct Worst {
    double violation = 0;
    GlobalIndex cell = -1;
    std::array<double, 2> centre = {0, 0};
  };

  int dimension = 2;

  /// Defect of the balance of a cell beyond rounding, in shares of what counts: of what the step moves in the liveliest cell, at most a
  /// filled cell.
  std::array<Worst, 2> unbalanced;
  Worst negative_gas;        ///< -s_g, in shares of the largest s_g, at least 0.01
  Worst supersaturated;      ///< -G/(H P_ref)
  Worst both_open;           ///< min(|s_g|, |G|), in these shares
  Worst negative_dissolved;  ///< -chi beta_l/(H P_ref)
  Worst negative_pressure;   ///< -P_g/P_ref, of the gas, also where there is none
  Worst all_dissolved;       ///< chi - 1
  Worst dry;                 ///< s_g beyond what S_lr leaves, but for a hundredth
  Worst not_finite;

  /// Of a component over the whole domain [kg].
  struct Account {
    double defect = 0;    ///< of the step: what the masses in place have changed by and nothing has brought
    double brought = 0;   ///< what has come in, by sources and through the boundary
    double drawn = 0;     ///< what given sources and fluxes have taken away
    double in_place = 0;  ///< at the end
  };
  std::array<Account, 2> accounts;

  /// Undersaturation G/(H P_ref) of the owned cells.
  std::vector<double> undersaturation;

  /// Whether a balance is open by more than what counts: Newton's method has gone astray, where its tolerance, relative to X, means
  /// nothing.
  bool diverged() const;
  /// The worst of what balances and contact conditions miss in a cell.
  double worst() const;
  /// Why this is no solution, in a sentence that says where, and what to write; empty: it is one. `tolerance`: relative; without
  /// `conditions` only what no state of rock and fluids can be counts.
  std::string objection(double tolerance, bool conditions) const;
};

}  // namespace thixis::flow
