#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "step/step_estimate.hpp"
#include "step/step_flux.hpp"

namespace thixis::bound {

/// What does not change from step to step.
struct StepSetting {
  double friedrichs = 0;  ///< the constant given, else that of the box where the whole boundary is held; 0: none
  bool steady_force = true, steady_boundary = true;
  double least[2] = {1, 1};  ///< tension of all

  /// Collective; throws InputError for methods without a bound in time and for tractions or tensions that depend on time.
  StepSetting(const BoundParts& parts, std::optional<double> friedrichs);
};

/// The step begun, and its bound at the last iterate.
class StepEvaluation {
 public:
  /// As StepBound.
  StepEvaluation(const method::Space& space, const ContactProblem& problem, const mesh::Hierarchy& hierarchy, int level,
                 std::optional<double> friedrichs);

  /// From u at `begin`. Collective.
  void start(double begin, double end, const method::Coefficients (&u)[2]);
  /// The bound at an iterate at the end. Collective.
  void operator()(const Iterate& iterate);
  const StepEstimate& estimate() const { return step_; }
  StepBound::Errors errors() const;  ///< collective
  bool resolved() const { return data_.resolved; }

  /// |u_alpha - s_alpha| at a time, whose feasible pair is kept. Collective.
  std::array<double, 2> distance(double time, const method::Coefficients (&u)[2]);
  double change_by_interpolation(double time) const { return pair_at(time)->change_by_interpolation(); }  ///< collective

  /// What keeps the bound of the step from being guaranteed.
  std::vector<std::string> doubts() const;
  const BoundParts& parts() const { return parts_; }
  GuaranteedBound::Fluxes fluxes(int alpha) const;
  std::size_t bytes() const;

 private:
  std::shared_ptr<const FeasiblePair> pair_at(double time) const;
  void change_data();
  Sums<OfFlux> sum_of_fluxes() const;
  Sums<OfStep> sum_of_pair() const;
  void sum_up();

  BoundParts parts_;
  StepSetting setting_;
  StepFlux flux_;
  View<double*> contact_before_, move_change_;
  StepBegin before_;
  DataChange data_;
  Iterate iterate_;
  FeasiblePair::Way way_;
  StepEstimate step_;
};

}  // namespace thixis::bound
