#include "krylov/gmres.hpp"

// The first header is missing in the second.
// clang-format off
#include <Teuchos_SerialDenseMatrix.hpp>
#include <BelosBlockGmresIter.hpp>
// clang-format on
#include <BelosICGSOrthoManager.hpp>
#include <BelosLinearProblem.hpp>
#include <BelosOutputManager.hpp>
#include <cmath>

#include "krylov/krylov_iterate.hpp"
#include "krylov/watch.hpp"

namespace thixis::algebra {

namespace {

using Problem = Belos::LinearProblem<double, MultiVector, Operator>;
using GmresIteration = Belos::BlockGmresIter<double, MultiVector, Operator>;

/// Belos would make new vectors for each iterate that is looked at.
class GmresWatch : public Watch {
  Teuchos::RCP<const MultiVector> iterate(Watch::Iteration& iteration) override {
    const auto state = dynamic_cast<GmresIteration&>(iteration).getState();
    auto& problem = const_cast<Problem&>(iteration.getProblem());
    const Teuchos::RCP<MultiVector> x = problem.getCurrLHSVec();
    if (x.is_null()) return {};  // no system is being solved
    return iterate_(*x, problem.getRightPrec().get(), *state.V, *state.R, *state.z, state.curDim);
  }

  KrylovIterate iterate_;
};

class Gmres : public Method {
 public:
  Gmres(int restart, int max_iterations) : restart_(restart), max_iterations_(max_iterations) {}

  void set_matrix(const Teuchos::RCP<const Matrix>& A, const Teuchos::RCP<const Operator>& inverse) override {
    if (A_.is_null() || !A->getRowMap()->isSameAs(*A_->getRowMap())) {
      iteration_.reset();
      problem_ = Teuchos::rcp(new Problem);
    }
    A_ = A;
    problem_->setOperator(A);
    problem_->setRightPrec(inverse);
  }

  LinearReport solve(const Vector& b, Vector& x, const LinearStop& stop) override {
    set_vectors(b, x);
    if (!iteration_) iteration_ = std::make_unique<GmresIteration>(problem_, output_, watch_, orthogonalization_, *options());
    iteration_->resetNumIters();
    watch_->begin(stop, max_iterations_);
    Vector r(b.getMap(), false);
    for (;;) {
      const double norm = residual(*A_, b, x, r);
      if (!watch_->begin_cycle(x, norm, iteration_->getNumIters())) break;
      r.scale(1 / norm);
      begin_cycle(r, norm);
      add(run_cycle());
    }
    problem_->setLHS(Teuchos::null);
    problem_->setRHS(Teuchos::null);
    return watch_->report();
  }

 private:
  void set_vectors(const Vector& b, Vector& x) {
    problem_->setProblem(Teuchos::rcpFromRef(static_cast<MultiVector&>(x)), Teuchos::rcpFromRef(static_cast<const MultiVector&>(b)));
    problem_->setLSIndex({0});
  }

  /// The Krylov space can not be larger than the system; its basis is allocated once and kept for the next solve.
  Teuchos::RCP<Teuchos::ParameterList> options() const {
    const auto rows = static_cast<long long>(A_->getGlobalNumRows());
    auto list = Teuchos::parameterList();
    list->set("Block Size", 1);
    list->set("Num Blocks", static_cast<int>(std::min<long long>({restart_, max_iterations_, rows})));
    list->set("Keep Hessenberg", false);
    return list;
  }

  void begin_cycle(const Vector& direction, double norm) {
    Belos::GmresIterationState<double, MultiVector> state;
    state.curDim = 0;
    state.V = Teuchos::rcpFromRef(static_cast<const MultiVector&>(direction));
    const auto z = Teuchos::rcp(new Teuchos::SerialDenseMatrix<int, double>(1, 1));
    (*z)(0, 0) = norm;
    state.z = z;
    iteration_->initializeGmres(state);
  }

  /// An update that is not finite would take the iterate with it.
  void add(const Teuchos::RCP<MultiVector>& update) {
    if (update.is_null()) return;
    if (std::isfinite(update->getVector(0)->norm2())) problem_->updateSolution(update, true);
    else watch_->fail("GMRES breaks down: its correction holds NaN or infinity");
  }

  /// V_k y_k, before it is preconditioned.
  Teuchos::RCP<MultiVector> run_cycle() {
    try {
      iteration_->iterate();
      return iteration_->getCurrentUpdate();
    } catch (const Belos::GmresIterationOrthoFailure&) {
      return update_after_breakdown();
    } catch (const Belos::BelosError&) {
      watch_->fail("GMRES breaks down");
      return Teuchos::null;
    }
  }

  /// A M^{-1} v_k lies in the Krylov space. For a regular matrix the solution does, too, and is found with the last column of the
  /// Hessenberg matrix; for a singular one that column may be dependent, and is left out.
  Teuchos::RCP<MultiVector> update_after_breakdown() {
    const auto without = iteration_->getCurrentUpdate();
    iteration_->updateLSQR(iteration_->getCurSubspaceDim());
    const auto with = iteration_->getCurrentUpdate();
    return std::isfinite(with->getVector(0)->norm2()) ? with : without;
  }

  int restart_;
  int max_iterations_;
  Teuchos::RCP<const Matrix> A_;
  Teuchos::RCP<Problem> problem_;  ///< keeps vectors, like iteration_, from one solve to the next
  Teuchos::RCP<Watch> watch_ = Teuchos::rcp(new GmresWatch);
  Teuchos::RCP<Belos::OutputManager<double>> output_ = Teuchos::rcp(new Belos::OutputManager<double>(Belos::Errors));
  Teuchos::RCP<Belos::MatOrthoManager<double, MultiVector, Operator>> orthogonalization_ =
      Teuchos::rcp(new Belos::ICGSOrthoManager<double, MultiVector, Operator>);
  std::unique_ptr<GmresIteration> iteration_;
};

}  // namespace

std::unique_ptr<Method> make_gmres(int restart, int max_iterations) { return std::make_unique<Gmres>(restart, max_iterations); }

}  // namespace thixis::algebra
