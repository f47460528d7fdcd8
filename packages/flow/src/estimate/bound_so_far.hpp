#pragma once
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "thixis/complementarity/estimate.hpp"
#include "thixis/output/checkpoint.hpp"

namespace thixis::flow {

/// The estimate over all steps: roots of sums of squares, as long as every step has one.
class BoundSoFar {
 public:
  void add(const std::optional<complementarity::Estimate>& of_step) {
    every_step_ = every_step_ && of_step.has_value();
    if (!every_step_) return;
    const double parts[] = {of_step->total, of_step->discretization, of_step->linearization, of_step->algebraic, of_step->time.value_or(0)};
    for (std::size_t i = 0; i < squares_.size(); ++i) squares_[i] += parts[i] * parts[i];
    any_step_ = true;
  }
  std::optional<complementarity::Estimate> value() const {
    if (!every_step_ || !any_step_) return std::nullopt;
    complementarity::Estimate eta{std::sqrt(squares_[0]), std::sqrt(squares_[1]), std::sqrt(squares_[2]), std::sqrt(squares_[3]), 0, 0};
    eta.time = std::sqrt(squares_[4]);
    return eta;
  }
  bool every_step() const { return every_step_; }
  void save(std::map<std::string, double>& attributes) const {
    attributes["bound_every_step"] = every_step_;
    attributes["bound_any_step"] = any_step_;
    for (std::size_t i = 0; i < squares_.size(); ++i) attributes[names[i]] = squares_[i];
  }
  void restore(const output::StoredCheckpoint& stored) {
    every_step_ = stored.count("bound_every_step", 1) != 0;
    any_step_ = stored.count("bound_any_step", 1) != 0;
    for (std::size_t i = 0; i < squares_.size(); ++i) squares_[i] = stored.number(names[i], 0);
  }

 private:
  static constexpr const char* names[] = {"bound_total", "bound_discretization", "bound_linearization", "bound_algebraic", "bound_time"};
  std::array<double, 5> squares_ = {0, 0, 0, 0, 0};
  bool every_step_ = true, any_step_ = false;
};

}  // namespace thixis::flow
