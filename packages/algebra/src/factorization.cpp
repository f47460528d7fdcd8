#include "factorization.hpp"

#include <fmt/core.h>

#include <Amesos2.hpp>
#include <Teuchos_DefaultSerialComm.hpp>
#include <algorithm>
#include <cmath>
#include <optional>

#include "failure.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::algebra {

namespace {

using Lu = Amesos2::Solver<Matrix, MultiVector>;

/// A relative error of this size in the solution of a system whose solution is known means that A is singular to working precision.
constexpr double hopeless_error = 1e-3;

std::vector<GlobalIndex> ids_of(const Map& map) {
  std::vector<GlobalIndex> ids(local_size(map));
  for (LocalIndex i = 0; i < local_size(map); ++i) ids[i] = map.getGlobalElement(i);
  return ids;
}

/// The largest entry of each column, 1 for an empty one.
std::vector<double> column_scales(const Matrix& A) {
  std::vector<double> scale(local_columns(A), 0.);
  const auto local = A.getLocalMatrixDevice();
  const auto column = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), local.graph.entries);
  const auto value = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), local.values);
  for (std::size_t k = 0; k < value.extent(0); ++k) scale[column(k)] = std::max(scale[column(k)], std::abs(value(k)));
  for (double& s : scale)
    if (s == 0) s = 1;
  return scale;
}

}  // namespace

struct Factorization::Impl {
  GraphPtr graph;                     ///< of A, distributed
  MapPtr gathered_map;                ///< all rows on rank 0
  Teuchos::RCP<const Import> import;  ///< rows of A -> gathered_map
  Teuchos::RCP<Matrix> gathered;      ///< A on gathered_map
  Teuchos::RCP<Matrix> serial;        ///< rank 0: a view of `gathered` on a communicator of its own
  Teuchos::RCP<Lu> lu;                ///< rank 0
  int symbolic_setups = 0;

  void gather_graph(const Teuchos::RCP<const Matrix>& A);
  void gather_values(const Matrix& A);
  void view_serially();
  void factorize();
  double error_of_known_solution() const;
};

Factorization::Factorization() : impl_(std::make_unique<Impl>()) {}
Factorization::~Factorization() = default;
int Factorization::symbolic_setups() const { return impl_->symbolic_setups; }

void Factorization::Impl::gather_graph(const Teuchos::RCP<const Matrix>& A) {
  graph = Teuchos::null;
  lu = Teuchos::null;
  const core::Comm comm = comm_of(*A->getRowMap());
  gathered_map = map_of(comm.gather_on_root(ids_of(*A->getRowMap())), comm);
  import = Teuchos::rcp(new Import(A->getRowMap(), gathered_map));
  // Not importAndFillCompleteCrsGraph: it crashes for a diagonal matrix on several ranks. New values need a matrix with a const graph.
  const auto copy = Tpetra::importAndFillCompleteCrsMatrix<Matrix>(A, *import, gathered_map, gathered_map);
  gathered = Teuchos::rcp(new Matrix(copy->getCrsGraph()));
  gathered->fillComplete(gathered_map, gathered_map);
  graph = A->getCrsGraph();
}

void Factorization::Impl::gather_values(const Matrix& A) {
  gathered->resumeFill();
  gathered->setAllToScalar(0);
  gathered->doImport(A, *import, Tpetra::REPLACE);
  gathered->fillComplete(gathered_map, gathered_map);
}

/// Rank 0. Rows are numbered as in gathered_map, columns by the row that has their id.
void Factorization::Impl::view_serially() {
  const auto self = Teuchos::rcp(new Teuchos::SerialComm<int>);
  const auto rows = Teuchos::rcp(new Map(local_size(*gathered_map), 0, self));
  const Map& columns = *gathered->getColMap();
  std::vector<GlobalIndex> row_of_column(local_size(columns));
  for (LocalIndex j = 0; j < local_size(columns); ++j) row_of_column[j] = gathered_map->getLocalElement(columns.getGlobalElement(j));
  const auto column_map = Teuchos::rcp(
      new Map(row_of_column.size(), Teuchos::ArrayView<const GlobalIndex>(row_of_column.data(), row_of_column.size()), 0, self));
  serial = Teuchos::rcp(new Matrix(gathered->getLocalMatrixDevice(), rows, column_map, rows, rows));
}

