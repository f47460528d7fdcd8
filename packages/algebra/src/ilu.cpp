#include "ilu.hpp"

#include <Ifpack2_Factory.hpp>
#include <cmath>

#include "failure.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::algebra {

namespace {

using Inverse = Ifpack2::Preconditioner<double, LocalIndex, GlobalIndex, Node>;

class Ilu : public Preconditioner {
 public:
  explicit Ilu(const LinearParams& params) : params_(params) {}

  void set_matrix(const Teuchos::RCP<const Matrix>& A, int, const Nodes&) override {
    const bool new_graph = values_.is_null() || values_->getCrsGraph().get() != A->getCrsGraph().get();
    if (new_graph) create(*A);
    Kokkos::deep_copy(values_->getLocalMatrixDevice().values, A->getLocalMatrixDevice().values);
    try {
      set_up(new_graph);
    } catch (const Breakdown&) {
      values_ = Teuchos::null;
      throw;
    }
  }
  Teuchos::RCP<const Operator> inverse() const override { return inverse_; }
  int symbolic_setups() const override { return symbolic_setups_; }

 private:
  /// Ifpack2 forgets the pattern when it is given another matrix object, so it works on an own one, into which values are copied.
  void create(const Matrix& A) {
    values_ = Teuchos::rcp(new Matrix(A.getCrsGraph()));
    values_->fillComplete(A.getDomainMap(), A.getRangeMap());
    const bool ilu = params_.preconditioner == PreconditionerKind::ilu;
    overlapping_ = params_.overlap > 0 && A.getComm()->getSize() > 1;

    Teuchos::ParameterList local;
    if (ilu) {
      local.set("fact: iluk level-of-fill", params_.ilu_level);
    } else {
      local.set("fact: ilut level-of-fill", params_.ilut_fill);
      local.set("fact: drop tolerance", 0.);
    }
    const std::string name = ilu ? "RILUK" : "ILUT";
    if (!overlapping_) {
      inverse_ = Ifpack2::Factory::create<Matrix>(name, values_);
      inverse_->setParameters(local);
      return;
    }
    Teuchos::ParameterList schwarz;
    schwarz.set("schwarz: overlap level", params_.overlap);
    schwarz.set("schwarz: combine mode", params_.solver == SolverKind::cg ? "Add" : "Zero");
    schwarz.set("inner preconditioner name", name);
    schwarz.set("inner preconditioner parameters", local);
    inverse_ = Ifpack2::Factory::create<Matrix>("SCHWARZ", values_);
    inverse_->setParameters(schwarz);
  }

  /// Collective. Rows of other ranks are copied by initialize() only, so overlapping factorizations need it for new values, too.
  void set_up(bool new_graph) {
    const core::Comm comm = comm_of(*values_->getRowMap());
    std::optional<std::string> failure;
    try {
      if (new_graph || overlapping_) {
        inverse_->initialize();
        ++symbolic_setups_;
      }
      inverse_->compute();
    } catch (const std::exception& exception) {
      failure = said_by(exception);
    }
    break_down_together(comm, "the incomplete factorization can not be set up", failure);
    if (!finite()) throw Breakdown("the incomplete factorization has a zero pivot");
  }

  /// A zero pivot leaves infinity in the factors, and Ifpack2 does not say so.
  bool finite() const {
    Vector ones(values_->getRangeMap()), y(values_->getDomainMap());
    ones.putScalar(1);
    inverse_->apply(ones, y);
    return std::isfinite(norm2(y));
  }

  LinearParams params_;
  Teuchos::RCP<Matrix> values_;
  Teuchos::RCP<Inverse> inverse_;
  bool overlapping_ = false;
  int symbolic_setups_ = 0;
};

}  // namespace

std::unique_ptr<Preconditioner> make_ilu(const LinearParams& params) { return std::make_unique<Ilu>(params); }

}  // namespace thixis::algebra
