#include "full_system.hpp"

namespace thixis::models {
namespace {

using LocalMatrix = algebra::Matrix::local_matrix_device_type;
using Execution = algebra::Matrix::execution_space;

/// Where row (l, field) begins: S has row_map(l) entries before row l; u-rows hold those of S and two more, lambda-rows three.
template <class RowMap>
KOKKOS_INLINE_FUNCTION std::size_t row_begin(const RowMap& row_map, LocalIndex l, int field) {
  const std::size_t before = row_map(l), length = row_map(l + 1) - before;
  return 2 * before + 7 * static_cast<std::size_t>(l) + field * (length + 2);
}

template <class RowMapOut, class EntriesOut>
struct Pattern {
  LocalMatrix S;
  LocalIndex rows;
  RowMapOut row_map;
  EntriesOut entries;

  KOKKOS_FUNCTION void operator()(LocalIndex l) const {
    for (int field = 0; field < 3; ++field) {
      std::size_t k = row_begin(S.graph.row_map, l, field);
      row_map(3 * l + field) = k;
      if (field == 2) {
        for (int other = 0; other < 3; ++other) entries(k++) = 3 * l + other;
        if (l + 1 == rows) row_map(3 * rows) = k;
        continue;
      }
      for (std::size_t e = S.graph.row_map(l); e < S.graph.row_map(l + 1); ++e) {
        const LocalIndex m = S.graph.entries(e);
        if (m == l)
          for (int other = 0; other < 3; ++other) entries(k++) = 3 * l + other;
        else entries(k++) = 3 * m + field;
      }
    }
  }
};

template <class Values>
struct Fill {
  LocalMatrix S[2];
  double factor[2];
  Values D, a, b;
  LocalMatrix A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex l) const {
    for (int field = 0; field < 2; ++field) {
      std::size_t k = row_begin(S[0].graph.row_map, l, field);
      for (std::size_t e = S[0].graph.row_map(l); e < S[0].graph.row_map(l + 1); ++e) {
        const double value = factor[field] * S[field].values(e);
        if (S[0].graph.entries(e) == l) {
          A.values(k++) = field == 0 ? value : 0;
          A.values(k++) = field == 1 ? value : 0;
          A.values(k++) = field == 0 ? -D(l, 0) : D(l, 0);
        } else {
          A.values(k++) = value;
        }
      }
    }
    const std::size_t k = row_begin(S[0].graph.row_map, l, 2);
    A.values(k) = a(l, 0);
    A.values(k + 1) = -a(l, 0);
    A.values(k + 2) = b(l, 0);
  }
};

class FullSystem final : public LinearizedSystem {
 public:
  FullSystem(const MembraneOperator& membranes, const algebra::LinearParams& params, const algebra::MapPtr& map,
             const Teuchos::RCP<const algebra::MultiVector>& coordinates)
      : membranes_(membranes), coordinates_(coordinates), solver_(params), A_(Teuchos::rcp(new algebra::Matrix(make_graph(map)))) {
    A_->fillComplete();
  }

  void linearize(const algebra::Vector& a, const algebra::Vector& b) override {
    const auto D = membranes_.pairing->getLocalViewDevice(Tpetra::Access::ReadOnly);
    const Fill<decltype(D)> fill{{membranes_.matrix[0]->getLocalMatrixDevice(), membranes_.matrix[1]->getLocalMatrixDevice()},
                                 {membranes_.factor[0], membranes_.factor[1]},
                                 D,
                                 a.getLocalViewDevice(Tpetra::Access::ReadOnly),
                                 b.getLocalViewDevice(Tpetra::Access::ReadOnly),
                                 A_->getLocalMatrixDevice()};
    Kokkos::parallel_for("thixis::models::full_system", Kokkos::RangePolicy<Execution>(0, D.extent_int(0)), fill);
    solver_.set_matrix(A_, 3, coordinates_);
  }

  algebra::LinearReport solve(const algebra::Vector& R, algebra::Vector& dX, const algebra::LinearStop& stop) override {
    algebra::Vector minus_R(R, Teuchos::Copy);
    minus_R.scale(-1);
    dX.putScalar(0);
    return solver_.solve(minus_R, dX, stop);
  }

  GlobalIndex rows() const override { return A_->getGlobalNumRows(); }
  GlobalIndex nonzeros() const override { return A_->getGlobalNumEntries(); }

 private:
  algebra::GraphPtr make_graph(const algebra::MapPtr& map) const {
    const LocalMatrix S = membranes_.matrix[0]->getLocalMatrixDevice();
    using LocalGraph = algebra::Graph::local_graph_device_type;
    const LocalIndex rows = S.numRows();
    LocalGraph::row_map_type::non_const_type row_map("thixis::models::row_map", 3 * static_cast<std::size_t>(rows) + 1);
    LocalGraph::entries_type::non_const_type entries("thixis::models::entries", 2 * S.nnz() + 7 * static_cast<std::size_t>(rows));
    Kokkos::parallel_for("thixis::models::full_pattern", Kokkos::RangePolicy<Execution>(0, rows),
                         Pattern<decltype(row_map), decltype(entries)>{S, rows, row_map, entries});
    return algebra::make_graph(map, algebra::interlaced(membranes_.matrix[0]->getColMap(), 3), row_map, entries);
  }

  const MembraneOperator& membranes_;
  Teuchos::RCP<const algebra::MultiVector> coordinates_;
  algebra::Solver solver_;
  algebra::MatrixPtr A_;
};

}  // namespace

std::unique_ptr<LinearizedSystem> make_full_system(const MembraneOperator& membranes, const algebra::LinearParams& params,
                                                   const algebra::MapPtr& map,
                                                   const Teuchos::RCP<const algebra::MultiVector>& coordinates) {
  return std::make_unique<FullSystem>(membranes, params, map, coordinates);
}

}  // namespace thixis::models
