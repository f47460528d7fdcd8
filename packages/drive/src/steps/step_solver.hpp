#pragma once
#include "look/look.hpp"
#include "thixis/drive/evolve.hpp"

namespace thixis::drive {

/// Solves the steps of a run in time, one attempt after the other. Counts in `outcome` what it takes, and keeps what Newton said last.
class StepSolver {
 public:
  StepSolver(models::Evolution& evolution, const RunParams& params, const EvolutionObserver& observer, EvolutionOutcome& outcome)
      : evolution_(evolution), params_(params), observer_(observer), outcome_(outcome), look_(params.output) {}

  /// Newton from a prediction or, where there is none or it leads nowhere, from X, the state before, which becomes that at the end of the
  /// step; false if it fails. Collective.
  bool operator()(const models::TimeStep& step, algebra::Vector& X);
  /// The estimate of the step solved, where the error is estimated.
  const std::optional<complementarity::Estimate>& estimate() const { return eta_; }
  /// What there is to be told of it once it is accepted. `seconds`: wall clock with all attempts. Collective.
  StepRecord record(const models::TimeStep& step, double seconds) const;
  /// What to try where the step failed, in a sentence; empty where the model has said so.
  std::string advice() const;

  /// Tells that an attempt is given up for another one.
  void retry(const models::TimeStep& step, const std::string& why, double next);
  /// What the verifier lets pass at the state before the step.
  double kkt_tolerance(const complementarity::KktData& data);

 private:
  bool solve(const models::TimeStep& step, algebra::Vector& X);
  void iterate(const models::TimeStep& step, const complementarity::NewtonParams& newton, const complementarity::StoppingParams& stopping,
               algebra::Vector& X);
  bool tighten(const models::TimeStep& step, const complementarity::NewtonParams& newton, complementarity::StoppingParams& stopping,
               algebra::Vector& X);
  models::Objection objection_to(const algebra::Vector& X);
  bool refuse(const models::Objection& objection);
  complementarity::NewtonObserver on_step(double end);

  models::Evolution& evolution_;
  const RunParams& params_;
  const EvolutionObserver& observer_;
  EvolutionOutcome& outcome_;
  Look look_;
  bool refused_ = false;                          ///< the last attempt ended with an objection of the model
  std::optional<complementarity::Estimate> eta_;  ///< of the last attempt
};

}  // namespace thixis::drive
