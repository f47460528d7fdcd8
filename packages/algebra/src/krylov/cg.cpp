#include "krylov/cg.hpp"

#include <BelosCGIter.hpp>
#include <BelosLinearProblem.hpp>
#include <BelosOutputManager.hpp>

#include "krylov/watch.hpp"

namespace thixis::algebra {

namespace {

using Problem = Belos::LinearProblem<double, MultiVector, Operator>;
using Iteration = Belos::CGIter<double, MultiVector, Operator>;

/// Belos tests only the quotient of r·z, z = M^{-1} r, and p·Ap, where two wrong signs cancel.
class CgWatch : public Watch {
  std::string breakdown(Watch::Iteration& iteration, double) const override {
    const auto state = dynamic_cast<Belos::CGIteration<double, MultiVector, Operator>&>(iteration).getState();
    double rz = 0;
    state.R->dot(*state.Z, Teuchos::arrayView(&rz, 1));
    return rz > 0 ? "" : "the preconditioner is not positive definite, so cg can not use it";
  }
};

class Cg : public Method {
 public:
  explicit Cg(int max_iterations) : max_iterations_(max_iterations) {}

  void set_matrix(const Teuchos::RCP<const Matrix>& A, const Teuchos::RCP<const Operator>& inverse) override {
    A_ = A;
    inverse_ = inverse;
  }

  LinearReport solve(const Vector& b, Vector& x, const LinearStop& stop) override {
    const auto problem = Teuchos::rcp(
        new Problem(A_, Teuchos::rcpFromRef(static_cast<MultiVector&>(x)), Teuchos::rcpFromRef(static_cast<const MultiVector&>(b))));
    if (!inverse_.is_null()) problem->setLeftPrec(inverse_);
    problem->setProblem();
    problem->setLSIndex({0});
    const auto watch = Teuchos::rcp(new CgWatch);
    Teuchos::ParameterList options;
    Iteration iteration(problem, Teuchos::rcp(new Belos::OutputManager<double>(Belos::Errors)), watch, Teuchos::null, options);

    watch->begin(stop, max_iterations_);
    const auto r = Teuchos::rcp(new Vector(b.getMap(), false));
    while (watch->begin_cycle(x, residual(*A_, b, x, *r), iteration.getNumIters())) {
      Belos::CGIterationState<double, MultiVector> state;
      state.R = r;
      iteration.initializeCG(state);
      try {
        iteration.iterate();
      } catch (const Belos::CGIterateFailure&) {
        watch->fail("the matrix is not positive definite, so cg can not solve the system");
      }
    }
    return watch->report();
  }

 private:
  int max_iterations_;
  Teuchos::RCP<const Matrix> A_;
  Teuchos::RCP<const Operator> inverse_;
};

}  // namespace

std::unique_ptr<Method> make_cg(int max_iterations) { return std::make_unique<Cg>(max_iterations); }

}  // namespace thixis::algebra
