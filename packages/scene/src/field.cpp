#include "thixis/scene/field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "polynomial.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/expression.hpp"

namespace thixis::scene {
namespace {

constexpr std::size_t block = 1024;  // temporary coordinates stay in the first-level cache

std::string too_large() {
  return fmt::format(
      "too large to compute with, since products of data must be numbers, too: write the data in units in which they are at most {:g}",
      largest_value);
}

class Constant final : public Field {
 public:
  explicit Constant(double value) : value_(value) {}
  void evaluate(const Points& points, double, double* values) const override { std::fill_n(values, points.count, value_); }
  const double* constant() const override { return &value_; }
  std::optional<Degree> degree() const override { return Degree{}; }

 private:
  double value_;
};

class ExpressionField final : public Field {
 public:
  ExpressionField(std::string name, core::Expression expression, const std::vector<double>& centre, std::optional<Degree> degree)
      : name_(std::move(name)),
        expression_(std::move(expression)),
        centre_{centre[0], centre[1]},
        radial_(expression_.uses("r")),
        steady_(!expression_.uses("t")),
        degree_(degree) {}

  void evaluate(const Points& points, double t, double* values) const override {
    std::array<double, block> time, radius;
    std::fill_n(time.begin(), std::min(block, points.count), t);
    for (std::size_t begin = 0; begin < points.count; begin += block) {
      const Points part{std::min(block, points.count - begin), points.x + begin, points.y + begin};
      if (radial_)
        for (std::size_t i = 0; i < part.count; ++i) radius[i] = std::hypot(part.x[i] - centre_[0], part.y[i] - centre_[1]);
      else std::fill_n(radius.begin(), part.count, 0.0);
      const double* variables[] = {part.x, part.y, time.data(), radius.data()};
      expression_.evaluate(part.count, variables, values + begin);
      require_finite(name_, part, t, values + begin);
    }
  }
  bool steady() const override { return steady_; }
  std::optional<Degree> degree() const override { return degree_; }

 private:
  std::string name_;
  core::Expression expression_;
  double centre_[2];
  bool radial_, steady_;
  std::optional<Degree> degree_;
};

/// What the text proves, or where it is no single polynomial what the user says.
std::optional<Degree> known_degree(const core::Expression& expression, const std::map<std::string, double>& constants,
                                   std::optional<int> named) {
  const auto proved = degree_of(expression.text(), constants);
  if (proved && proved->whole) return proved;
  if (!named) return {};
  const int most = expression.uses("t") ? *named : 0;
  if (!proved) return Degree{*named, most, false};
  return Degree{std::min(proved->space, *named), std::min(proved->time, most), false};
}

/// One component of the gradient: (45 (u_1 - u_-1) - 9 (u_2 - u_-2) + (u_3 - u_-3)) / (60 step), u_k = u(x + k step e).
class Difference final : public Field {
 public:
  Difference(FieldPtr u, double step, int direction) : u_(std::move(u)), step_(step), direction_(direction) {}

  void evaluate(const Points& points, double t, double* values) const override {
    constexpr double weight[3] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
    std::array<double, block> moved, sample;
    for (std::size_t begin = 0; begin < points.count; begin += block) {
      const Points part{std::min(block, points.count - begin), points.x + begin, points.y + begin};
      const double* from = direction_ == 0 ? part.x : part.y;
      const Points at = direction_ == 0 ? Points{part.count, moved.data(), part.y} : Points{part.count, part.x, moved.data()};
      std::fill_n(values + begin, part.count, 0.0);
      for (int k = 1; k <= 3; ++k)
        for (const int sign : {1, -1}) {
          for (std::size_t i = 0; i < part.count; ++i) moved[i] = from[i] + sign * k * step_;
          u_->evaluate(at, t, sample.data());
          for (std::size_t i = 0; i < part.count; ++i) values[begin + i] += sign * weight[k - 1] / step_ * sample[i];
        }
    }
  }
  bool steady() const override { return u_->steady(); }

 private:
  FieldPtr u_;
  double step_;
  int direction_;
};

}  // namespace

FieldPtr constant(double value) { return std::make_shared<Constant>(value); }

FieldPtr expression(const std::string& name, const std::string& text, const std::vector<double>& centre,
                    const std::map<std::string, double>& constants, std::optional<int> named) {
  if (centre.size() != 2) throw core::InputError(name + ": the centre from which r is measured must have two coordinates.");
  try {
    core::Expression parsed(text, {"x", "y", "t", "r"}, constants);
    if (!parsed.constant()) {
      const auto degree = known_degree(parsed, constants, named);
      return std::make_shared<ExpressionField>(name, std::move(parsed), centre, degree);
    }
    const double value = parsed({0, 0, 0, 0});
    if (!std::isfinite(value)) throw core::InputError(fmt::format("'{}' is not a finite number.", text));
    if (std::abs(value) > largest_value) throw core::InputError(fmt::format("{:.6g} is {}.", value, too_large()));
    return constant(value);
  } catch (const core::InputError& error) {
    throw core::InputError(name + ": " + error.what());
  }
}

std::array<FieldPtr, 2> difference_gradient(FieldPtr u, double step) {
  if (u->constant() != nullptr) return {constant(0), constant(0)};
  return {std::make_shared<Difference>(u, step, 0), std::make_shared<Difference>(u, step, 1)};
}

void require_finite(const std::string& name, const Points& points, double t, const double* values) {
  const auto refuse = [&](std::size_t i, const std::string& why) {
    throw core::InputError(fmt::format("{}: the value at x = {:.6g}, y = {:.6g}, t = {:.6g} {}.", name, points.x[i], points.y[i], t, why));
  };
  for (std::size_t i = 0; i < points.count; ++i) {
    if (std::abs(values[i]) <= largest_value) continue;
    if (std::isfinite(values[i])) refuse(i, fmt::format("is {:.6g}, {}", values[i], too_large()));
    refuse(i, "is not a finite number; write a function that is defined there");
  }
}

}  // namespace thixis::scene
