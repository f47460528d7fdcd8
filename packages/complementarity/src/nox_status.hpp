#pragma once
#include <NOX_StatusTest_Generic.H>

#include <unordered_map>
#include <vector>

#include "nox_group.hpp"

namespace thixis::complementarity {

/// A status test that asks one question about the present iterate and the one before; the answer yes has the meaning `yes`.
class Question : public NOX::StatusTest::Generic {
 public:
  explicit Question(NOX::StatusTest::StatusType yes) : yes_(yes) {}
  NOX::StatusTest::StatusType checkStatus(const NOX::Solver::Generic& solver, NOX::StatusTest::CheckType type) override;
  NOX::StatusTest::StatusType getStatus() const override { return status_; }
  std::ostream& print(std::ostream& stream, int) const override { return stream; }
  bool answered() const { return status_ == yes_; }

 protected:
  /// k counts the steps of this NOX solver; at k = 0 `before` is not to be read.
  virtual bool ask(const State& now, const State& before, int k) = 0;
  /// The present iterate.
  const algebra::Vector& X() const { return *X_; }

 private:
  NOX::StatusTest::StatusType yes_;
  NOX::StatusTest::StatusType status_ = NOX::StatusTest::Unevaluated;
  const algebra::Vector* X_ = nullptr;
};

/// |R| <= bound. Full steps of Newton-min (`patient`): also that the last step changed no contact point, or left no more residual than the
/// linear solver, so that what changes are ties; or that it is the fifth such iterate in a row. Where tensions differ by orders of
/// magnitude, |R| may be small long before the contact set is right.
class SmallResidual : public Question {
 public:
  SmallResidual(const System& system, bool patient) : Question(NOX::StatusTest::Converged), system_(system), patient_(patient) {}

 private:
  bool ask(const State& now, const State& before, int k) override;
  const System& system_;
  bool patient_;
  int in_a_row_ = 0;
};

/// Newton-min, full step: the same contact set as before, and no residual but that of the linear solver.
class SettledContactSet : public Question {
 public:
  explicit SettledContactSet(const System& system) : Question(NOX::StatusTest::Converged), system_(system) {}

 private:
  bool ask(const State& now, const State& before, int k) override;
  const System& system_;
};

/// Rule `adaptive`: the parts of the estimate say that neither the linear solver nor Newton has anything to do that would show. They must
/// have said so at the iterate before, too, or the last step changed no contact point: eta_lin is not monotone.
class SmallEstimate : public Question {
 public:
  explicit SmallEstimate(System& system) : Question(NOX::StatusTest::Converged), system_(system) {}

 private:
  bool ask(const State& now, const State& before, int k) override;
  System& system_;
  bool held_ = false;  ///< at the iterate before
};

/// Newton-min, full steps: a contact set that was left comes back with the residual it had, see newton.hpp.
class Cycle : public Question {
 public:
  explicit Cycle(const System& system) : Question(NOX::StatusTest::Failed), system_(system) {}
  int period() const { return period_; }

 private:
  struct Visit {
    int k;
    double residual;
  };
  bool ask(const State& now, const State& before, int k) override;
  const System& system_;
  std::unordered_map<std::uint64_t, Visit> visits_;
  int period_ = 0;
};

/// |R| <= factor |R at k = 0|: the damped steps have done their work.
class Fallen : public Question {
 public:
  explicit Fallen(double factor) : Question(NOX::StatusTest::Converged), factor_(factor) {}

 private:
  bool ask(const State& now, const State& before, int k) override;
  double factor_;
  double start_ = 0;
};

/// |R_k| > |R_{k-10}| for ten successive k: growth that is more than the ups and downs of Newton-min.
class Growing : public Question {
 public:
  Growing() : Question(NOX::StatusTest::Failed) {}

 private:
  bool ask(const State& now, const State& before, int k) override;
  std::vector<double> residuals_;
  int grown_ = 0;
};

/// |R_k| exceeds 1e20 times the larger one of |R_0| and |(F, 0)|: no good run of undamped steps goes that far.
class Diverged : public Question {
 public:
  explicit Diverged(const System& system) : Question(NOX::StatusTest::Failed), system_(system) {}
  double factor() const { return factor_; }  ///< of the last iterate

 private:
  bool ask(const State& now, const State& before, int k) override;
  const System& system_;
  double start_ = 0, factor_ = 0;
};

}  // namespace thixis::complementarity
