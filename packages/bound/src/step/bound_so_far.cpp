#include "step/bound_so_far.hpp"

#include <cmath>
#include <utility>

#include "estimate/square.hpp"

namespace thixis::bound {

using complementarity::Promise;

double SquaredBound::bound() const { return remainder + std::sqrt(remainder * remainder + energy); }

void BoundSoFar::start(double square, std::vector<std::string> doubts) {
  *this = BoundSoFar();
  all_ = {square, 0};
  disc2_ = square;
  at_start_ = std::move(doubts);
  promise_ = at_start_.empty() ? Promise::guaranteed : Promise::up_to_quadrature;
}

void BoundSoFar::take_over(const BoundSoFar& from, double jump) {
  *this = from;
  all_.energy += jump * jump;
  all_.remainder += jump;
  disc2_ += jump * jump;
}

void BoundSoFar::accept(const StepEstimate& step) {
  all_.energy += step.square.energy;
  all_.remainder += step.square.remainder;
  disc2_ += squared(step.parts[0]);
  lin2_ += squared(step.parts[1]);
  alg2_ += squared(step.parts[2]);
  time2_ += squared(step.errors.time);
  promise_ = weakest(promise_, step.eta.promise);
}

complementarity::Estimate BoundSoFar::estimate() const {
  complementarity::Estimate eta;
  eta.total = all_.bound();
  eta.discretization = std::sqrt(disc2_) + 2 * all_.remainder;
  eta.linearization = std::sqrt(lin2_);
  eta.algebraic = std::sqrt(alg2_);
  eta.time = std::sqrt(time2_);
  eta.promise = promise_;
  return eta;
}

std::map<std::string, double> BoundSoFar::sums() const {
  const double values[] = {all_.energy, all_.remainder, disc2_, lin2_, alg2_, time2_, static_cast<double>(promise_)};
  std::map<std::string, double> sums;
  for (std::size_t i = 0; i < StepBound::names_of_sums().size(); ++i) sums[StepBound::names_of_sums()[i]] = values[i];
  return sums;
}

void BoundSoFar::restore(const std::map<std::string, double>& sums) {
  double promise = 0;
  double* const values[] = {&all_.energy, &all_.remainder, &disc2_, &lin2_, &alg2_, &time2_, &promise};
  for (std::size_t i = 0; i < StepBound::names_of_sums().size(); ++i) *values[i] = sums.at(StepBound::names_of_sums()[i]);
  promise_ = static_cast<Promise>(promise);
}

const std::vector<std::string>& StepBound::names_of_sums() {
  static const std::vector<std::string> names = {"bound",           "bound_remainder", "bound_discretization", "bound_linearization",
                                                 "bound_algebraic", "bound_time",      "bound_promise"};
  return names;
}

}  // namespace thixis::bound
