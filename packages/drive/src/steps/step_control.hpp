#pragma once
#include <algorithm>
#include <optional>
#include <vector>

#include "thixis/drive/params.hpp"
#include "thixis/models/evolution.hpp"

namespace thixis::drive {

/// Times behind `from` at which a step is known to end: the end and those of time/also and `jumps`, and where the lengths are not
/// controlled the multiples of time/step, all or a hundred of them, evenly.
std::vector<double> known_times(const TimeParams& params, const std::vector<double>& jumps, double from);

/// How long the next step of time is.
///
/// Steps end at marks: the multiples of time/step (not where the estimate controls the steps), the times of time/also and those at which
/// data of the scene jump, and time/end. A step that fails is cut to a half; those behind it grow by at most time/growth until they reach
/// the marks again.
///
/// With time/adaptive the time part of the estimate of a step is to be half of its space part, or of what counts for nothing beside the
/// bound, if that is more. Their ratio is proportional to the length, which the next step takes from that: at most growth times longer, at
/// least half as long. A step with four times the ratio is too long and begun again, at most half as long, unless it is as short as
/// time/smallest, or the attempt before was longer and its ratio hardly larger: where both parts vary alike, as while forces grow from
/// nothing, shorter steps are of no use. They go back to the length that was refused, until the ratio is half of what it was there.
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
  /// A step that is to be begun again is so for another reason than the length of the one before.
  void forget() {
    refused_.reset();
    of_no_use_ = false;
  }
  /// What a restart needs.
  double length() const { return length_; }
  void set_length(double length) { length_ = length; }

 private:
  double next_mark(double t) const;
  double longest() const { return params_.adaptive ? params_.largest.value_or(params_.end) : params_.step; }

  const TimeParams& params_;
  std::vector<double> also_;  ///< of the deck and of the scene, rising
  double length_;             ///< wanted for the next step
  struct Attempt {
    double length, ratio;
  };
  std::optional<Attempt> refused_;  ///< the last attempt that was too long for its error, until a step is good enough
  bool of_no_use_ = false;          ///< to make it shorter
};

}  // namespace thixis::drive
