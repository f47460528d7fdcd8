#include "step_control.hpp"

#include <algorithm>
#include <cmath>

namespace thixis::drive {
namespace {

constexpr double wanted_ratio = 0.5;  ///< of the error in time to that in space
constexpr double round_off = 1e-9;    ///< of a step: times that are closer are the same

/// By how much a step may be longer so that its errors are in the wanted ratio.
double factor(const models::StepErrors& errors, double least, double most) {
  if (!(errors.time > 0)) return most;
  return std::clamp(wanted_ratio * errors.space / errors.time, least, most);
}

}  // namespace

double StepControl::next_mark(double t) const {
  const double slack = std::max(round_off * params_.step, TimeParams::resolution * params_.end);
  const auto also = std::upper_bound(also_.begin(), also_.end(), t + slack);
  double mark = also == also_.end() ? params_.end : std::min(params_.end, *also);
  if (!params_.adaptive) {
    const double multiple = (std::floor(t / params_.step + round_off) + 1) * params_.step;
    if (multiple < mark - slack) mark = multiple;
  }
  return mark;
}

double StepControl::end_of_step(double t) const {
  const double mark = next_mark(t), left = mark - t;
  if (length_ >= left * (1 - round_off)) return mark;
  if (2 * length_ > left) return t + left / 2;  // two equal steps rather than a long and a tiny one
  return t + length_;
}

double StepControl::smallest() const {
  return params_.smallest.value_or(std::max(params_.step / (1 << 20), TimeParams::resolution * params_.end));
}

bool StepControl::cut(double tried) {
  length_ = tried / 2;
  return length_ >= smallest();
}

bool StepControl::too_long(double tried, const models::StepErrors& errors) {
  if (!params_.adaptive || errors.time <= 4 * wanted_ratio * errors.space || tried <= smallest()) return false;
  length_ = std::max(tried * factor(errors, 0.1, 1), smallest());
  return true;
}

void StepControl::accept(double tried, const std::optional<models::StepErrors>& errors) {
  double next = std::max(length_, tried) * params_.growth;
  if (params_.adaptive && errors) next = tried * factor(*errors, 0.5, params_.growth);
  length_ = std::max(std::min(next, longest()), std::min(smallest(), longest()));
}

}  // namespace thixis::drive
