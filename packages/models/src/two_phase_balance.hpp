#pragma once
#include <array>

#include "thixis/models/evolution.hpp"
#include "two_phase_operator.hpp"

namespace thixis::models {

/// Keeps account of the masses of water and hydrogen over the steps, from masses in the cells, sources and flows through the boundary
/// alone: what the solver believes about its residual plays no part.
class TwoPhaseBalance {
 public:
  explicit TwoPhaseBalance(const TwoPhaseOperator& flow) : flow_(flow) {}

  /// The step ends with X: its defect is what the masses in place have changed by and nothing has brought. Collective.
  void add(const FlowStep& step, const algebra::Vector& X);

  /// Of water: relative to the water in place; of hydrogen: to all that has come in so far, or where nothing has, to what is in place.
  std::vector<Balance> balances() const;

  std::map<std::string, double> save() const;
  void restore(const output::StoredCheckpoint& stored);

 private:
  struct Account {
    double defect = 0;    ///< of the last step [kg]
    double worst = 0;     ///< relative defect of a step
    double total = 0;     ///< sum of the defects [kg]
    double brought = 0;   ///< by sources and through the boundary, what came in alone [kg]
    double in_place = 0;  ///< at the end of the last step [kg]
  };
  double reference(int component) const;

  const TwoPhaseOperator& flow_;
  std::array<Account, components> accounts_;
};

}  // namespace thixis::models
