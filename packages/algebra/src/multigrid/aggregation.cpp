#include "multigrid/aggregation.hpp"

#include <dlfcn.h>

#include <cmath>
#include <stdexcept>

#include "factorization.hpp"
#include "failure.hpp"
#include "multigrid/coupled.hpp"
#include "multigrid/muelu.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"

namespace thixis::algebra {

namespace {

/// A row without any off-diagonal entry but zeros gets this fraction of the mean diagonal.
constexpr double decoupled_diagonal = 1e-4;

/// A^{-1} by LU.
class Exact : public Operator {
 public:
  explicit Exact(const Teuchos::RCP<const Matrix>& A) : domain_(A->getDomainMap()), range_(A->getRangeMap()) { lu_.set_matrix(A); }
  MapPtr getDomainMap() const override { return range_; }
  MapPtr getRangeMap() const override { return domain_; }
  void apply(const MultiVector& b, MultiVector& x, Teuchos::ETransp, double alpha, double beta) const override {
    Vector column(domain_, false);
    for (std::size_t j = 0; j < b.getNumVectors(); ++j) {
      lu_.solve(*b.getVector(j), column);
      x.getVectorNonConst(j)->update(alpha, column, beta);
    }
  }

 private:
  MapPtr domain_, range_;
  Factorization lu_;
};

/// y_i = b_i / a_ii in the decoupled rows, a multigrid cycle in the others.
///
/// Decoupled rows are conditions like u = g or u2 = u1 on some of the nodes. Aggregates that reach across the edge of such a patch would be
/// held back by the diagonal entries in it; so the cycle is built for a matrix where those are small, and does not touch these rows.
class CoupledCycle : public Operator {
 public:
  CoupledCycle(const Teuchos::RCP<const Operator>& cycle, const Vector& coupled, const Vector& diagonal)
      : cycle_(cycle), coupled_(coupled, Teuchos::Copy), inverse_(diagonal.getMap()) {
    const auto c = host_view(coupled), d = host_view(diagonal);
    const auto inverse = host_overwrite(inverse_);
    for (std::size_t i = 0; i < inverse.extent(0); ++i) inverse(i) = (1 - c(i)) / d(i);
  }
  MapPtr getDomainMap() const override { return cycle_->getDomainMap(); }
  MapPtr getRangeMap() const override { return cycle_->getRangeMap(); }
  void apply(const MultiVector& b, MultiVector& x, Teuchos::ETransp, double alpha, double beta) const override {
    MultiVector c(b.getMap(), b.getNumVectors()), y(x.getMap(), x.getNumVectors());
    c.elementWiseMultiply(1, coupled_, b, 0);
    cycle_->apply(c, y);
    x.elementWiseMultiply(alpha, coupled_, y, beta);
    x.elementWiseMultiply(alpha, inverse_, b, 1);
  }

 private:
  Teuchos::RCP<const Operator> cycle_;
  Vector coupled_;  ///< 1 or 0
  Vector inverse_;  ///< 1 / a_ii in the decoupled rows, 0 in the others
};

/// The matrix with a small diagonal in its decoupled rows.
Teuchos::RCP<Matrix> relaxed(const Matrix& A, const Vector& coupled, const Vector& diagonal) {
  const auto B = Teuchos::rcp(new Matrix(A.getCrsGraph()));
  Kokkos::deep_copy(B->getLocalMatrixDevice().values, A.getLocalMatrixDevice().values);
  const double small = decoupled_diagonal * diagonal.dot(coupled) / coupled.norm1();
  {
    const auto c = host_view(coupled);
    for (LocalIndex i = 0; i < local_rows(A); ++i)
      if (c(i) == 0) {
        const LocalIndex column = A.getColMap()->getLocalElement(A.getRowMap()->getGlobalElement(i));
        B->replaceLocalValues(i, 1, &small, &column);
      }
  }
  B->fillComplete(A.getDomainMap(), A.getRangeMap());
  return B;
}

/// The maker of cycles in the library of MueLu, which is loaded here, once. Throws std::runtime_error.
MueluCycle* muelu_cycle() {
  static void* library = nullptr;
  if (!library) library = dlopen("libthixis_muelu.so", RTLD_NOW | RTLD_LOCAL);
  void* const maker = library ? dlsym(library, muelu_cycle_name) : nullptr;
  if (!maker) throw std::runtime_error(dlerror());
  return reinterpret_cast<MueluCycle*>(maker);
}

Teuchos::RCP<const Operator> muelu(const Teuchos::RCP<Matrix>& A, int fields, const Teuchos::RCP<const MultiVector>& coordinates) {
  Teuchos::RCP<const Operator> cycle;
  std::optional<std::string> failure;
  try {
    muelu_cycle()(A, fields, coordinates, cycle);
    Vector ones(A->getRangeMap()), y(A->getDomainMap());
    ones.putScalar(1);
    cycle->apply(ones, y);
    if (!std::isfinite(norm2(y))) failure = "a cycle produces NaN or infinity";
  } catch (const std::exception& exception) {
    failure = said_by(exception);
  }
  break_down_together(comm_of(*A->getRowMap()), "multigrid can not be set up for this matrix", failure);
  return cycle;
}

class Aggregation : public Preconditioner {
 public:
  explicit Aggregation(std::string name) : name_(std::move(name)) {}

  void set_matrix(const Teuchos::RCP<const Matrix>& A, int fields, const Nodes& nodes) override {
    ++setups_;
    require(*A, fields);
    Vector diagonal(A->getRowMap());
    A->getLocalDiagCopy(diagonal);
    const Vector coupled = coupled_rows(*A);
    const double rows = static_cast<double>(A->getGlobalNumRows()), count = coupled.norm1();
    if (count <= coarse_rows) inverse_ = Teuchos::rcp(new Exact(A));
    else if (count == rows) inverse_ = muelu(Teuchos::rcp_const_cast<Matrix>(A), fields, nodes.coordinates);
    else inverse_ = Teuchos::rcp(new CoupledCycle(muelu(relaxed(*A, coupled, diagonal), fields, nodes.coordinates), coupled, diagonal));
  }
  Teuchos::RCP<const Operator> inverse() const override { return inverse_; }
  int symbolic_setups() const override { return setups_; }

 private:
  void require(const Matrix& A, int fields) const {
    require_diagonal(A, name_);
    if (comm_of(*A.getRowMap()).any(fields < 1 || local_rows(A) % fields != 0))
      throw core::InputError("linear/preconditioner: '" + name_ +
                             "' needs all unknowns of a node on one rank: write the preconditioner 'ilu'.");
  }

  std::string name_;
  Teuchos::RCP<const Operator> inverse_;
  int setups_ = 0;
};

}  // namespace

std::unique_ptr<Preconditioner> make_aggregation(const std::string& name) { return std::make_unique<Aggregation>(name); }

}  // namespace thixis::algebra
