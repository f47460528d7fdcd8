#pragma once
#include <map>
#include <string>
#include <vector>

#include "level/membranes_on_mesh.hpp"
#include "thixis/bound/step_bound.hpp"
#include "thixis/membranes/parabolic_membranes.hpp"

namespace thixis::membranes {

/// a u + b v.
method::Coefficients combination(double a, const method::Coefficients& u, double b, const method::Coefficients& v);

/// Where a run in time stands.
enum class Standing {
  at_rest,  ///< no step is known: at X^0, behind a restart, on a new mesh, or where a step was given up
  opening,  ///< a step is being begun, and its data may yet be refused
  in_step,
  at_end  ///< the step was accepted
};

/// The step begun or accepted last, with the state before it.
struct OpenStep {
  models::TimeStep time;
  Pair before;                            ///< u^{n-1}
  Teuchos::RCP<const algebra::Vector> X;  ///< X^{n-1}
  bool estimated = false;                 ///< `seen` is u of the last estimate
  Pair seen;
};

/// The step accepted before: where it began, and its length; X null: there is none that may be extrapolated.
struct LastStep {
  Teuchos::RCP<const algebra::Vector> X;
  double length = 0;
};

/// Two membranes in time on a mesh that may be refined (docs/methods/parabolic.md).
class ParabolicEvolution final : public MembranesOnMesh<models::Evolution> {
 public:
  ParabolicEvolution(const MembraneScene& scene, const method::Method& by, const method::MethodParams& method,
                     const algebra::LinearParams& linear, mesh::Hierarchy hierarchy, std::optional<double> friedrichs,
                     std::vector<models::Probe> probes);

  // parabolic_evolution.cpp: from step to step
  Teuchos::RCP<algebra::Vector> initial() override;
  void check(const std::vector<double>& times) const override;
  void begin(const models::TimeStep& step, const algebra::Vector& before) override;
  bool predict(algebra::Vector& X) override;
  void give_up() override;
  void accept(const algebra::Vector& X) override;
  complementarity::KktData kkt_data(const algebra::Vector& X) const override;
  std::vector<std::string> series_names() const override;
  std::vector<double> series(const algebra::Vector& X) const override;

  // parabolic_error.cpp: the error and the bound on it
  complementarity::Estimate estimate(const algebra::Vector& X) override;
  models::CellEstimates cell_estimates() const override;
  std::optional<models::StepErrors> step_errors() const override;
  std::vector<std::string> doubts() const override;
  std::string remark() const override;
  std::optional<double> energy_error(const algebra::Vector& X) const override;
  std::optional<double> error_so_far() const override;
  std::optional<complementarity::Estimate> estimate_so_far() const override;
  bool every_step_estimated() const override;

  // parabolic_meshes.cpp: finer meshes, and a run that is taken up again
  models::State save(const algebra::Vector& X) const override;
  Teuchos::RCP<algebra::Vector> restore(const output::StoredCheckpoint& stored) override;
  const mesh::Hierarchy* hierarchy() const override { return &hierarchy_; }
  Teuchos::RCP<algebra::Vector> refine(const std::vector<GlobalIndex>& marked, const algebra::Vector& X) override;

 private:
  bool step_is_known() const { return standing_ == Standing::in_step || standing_ == Standing::at_end; }
  bool step_is_open() const { return standing_ == Standing::opening || standing_ == Standing::in_step; }
  void set_loads();
  double step_error(const Pair& end) const;
  std::unique_ptr<bound::StepBound> make_bound(double time) const;
  void append(const std::vector<GlobalIndex>& marked);
  void go_to_finest();
  int finest_level() const { return static_cast<int>(hierarchy_.levels.size()) - 1; }
  void replay(const output::StoredCheckpoint& stored);
  std::unique_ptr<MembraneLevel> make_level() const;

  double origin_;              ///< of heights: where the membranes are held at the beginning
  const MembraneScene scene_;  ///< with heights counted from there
  algebra::LinearParams linear_;
  models::TimeScheme scheme_;
  mesh::Hierarchy hierarchy_;
  std::shared_ptr<method::Levels> levels_;          ///< of it
  std::optional<double> friedrichs_;                ///< given in the deck
  std::vector<models::Probe> probes_;               ///< of series.csv
  std::map<int, std::vector<GlobalIndex>> marked_;  ///< cells whose refinement made this level

  double rate_ = 0;  ///< of the scheme, in the matrices; 0: none yet
  Standing standing_ = Standing::at_rest;
  OpenStep step_;
  LastStep last_;
  double squared_error_ = 0;                      ///< of the steps accepted
  std::unique_ptr<bound::StepBound> bound_;       ///< made when an estimate is first asked for
  bool bounded_ = false;                          ///< every step so far was estimated
  std::map<std::string, double> restored_bound_;  ///< sums of a checkpoint
};

}  // namespace thixis::membranes
