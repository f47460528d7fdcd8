#pragma once
#include <array>
#include <map>
#include <string>
#include <vector>

#include "thixis/bound/step_bound.hpp"

namespace thixis::bound {

/// y² <= G² + 2 R y, what an error y obeys over a time.
struct SquaredBound {
  double energy = 0, remainder = 0;  ///< G², and R: the norm in L1(L2) of what no flux balances
  double bound() const;
};

/// The bound at one iterate of a step.
struct StepEstimate {
  complementarity::Estimate eta;
  SquaredBound square;
  std::array<double, 3> parts = {0, 0, 0};  ///< discretization, linearization, algebraic without the remainder
  StepBound::Errors errors;                 ///< space: but for the flux at the end of the step
};

/// The bound over all steps that were accepted.
class BoundSoFar {
 public:
  /// Nothing but the error at time 0, whose square is at most this; `doubts`: what keeps that from being exact.
  void start(double square, std::vector<std::string> doubts);
  /// From the bound on a mesh before: s jumps by no more than `jump`, |y + J|² <= |y|² + 2 |y| J + J².
  void take_over(const BoundSoFar& from, double jump);
  void accept(const StepEstimate& step);

  complementarity::Estimate estimate() const;
  const std::vector<std::string>& doubts_at_start() const { return at_start_; }
  std::map<std::string, double> sums() const;
  void restore(const std::map<std::string, double>& sums);

 private:
  SquaredBound all_;
  double disc2_ = 0, lin2_ = 0, alg2_ = 0, time2_ = 0;
  complementarity::Promise promise_ = complementarity::Promise::guaranteed;  ///< the weakest of all steps
  std::vector<std::string> at_start_;
};

}  // namespace thixis::bound
