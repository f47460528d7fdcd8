#include "thixis/bound/step_bound.hpp"

#include <cmath>

#include "estimate/exactness.hpp"
#include "estimate/square.hpp"
#include "step/bound_so_far.hpp"
#include "step/step_evaluation.hpp"
#include "thixis/method/measures.hpp"

namespace thixis::bound {

using complementarity::Estimate;
using method::Coefficients;

struct StepBound::Impl {
  StepEvaluation step;
  BoundSoFar so_far;
};

StepBound::StepBound(const method::Space& space, const ContactProblem& problem, const mesh::Hierarchy& hierarchy, int level,
                     std::optional<double> friedrichs)
    : impl_(new Impl{{space, problem, hierarchy, level, friedrichs}, {}}) {}
StepBound::~StepBound() = default;

/// |u_0 - s| <= |u_0 - u_h| + |u_h - s|.
void StepBound::start(double time, const Coefficients (&u)[2], const std::array<scene::FieldPtr, 2>& initial) {
  const auto away = impl_->step.distance(time, u);
  const BoundParts& parts = impl_->step.parts();
  double square = 0;
  std::vector<std::string> doubts;
  for (int alpha = 0; alpha < parts.problem.count; ++alpha) {
    square += squared(away[alpha] + (initial[alpha] ? std::sqrt(method::l2_error(parts.space, u[alpha], initial[alpha], time)) : 0));
    if (!initial[alpha]) continue;
    for (auto& clause : doubts_at_start(parts.space, alpha, *initial[alpha])) doubts.push_back(std::move(clause));
  }
  impl_->so_far.start(square, std::move(doubts));
}

void StepBound::take_over(const StepBound& coarse, double time, const Coefficients (&coarse_u)[2], const Coefficients (&u)[2]) {
  Impl& from = *coarse.impl_;
  const auto there = from.step.distance(time, coarse_u), here = impl_->step.distance(time, u);
  const double jump = std::hypot(there[0], there[1]) + std::hypot(here[0], here[1]) + from.step.change_by_interpolation(time);
  impl_->so_far.take_over(from.so_far, jump);
}

void StepBound::begin(double begin, double end, const Coefficients (&before)[2]) { impl_->step.start(begin, end, before); }

Estimate StepBound::operator()(const Iterate& iterate) {
  impl_->step(iterate);
  return impl_->step.estimate().eta;
}

StepBound::Errors StepBound::errors() { return impl_->step.errors(); }
bool StepBound::resolved() const { return impl_->step.resolved(); }

std::vector<std::string> StepBound::doubts() const {
  std::vector<std::string> all = impl_->step.doubts();
  const auto& at_start = impl_->so_far.doubts_at_start();
  all.insert(all.end(), at_start.begin(), at_start.end());
  return all;
}

const GuaranteedBound::CellParts& StepBound::cells() const { return impl_->step.parts().cells; }
void StepBound::accept() { impl_->so_far.accept(impl_->step.estimate()); }
Estimate StepBound::so_far() const { return impl_->so_far.estimate(); }
std::map<std::string, double> StepBound::sums() const { return impl_->so_far.sums(); }
void StepBound::restore(const std::map<std::string, double>& sums) { impl_->so_far.restore(sums); }
GuaranteedBound::Fluxes StepBound::fluxes(int alpha) const { return impl_->step.fluxes(alpha); }
int StepBound::flux_degree() const { return impl_->step.parts().q; }
std::size_t StepBound::bytes() const { return impl_->step.bytes(); }

}  // namespace thixis::bound
