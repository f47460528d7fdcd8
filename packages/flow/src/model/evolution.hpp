#pragma once
#include <memory>
#include <string>
#include <vector>

#include "estimate/bound.hpp"
#include "estimate/bound_so_far.hpp"
#include "model/probes.hpp"
#include "problem/problem.hpp"
#include "thixis/flow/two_phase.hpp"
#include "verify/balance.hpp"
#include "verify/verifier.hpp"

namespace thixis::flow {

const std::vector<std::string>& names_of_fields();

/// Two-phase flow in time on its grid (docs/methods/two_phase.md).
class TwoPhaseEvolution final : public models::Evolution {
 public:
  TwoPhaseEvolution(fv::Grid grid, const TwoPhaseScene& scene, const algebra::LinearParams& linear, double seconds_per_unit,
                    const std::vector<models::Probe>& probes, const TwoPhaseBoundParams& bound);

  const core::Comm& comm() const override { return flow_.grid().comm; }
  GlobalIndex cells() const override { return flow_.grid().global_cells; }
  models::Sizes sizes() const override;
  complementarity::Problem& problem() override { return problem_; }
  std::vector<double> jumps() const override { return jumps_; }

  // evolution.cpp: from step to step
  Teuchos::RCP<algebra::Vector> initial() override;
  void check(const std::vector<double>& times) const override;
  void begin(const models::TimeStep& step, const algebra::Vector& before) override;
  double round_off() const override { return problem_.round_off(); }
  void give_up() override { of_step_.reset(); }
  bool predict(algebra::Vector& X) override;
  complementarity::Estimate estimate(const algebra::Vector& X) override;
  models::CellEstimates cell_estimates() const override;
  std::optional<models::StepErrors> step_errors() const override;
  models::Objection objection(const algebra::Vector& X, double tolerance, bool conditions) override;
  void accept(const algebra::Vector& X) override;
  complementarity::KktData kkt_data(const algebra::Vector& X) const override;

  // results.cpp: what is shown and judged
  std::optional<complementarity::Estimate> estimate_so_far() const override { return bound_so_far_.value(); }
  bool every_step_estimated() const override { return bound_so_far_.every_step(); }
  std::string bound_name() const override;
  std::vector<models::Balance> balances() const override { return balance_.balances(); }
  std::vector<models::Expectation> expectations(const models::ExpectParams& expect, const algebra::Vector& X) const override;
  std::vector<output::SummaryEntry> summary(const algebra::Vector& X) const override;
  std::vector<std::string> series_names() const override;
  std::vector<double> series(const algebra::Vector& X) const override;
  std::vector<double> values_at(const std::vector<models::Probe>& probes, const algebra::Vector& X) const override;
  output::Grid grid() const override;
  std::vector<output::FieldData> fields(const algebra::Vector& X, const complementarity::ActiveSet& active,
                                        const std::vector<std::string>& names) const override;

  // restart.cpp
  models::State save(const algebra::Vector& X) const override;
  Teuchos::RCP<algebra::Vector> restore(const output::StoredCheckpoint& stored) override;

 private:
  bool start(algebra::Vector& X) const;
  void require_definite_pressure() const;
  double front(const algebra::Vector& X) const;
  void add_blocks(const std::string& suffix, const algebra::Vector& X, std::vector<output::CheckpointBlock>& blocks) const;
  Teuchos::RCP<algebra::Vector> fetched(const std::string& suffix, const output::StoredCheckpoint& stored) const;
  void add_owed(std::vector<output::CheckpointBlock>& blocks) const;
  void fetch_owed(const output::StoredCheckpoint& stored) const;
  FlowFindings verified(const algebra::Vector& X) const;
  std::vector<TwoPhaseVerifier::State> of_cells(const algebra::Vector& X) const;
  std::vector<GlobalIndex> owned_ids() const;

  TwoPhaseBoundParams bound_params_;
  TwoPhaseOperator flow_;
  Teuchos::RCP<algebra::Vector> initial_;
  TwoPhaseProblem problem_;
  TwoPhaseVerifier verifier_;
  TwoPhaseBalance balance_;
  TwoPhaseProbes probes_;
  fv::View<double* [components]> owed_;  ///< what the last step accepted has left of the balances of the owned cells [kg/m^3]
  models::TimeStep step_;                ///< the one begun
  std::optional<FlowFindings> found_;    ///< at the X of the step begun that was judged last
  std::vector<double> jumps_;
  bool closed_;                                 ///< no part of the boundary says what the pressure is
  Teuchos::RCP<const algebra::Vector> before_;  ///< X^{n-1} of the step begun
  Teuchos::RCP<const algebra::Vector>
      before_last_;  ///< at the beginning of the last step accepted, whose length is last_length_ [s]; null: none
  double last_length_ = 0;
  std::unique_ptr<TwoPhaseBound> bound_;
  bool bound_begun_ = false;                          ///< it knows of the step begun
  std::optional<complementarity::Estimate> of_step_;  ///< its last estimate in this step
  BoundSoFar bound_so_far_;
};

}  // namespace thixis::flow
