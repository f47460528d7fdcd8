#pragma once
#include <BelosStatusTest.hpp>
#include <BelosTpetraAdapter.hpp>
#include <string>

#include "thixis/algebra/solver.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::algebra {

/// Decides after each Krylov iteration whether to go on. It lives through all restarts of one solve, and counts their iterations together.
///
/// A Krylov method updates its residual by recursion; so does this class judge it. Whoever drives the method computes b - A x at the end
/// of each cycle, and starts another one if the recursion promised too much.
class Watch : public Belos::StatusTest<double, MultiVector, Operator> {
 public:
  using Iteration = Belos::Iteration<double, MultiVector, Operator>;
  enum class Verdict { go_on, tolerance, criterion, limit, failure };

  /// Of a solve.
  void begin(const LinearStop& stop, int max_iterations);
  /// Of a cycle from the iterate x, with residual = |b - A x|: false if the solve has to end here, with the report filled in.
  bool begin_cycle(const Vector& x, double residual, int iterations);
  /// The Krylov method can not continue; the reason is for the log.
  void fail(const std::string& reason);
  const LinearReport& report() const { return report_; }

  Belos::StatusType checkStatus(Iteration* iteration) override;
  Belos::StatusType getStatus() const override { return status_; }
  void reset() override {}
  void print(std::ostream&, int = 0) const override {}

 protected:
  /// Why the numbers of this iteration forbid another one; empty if they do not.
  virtual std::string breakdown(Iteration&, double /*residual*/) const { return ""; }
  /// x^i, valid until the next iteration. Here: that of a method which updates it in place.
  virtual Teuchos::RCP<const MultiVector> iterate(Iteration& iteration);

 private:
  Verdict judge(Iteration& iteration);
  bool ends_with(const Vector& x, double residual, int iterations);
  bool ask(const Vector& x, int iteration, double residual);
  bool end(bool converged, const std::string& reason);  ///< true

  LinearStop stop_;
  bool asks_ = false;
  int max_iterations_ = 0;
  int asked_ = 0;              ///< the iteration at which the criterion was asked last
  int judged_ = -1;            ///< Belos asks twice for the same iteration, after a restart and when it returns
  int stalled_ = 0;            ///< cycles in a row without progress
  double cycle_residual_ = 0;  ///< true residual at the begin of the cycle
  Verdict verdict_ = Verdict::go_on;
  Belos::StatusType status_ = Belos::Undefined;
  LinearReport report_;
};

}  // namespace thixis::algebra