/// Rank 0. Throws std::exception where Amesos2 does.
void Factorization::Impl::factorize() {
  if (lu.is_null()) {
    lu = Amesos2::create<Matrix, MultiVector>("KLU2", serial);
    lu->symbolicFactorization();
    ++symbolic_setups;
  } else {
    lu->setA(serial, Amesos2::SYMBFACT);
  }
  lu->numericFactorization();
}

/// Rank 0. Factors of a singular matrix may look harmless, since rounding hides the zero pivot. So take v with v_j = ±1/max_i |a_ij| (which
/// makes columns of all sizes count), solve A y = A v and return max_j |y_j - v_j| / |v_j|, about machine precision × condition number.
double Factorization::Impl::error_of_known_solution() const {
  const std::vector<double> scale = column_scales(*serial);
  const auto y = Teuchos::rcp(new Vector(serial->getRowMap())), w = Teuchos::rcp(new Vector(serial->getRowMap()));
  Vector v(serial->getRowMap());
  {
    const auto v_view = host_overwrite(v);
    for (std::size_t j = 0; j < scale.size(); ++j) {
      const auto row = static_cast<LocalIndex>(serial->getColMap()->getGlobalElement(static_cast<LocalIndex>(j)));
      v_view(row) = (row % 3 == 0 ? -1 : 1) / scale[j];
    }
  }
  serial->apply(v, *w);
  lu->setX(y);
  lu->setB(w);
  lu->solve();
  const auto y_view = host_view(static_cast<const Vector&>(*y));
  const auto v_view = host_view(static_cast<const Vector&>(v));
  double error = 0;
  for (LocalIndex i = 0; i < local_rows(*serial); ++i) {
    const double e = std::abs(y_view(i) / v_view(i) - 1);
    if (!(e <= error)) error = e;
  }
  return error;
}

void Factorization::set_matrix(const Teuchos::RCP<const Matrix>& A) {
  Impl& f = *impl_;
  if (f.graph.get() != A->getCrsGraph().get()) f.gather_graph(A);
  f.gather_values(*A);

  const core::Comm comm = comm_of(*A->getRowMap());
  std::optional<std::string> failure;
  if (comm.root()) {
    try {
      f.view_serially();
      f.factorize();
      if (const double error = f.error_of_known_solution(); !(error < hopeless_error))
        failure = fmt::format("a solution that is known comes out with a relative error of {:.1e}", error);
    } catch (const std::exception& exception) {
      failure = said_by(exception);
    }
  }
  comm.broadcast(f.symbolic_setups);
  break_down_together(comm, "the matrix is singular", failure);
}

void Factorization::solve(const Vector& b, Vector& x) const {
  const Impl& f = *impl_;
  Vector gathered_b(f.gathered_map), gathered_x(f.gathered_map);
  gathered_b.doImport(b, *f.import, Tpetra::INSERT);
  if (!f.lu.is_null()) {
    const auto serial_b = Teuchos::rcp(new Vector(f.serial->getRowMap())), serial_x = Teuchos::rcp(new Vector(f.serial->getRowMap()));
    Kokkos::deep_copy(host_overwrite(*serial_b), host_view(static_cast<const Vector&>(gathered_b)));
    f.lu->setX(serial_x);
    f.lu->setB(serial_b);
    f.lu->solve();
    Kokkos::deep_copy(host_overwrite(gathered_x), host_view(static_cast<const Vector&>(*serial_x)));
  }
  x.doExport(gathered_x, *f.import, Tpetra::INSERT);
}

}  // namespace thixis::algebra
