#pragma once
#include <array>

#include "laws/laws.hpp"
#include "thixis/models/evolution.hpp"
#include "verify/findings.hpp"

namespace thixis::flow {

/// Keeps account of the masses of water and hydrogen over the steps, from what the verifier finds: what the solver believes about its
/// residual plays no part.
class TwoPhaseBalance {
 public:
  /// The step ends.
  void add(const FlowFindings& found);
  /// Why the step may not end so: what it, or all steps with it, have lost of a component; empty: it may.
  std::string objection(const FlowFindings& found, double tolerance) const;

  /// Of water: relative to the water in place; of hydrogen: to all that has come in so far, or where nothing has, to what is in place.
  std::vector<models::Balance> balances() const;

  std::map<std::string, double> save() const;
  void restore(const output::StoredCheckpoint& stored);

 private:
  struct Account {
    double defect = 0;    ///< of the last step [kg]
    double worst = 0;     ///< relative defect of a step
    double total = 0;     ///< sum of the defects [kg]
    double brought = 0;   ///< by sources and through the boundary, what came in alone [kg]
    double drawn = 0;     ///< by given sources and fluxes [kg]
    double in_place = 0;  ///< at the end of the last step [kg]
  };
  static double reference(int component, const Account& account);
  static Account added(Account account, int component, const FlowFindings& found);

  std::array<Account, components> accounts_;
};

}  // namespace thixis::flow
