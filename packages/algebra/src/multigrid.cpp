#include "multigrid.hpp"

#include <MueLu_CreateTpetraPreconditioner.hpp>
#include <cmath>

#include "factorization.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"

namespace thixis::algebra {

namespace {

/// Systems of this size are factorized: the coarsest level, and the whole matrix if it is so small.
constexpr int coarse_rows = 500;
/// Levels with fewer rows per rank than this move to fewer ranks. As it is larger than `coarse_rows`, the coarsest level lives on one rank,
/// where KLU2 can be trusted (on several it can not).
constexpr int rows_per_rank = 2000;

/// A^{-1} as an operator.
class Inverse : public Operator {
 public:
  explicit Inverse(const Teuchos::RCP<const Matrix>& A) : domain_(A->getDomainMap()), range_(A->getRangeMap()) { lu_.set_matrix(A); }
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

/// MueLu validates the names.
Teuchos::ParameterList options(int fields, int ranks, const Teuchos::RCP<const MultiVector>& coordinates) {
  Teuchos::ParameterList list;
  list.set("verbosity", "none");
  list.set("multigrid algorithm", "sa");
  list.set("number of equations", fields);
  list.set("coarse: max size", coarse_rows);
  list.set("smoother: type", "CHEBYSHEV");
  list.sublist("smoother: params").set("chebyshev: degree", 2);
  if (ranks == 1) return list;
  list.set("repartition: enable", true);
  list.set("repartition: partitioner", "zoltan2");
  list.set("repartition: start level", 1);
  // Cutting into several parts needs coordinates; moving all to one rank does not.
  const bool cut = !coordinates.is_null();
  list.set("repartition: min rows per proc", cut ? rows_per_rank : std::numeric_limits<int>::max());
  list.sublist("repartition: params").set("algorithm", std::string(cut ? "rcb" : "block"));
  if (cut) list.sublist("user data").set("Coordinates", Teuchos::rcp_const_cast<MultiVector>(coordinates));
  return list;
}

class Multigrid : public Preconditioner {
 public:
  void set_matrix(const Teuchos::RCP<const Matrix>& A, int fields, const Teuchos::RCP<const MultiVector>& coordinates) override {
    ++setups_;
    require(*A, fields);
    if (static_cast<long long>(A->getGlobalNumRows()) <= coarse_rows) {
      inverse_ = Teuchos::rcp(new Inverse(A));
      return;
    }
    auto list = options(fields, A->getComm()->getSize(), coordinates);
    const Teuchos::RCP<Operator> op = Teuchos::rcp_const_cast<Matrix>(A);
    try {
      inverse_ = MueLu::CreateTpetraPreconditioner(op, list);
    } catch (const std::exception&) {
      throw Breakdown("the set-up of the multigrid preconditioner failed");
    }
  }
  Teuchos::RCP<const Operator> inverse() const override { return inverse_; }
  int symbolic_setups() const override { return setups_; }

 private:
  static void require(const Matrix& A, int fields) {
    Vector diagonal(A.getRowMap());
    A.getLocalDiagCopy(diagonal);
    bool zero = false;
    {
      const auto d = host_view(static_cast<const Vector&>(diagonal));
      for (LocalIndex i = 0; i < local_rows(A); ++i) zero = zero || d(i) == 0;
    }
    const core::Comm comm = comm_of(*A.getRowMap());
    if (comm.any(zero))
      throw core::InputError(
          "linear/preconditioner: 'muelu' can not work on a matrix with zeros on the diagonal: write the form 'reduced', or the "
          "preconditioner 'ilu'.");
    if (comm.any(fields < 1 || local_rows(A) % fields != 0))
      throw core::InputError("linear/preconditioner: 'muelu' needs all unknowns of a node on one rank: write the preconditioner 'ilu'.");
  }

  Teuchos::RCP<const Operator> inverse_;
  int setups_ = 0;
};

}  // namespace

std::unique_ptr<Preconditioner> make_multigrid() { return std::make_unique<Multigrid>(); }

}  // namespace thixis::algebra
