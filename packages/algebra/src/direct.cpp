#include "direct.hpp"

#include <fmt/core.h>

#include "factorization.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::algebra {

namespace {

/// Of |A| |x|: what rounding in A x alone can amount to, with some room for the growth of the factors.
constexpr double rounding = 1e-13;

class Direct : public Method {
 public:
  void set_matrix(const Teuchos::RCP<const Matrix>& A, const Teuchos::RCP<const Operator>&) override {
    A_ = A;
    lu_.set_matrix(A);
  }

  LinearReport solve(const Vector& b, Vector& x, const LinearStop& stop) override {
    LinearReport report;
    Vector r(b.getMap(), false);
    lu_.solve(b, x);
    report.iterations = 1;
    report.residual = residual(*A_, b, x, r);
    if (!(report.residual <= stop.tolerance)) refine(b, x, r, report);
    report.converged = report.residual <= std::max(stop.tolerance, rounding * A_->getFrobeniusNorm() * norm2(x));
    if (!report.converged) report.reason = fmt::format("the residual of the LU factorization is {:.3g}", report.residual);
    return report;
  }

  int symbolic_setups() const override { return lu_.symbolic_setups(); }

 private:
  void refine(const Vector& b, Vector& x, const Vector& r, LinearReport& report) const {
    Vector better(x.getMap(), false), r_better(b.getMap(), false);
    lu_.solve(r, better);
    better.update(1., x, 1.);
    const double norm = residual(*A_, b, better, r_better);
    ++report.iterations;
    if (!(norm < report.residual)) return;
    report.residual = norm;
    Tpetra::deep_copy(x, better);
  }

  Teuchos::RCP<const Matrix> A_;
  Factorization lu_;
};

}  // namespace

std::unique_ptr<Method> make_direct() { return std::make_unique<Direct>(); }

}  // namespace thixis::algebra
