#include "thixis/algebra/solver.hpp"

#include <cmath>

#include "direct.hpp"
#include "ilu.hpp"
#include "krylov/cg.hpp"
#include "krylov/gmres.hpp"
#include "multigrid/aggregation.hpp"
#include "multigrid/hierarchy.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::algebra {

namespace {

/// Counts the entries that are NaN or infinite.
struct NotFinite {
  Kokkos::View<const double*, Node::memory_space> values;
  KOKKOS_FUNCTION void operator()(std::size_t k, int& count) const {
    if (!(values(k) - values(k) == 0)) ++count;
  }
};

bool finite(const Matrix& A) {
  const NotFinite kernel{A.getLocalMatrixDevice().values};
  int count = 0;
  Kokkos::parallel_reduce("thixis::algebra::not_finite", Kokkos::RangePolicy<Node::execution_space>(0, kernel.values.extent(0)), kernel,
                          count);
  return comm_of(*A.getRowMap()).all(count == 0);
}

std::unique_ptr<Method> make_method(const LinearParams& params) {
  switch (params.solver) {
    case SolverKind::gmres:
      return make_gmres(params.restart, params.max_iterations);
    case SolverKind::cg:
      return make_cg(params.max_iterations);
    case SolverKind::direct:
      break;
  }
  return make_direct();
}

std::unique_ptr<Preconditioner> make_preconditioner(const LinearParams& params) {
  if (params.solver == SolverKind::direct) return nullptr;
  switch (params.preconditioner) {
    case PreconditionerKind::ilu:
    case PreconditionerKind::ilut:
      return make_ilu(params);
    case PreconditionerKind::muelu:
      return make_aggregation("muelu");
    case PreconditionerKind::multigrid:
      return make_multigrid();
    case PreconditionerKind::none:
      break;
  }
  return nullptr;
}

}  // namespace

struct Solver::Impl {
  std::unique_ptr<Method> method;
  std::unique_ptr<Preconditioner> preconditioner;
  Teuchos::RCP<const Matrix> A;
  std::string failure;  ///< why no system with this matrix can be solved
  double seconds = 0;

  void set_up(int fields, const Nodes& nodes);
};

Solver::Solver(const LinearParams& params) : impl_(std::make_unique<Impl>()) {
  if (params.solver == SolverKind::cg && params.preconditioner == PreconditionerKind::ilut)
    throw core::InputError(
        "linear/preconditioner: cg needs a symmetric preconditioner: write 'multigrid', 'muelu' or 'ilu', or the solver 'gmres'.");
  impl_->method = make_method(params);
  impl_->preconditioner = make_preconditioner(params);
}

Solver::~Solver() = default;

void Solver::set_matrix(const Teuchos::RCP<const Matrix>& A, int fields, const Nodes& nodes) {
  core::Region region("preconditioner");
  core::WithoutFloatingPointTraps quiet;
  const core::Stopwatch watch;
  impl_->A = A;
  impl_->failure.clear();
  try {
    impl_->set_up(fields, nodes);
  } catch (const Breakdown& breakdown) {
    impl_->failure = breakdown.what();
  }
  impl_->seconds += watch.seconds();
}

void Solver::Impl::set_up(int fields, const Nodes& nodes) {
  if (A->getGlobalNumRows() == 0) return;
  if (!finite(*A)) throw Breakdown("the matrix holds NaN or infinity");
  if (preconditioner) preconditioner->set_matrix(A, fields, nodes);
  method->set_matrix(A, preconditioner ? preconditioner->inverse() : Teuchos::null);
}

LinearReport Solver::solve(const Vector& b, Vector& x, const LinearStop& stop) const {
  if (impl_->A.is_null()) throw core::Error(core::ExitCode::internal, "algebra::Solver: solve() needs set_matrix() first");
  THIXIS_ASSERT(b.getMap()->isSameAs(*impl_->A->getRangeMap()) && x.getMap()->isSameAs(*impl_->A->getDomainMap()),
                "b and x are distributed like the rows and columns of A");
  core::Region region("linear");
  core::WithoutFloatingPointTraps quiet;
  LinearReport report;
  report.residual = std::numeric_limits<double>::quiet_NaN();
  if (impl_->A->getGlobalNumRows() == 0) {
    report.residual = 0;
    report.converged = true;
  } else if (!std::isfinite(norm2(b))) {
    report.reason = "the right-hand side holds NaN or infinity";
  } else if (!std::isfinite(norm2(x))) {
    report.reason = "the initial guess holds NaN or infinity";
  } else if (!impl_->failure.empty()) {
    report.reason = impl_->failure;
  } else {
    const Vector start(x, Teuchos::Copy);
    report = impl_->method->solve(b, x, stop);
    if (!std::isfinite(report.residual)) Tpetra::deep_copy(x, start);
  }
  return report;
}

double Solver::seconds_preconditioner() const { return impl_->seconds; }

int Solver::symbolic_setups() const {
  return impl_->preconditioner ? impl_->preconditioner->symbolic_setups() : impl_->method->symbolic_setups();
}

}  // namespace thixis::algebra
