#include "steps/step_control.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thixis::drive {
namespace {

constexpr double wanted_ratio = 0.5;                                       ///< of the error in time to that in space
constexpr double most_ratio = 4 * wanted_ratio;                            ///< of a step that is not too long
constexpr double resolution = 4 * std::numeric_limits<double>::epsilon();  ///< of numbers of steps
constexpr double round_off = 1e-9;                                         ///< of a step: times that are closer are the same

double ratio(const models::StepErrors& errors) { return errors.time > 0 ? errors.time / std::max(errors.space, errors.negligible) : 0; }

/// By how much a step may be longer so that its errors are in the wanted ratio.
double factor(double ratio, double least, double most) { return ratio > 0 ? std::clamp(wanted_ratio / ratio, least, most) : most; }

/// Whether the ratio has fallen with the length: by more than the fourth root of what the length has.
bool falls(double length, double ratio, double length_before, double ratio_before) {
  return ratio < ratio_before * std::pow(length / length_before, 0.25);
}

}  // namespace

std::vector<double> known_times(const TimeParams& params, const std::vector<double>& jumps, double from) {
  constexpr double most = 100;
  std::vector<double> times = params.also;
  times.insert(times.end(), jumps.begin(), jumps.end());
  const double first = std::floor(from / params.step), count = std::floor(params.end / params.step) - first;
  for (double k = 1; !params.adaptive && k <= std::min(count, most); ++k)
    times.push_back((first + std::round(k * std::max(1.0, count / most))) * params.step);
  times.erase(std::remove_if(times.begin(), times.end(), [&](double t) { return t <= from || t >= params.end; }), times.end());
  std::sort(times.begin(), times.end());
  times.push_back(params.end);
  return times;
}

double StepControl::next_mark(double t) const {
  const double slack = std::max(round_off * params_.step, TimeParams::resolution * params_.end);
  const auto also = std::upper_bound(also_.begin(), also_.end(), t + slack);
  double mark = also == also_.end() ? params_.end : std::min(params_.end, *also);
  if (!params_.adaptive) {
    const double steps = t / params_.step;  // that long ago; a whole number up to round-off
    const double multiple = (std::floor(steps + std::max(round_off, resolution * steps)) + 1) * params_.step;
    if (multiple < mark - slack) mark = multiple;
  }
  return mark;
}

double StepControl::end_of_step(double t) const {
  const double mark = next_mark(t), left = mark - t;
  if (length_ >= left * (1 - round_off) - TimeParams::resolution * params_.end) return mark;
  if (2 * length_ > left) return t + left / 2;  // two equal steps rather than a long and a tiny one
  return t + length_;
}

double StepControl::smallest() const {
  return std::max(params_.smallest.value_or(params_.step / (1 << 20)), TimeParams::resolution * params_.end);
}

bool StepControl::cut(double tried) {
  length_ = tried / 2;
  return length_ >= smallest();
}

bool StepControl::too_long(double tried, const models::StepErrors& errors) {
  const double now = ratio(errors);
  if (!params_.adaptive || now <= most_ratio || std::min(tried, length_) <= smallest()) return false;
  if (of_no_use_) of_no_use_ = now >= 0.5 * refused_->ratio;
  else of_no_use_ = refused_ && !falls(tried, now, refused_->length, refused_->ratio);
  if (of_no_use_) return false;
  refused_ = {tried, now};
  length_ = std::max(tried * factor(now, 0.1, 0.5), smallest());
  return true;
}

void StepControl::accept(double tried, const std::optional<models::StepErrors>& errors) {
  double next = std::max(length_, tried) * params_.growth;
  if (params_.adaptive && errors) next = tried * factor(ratio(*errors), 0.5, params_.growth);
  const bool still = of_no_use_ && errors && ratio(*errors) > most_ratio;
  if (still) next = std::max(tried, refused_->length);
  else forget();
  length_ = std::max(std::min(next, longest()), std::min(smallest(), longest()));
}

}  // namespace thixis::drive
