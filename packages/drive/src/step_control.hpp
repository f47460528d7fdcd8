#pragma once
#include <algorithm>
#include <vector>

#include "thixis/drive/params.hpp"
#include "thixis/models/evolution.hpp"

namespace thixis::drive {

/// How long the next step of time is.
///
/// Steps end at marks: the multiples of time/step (not where the estimate controls the steps), the times of time/also and those at which
/// data of the scene jump, and time/end. A step that fails is cut to a half; those behind it grow by at most time/growth until they reach
/// the marks again.
///
/// With time/adaptive the time part of the estimate of a step is to be half of its space part. Their ratio is proportional to the length,
/// which the next step takes from that: at most growth times longer, at least half as long. A step with four times the ratio is too long
/// and begun again.
class StepControl {
 public:
  explicit StepControl(const TimeParams& params, std::vector<double> jumps = {})
      : params_(params), also_(std::move(jumps)), length_(std::min(params.step, longest())) {
    also_.insert(also_.end(), params.also.begin(), params.also.end());
    std::sort(also_.begin(), also_.end());
  }

  /// Where the step that begins at t ends.
  double end_of_step(double t) const;
  /// The step was too long for the solver. False if a shorter one would be below time/smallest.
  bool cut(double tried);
  /// Whether the step is to be begun again for its error in time; then the next one is shorter.
  bool too_long(double tried, const models::StepErrors& errors);
  /// The step has ended well.
  void accept(double tried, const std::optional<models::StepErrors>& errors);

  double smallest() const;
  /// What a restart needs.
  double length() const { return length_; }
  void set_length(double length) { length_ = length; }

 private:
  double next_mark(double t) const;
  double longest() const { return params_.adaptive ? params_.largest.value_or(params_.end) : params_.step; }

  const TimeParams& params_;
  std::vector<double> also_;  ///< of the deck and of the scene, rising
  double length_;             ///< wanted for the next step
};

}  // namespace thixis::drive
