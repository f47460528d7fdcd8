#include "multigrid/coupled.hpp"

#include <fmt/core.h>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"

namespace thixis::algebra {
namespace {

using Range = Kokkos::RangePolicy<Node::execution_space>;

template <class Out>
struct MarkCoupled {
  Matrix::local_matrix_device_type A;
  Map::local_map_type rows, columns;
  Out coupled;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex i) const {
    const LocalIndex diagonal = columns.getLocalElement(rows.getGlobalElement(i));
    double mark = 0;
    for (auto k = A.graph.row_map(i); k < A.graph.row_map(i + 1); ++k)
      if (A.graph.entries(k) != diagonal && A.values(k) != 0) mark = 1;
    coupled(i, 0) = mark;
  }
};

}  // namespace

Vector coupled_rows(const Matrix& A) {
  Vector coupled(A.getRowMap());
  const auto out = coupled.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  Kokkos::parallel_for(
      "thixis::algebra::coupled_rows", Range(0, local_rows(A)),
      MarkCoupled<std::decay_t<decltype(out)>>{A.getLocalMatrixDevice(), A.getRowMap()->getLocalMap(), A.getColMap()->getLocalMap(), out});
  return coupled;
}

void require_diagonal(const Matrix& A, const std::string& name) {
  Vector diagonal(A.getRowMap());
  A.getLocalDiagCopy(diagonal);
  int zeros = 0;
  {
    const auto d = std::as_const(diagonal).getLocalViewDevice(Tpetra::Access::ReadOnly);
    Kokkos::parallel_reduce(
        "thixis::algebra::zeros_on_diagonal", Range(0, d.extent_int(0)), KOKKOS_LAMBDA(int i, int& sum) { sum += d(i, 0) == 0; }, zeros);
  }
  if (comm_of(*A.getRowMap()).any(zeros > 0))
    throw core::InputError(
        fmt::format("linear/preconditioner: '{}' can not work on a matrix with zeros on the diagonal: write the form 'reduced', or the "
                    "preconditioner 'ilu'.",
                    name));
}

}  // namespace thixis::algebra
