#include "krylov/watch.hpp"

#include <fmt/core.h>

#include <BelosIteration.hpp>
#include <BelosLinearProblem.hpp>
#include <cmath>
#include <limits>

namespace thixis::algebra {

namespace {

/// A recursive residual that has fallen by this factor since b - A x was computed may have lost all its digits.
constexpr double trusted_reduction = 1e-12;
/// A cycle that does not reduce the true residual to this fraction makes no progress; two in a row are the end. A method that believes to
/// be done, and is not, should do much better in its next cycle.
constexpr double progress_of_full_cycle = 0.999;
constexpr double progress_after_promise = 0.5;

double native_residual(Watch::Iteration& iteration) {
  std::vector<double> norms(1);
  const auto r = iteration.getNativeResiduals(&norms);
  if (!r.is_null()) r->norm2(Teuchos::arrayViewFromVector(norms));
  return norms[0];
}

}  // namespace

void Watch::begin(const LinearStop& stop, int max_iterations) {
  stop_ = stop;
  asks_ = stop.check_every > 0 && stop.criterion;
  max_iterations_ = max_iterations;
  asked_ = 0;
  stalled_ = 0;
  cycle_residual_ = std::numeric_limits<double>::infinity();
  verdict_ = Verdict::go_on;
  report_ = LinearReport();
}

bool Watch::begin_cycle(const Vector& x, double residual, int iterations) {
  const double expected = cycle_residual_ * (verdict_ == Verdict::tolerance ? progress_after_promise : progress_of_full_cycle);
  stalled_ = residual <= expected ? 0 : stalled_ + 1;
  report_.residual = cycle_residual_ = residual;
  if (ends_with(x, residual, iterations)) {
    report_.iterations = iterations;
    return false;
  }
  verdict_ = Verdict::go_on;
  status_ = Belos::Undefined;
  judged_ = -1;
  return true;
}

bool Watch::ends_with(const Vector& x, double residual, int iterations) {
  if (!std::isfinite(residual)) return end(false, report_.reason.empty() ? "the iterate holds NaN or infinity" : report_.reason);
  if (verdict_ == Verdict::criterion) {
    report_.by_criterion = true;
    return end(true, "");
  }
  if (residual <= stop_.tolerance) return end(true, "");
  if (verdict_ == Verdict::failure) return end(false, report_.reason);
  if (verdict_ == Verdict::limit) return end(false, fmt::format("{} iterations were not enough", iterations));
  if (stalled_ < 2) return false;
  // The iterate will not get better, so the criterion has a last chance to be content with it.
  report_.by_criterion = asks_ && asked_ != iterations && ask(x, iterations, residual);
  return end(report_.by_criterion, report_.by_criterion ? "" : fmt::format("the residual stagnates at {:.3g}", residual));
}

bool Watch::end(bool converged, const std::string& reason) {
  report_.converged = converged;
  report_.reason = reason;
  return true;
}

void Watch::fail(const std::string& reason) {
  verdict_ = Verdict::failure;
  report_.reason = reason;
}

bool Watch::ask(const Vector& x, int iteration, double residual) {
  asked_ = iteration;
  return stop_.criterion(x, iteration, residual);
}

Teuchos::RCP<const MultiVector> Watch::iterate(Iteration& iteration) {
  return const_cast<Belos::LinearProblem<double, MultiVector, Operator>&>(iteration.getProblem()).getCurrLHSVec();
}

Belos::StatusType Watch::checkStatus(Iteration* iteration) {
  if (iteration->getNumIters() != judged_) {
    judged_ = iteration->getNumIters();
    verdict_ = judge(*iteration);
    status_ = verdict_ == Verdict::go_on ? Belos::Failed : Belos::Passed;
  }
  return status_;
}

Watch::Verdict Watch::judge(Iteration& iteration) {
  const int i = iteration.getNumIters();
  const bool new_iterate = i != report_.iterations;
  report_.iterations = i;
  const double norm = native_residual(iteration);
  if (!std::isfinite(norm)) {
    report_.reason = "the preconditioner or the iteration produces NaN or infinity";
    return Verdict::failure;
  }
  if (norm <= std::max(stop_.tolerance, trusted_reduction * cycle_residual_)) return Verdict::tolerance;
  report_.reason = breakdown(iteration, norm);
  if (!report_.reason.empty()) return Verdict::failure;
  if (new_iterate && asks_ && i % stop_.check_every == 0) {
    const auto x = iterate(iteration);
    if (ask(*x->getVector(0), i, norm)) return Verdict::criterion;
  }
  return i >= max_iterations_ ? Verdict::limit : Verdict::go_on;
}

}  // namespace thixis::algebra
