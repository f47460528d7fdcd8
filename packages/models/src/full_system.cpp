#include "full_system.hpp"

namespace thixis::models {
namespace {

using LocalMatrix = algebra::Matrix::local_matrix_device_type;
using Execution = algebra::Matrix::execution_space;

/// Where row (l, field) begins. Rows of u_alpha hold those of S, and at contact points the fields of the node; rows of lambda those only.
template <class RowMap>
KOKKOS_INLINE_FUNCTION std::size_t row_begin(const Layout& at, const RowMap& row_map, LocalIndex l, int field) {
  const std::size_t before = row_map(l), length = row_map(l + 1) - before, m = at.membranes;
  const std::size_t points_before = l < at.points ? l : at.points, more = l < at.points ? m : 0;
  return m * before + (m * m + m + 1) * points_before + field * (length + more);
}

template <class RowMapOut, class EntriesOut>
struct Pattern {
  LocalMatrix S;
  Layout at;
  RowMapOut row_map;
  EntriesOut entries;

  KOKKOS_FUNCTION void operator()(LocalIndex l) const {
    const bool point = l < at.points;
    const int m = at.membranes, fields = point ? m + 1 : m;
    std::size_t k = 0;
    for (int field = 0; field < fields; ++field) {
      k = row_begin(at, S.graph.row_map, l, field);
      row_map(at(l, field)) = k;
      if (field == m) {
        for (int other = 0; other < fields; ++other) entries(k++) = at(l, other);
        continue;
      }
      for (std::size_t e = S.graph.row_map(l); e < S.graph.row_map(l + 1); ++e) {
        const LocalIndex node = S.graph.entries(e);
        if (node == l && point)
          for (int other = 0; other < fields; ++other) entries(k++) = at(l, other);
        else entries(k++) = at(node, field);
      }
    }
    if (l + 1 == S.numRows()) row_map(at(l, fields)) = k;
  }
};

template <class Values>
struct Fill {
  LocalMatrix S[2];
  double factor[2];
  Layout at;
  double weight[2], contact_weight;
  Values D, a, b, kappa;
  LocalMatrix A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex l) const {
    const bool point = l < at.points;
    const int m = at.membranes;
    const auto& row_map = S[0].graph.row_map;
    for (int field = 0; field < m; ++field) {
      std::size_t k = row_begin(at, row_map, l, field);
      for (std::size_t e = row_map(l); e < row_map(l + 1); ++e) {
        const double value = weight[field] * factor[field] * S[field].values(e);
        if (S[0].graph.entries(e) != l || !point) {
          A.values(k++) = value;
          continue;
        }
        for (int other = 0; other < m; ++other) A.values(k++) = other == field ? value : 0;
        A.values(k++) = weight[field] * (field == 0 ? -D(l, 0) : D(l, 0));
      }
    }
    if (!point) return;
    std::size_t k = row_begin(at, row_map, l, m);
    const double w = contact_weight * kappa(l, 0);
    for (int field = 0; field < m; ++field) A.values(k++) = w * (field == 0 ? a(l, 0) : -a(l, 0));
    A.values(k) = w * b(l, 0);
  }
};

class FullSystem final : public LinearizedSystem {
 public:
  FullSystem(const MembraneOperator& membranes, const MembraneMeasure& measure, const algebra::LinearParams& params,
             const algebra::MapPtr& map, const Teuchos::RCP<const algebra::MultiVector>& coordinates)
      : membranes_(membranes),
        measure_(measure),
        coordinates_(coordinates),
        solver_(params),
        A_(Teuchos::rcp(new algebra::Matrix(make_graph(map)))) {
    A_->fillComplete();
  }

  void linearize(const algebra::Vector& a, const algebra::Vector& b) override {
    const auto read = [](const algebra::Vector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadOnly); };
    const auto D = read(*membranes_.pairing);
    Fill<decltype(D)> fill{{},
                           {membranes_.factor[0], membranes_.factor[1]},
                           layout(membranes_),
                           {measure_.weight(0), measure_.weight(1)},
                           measure_.contact_weight(),
                           D,
                           read(a),
                           read(b),
                           read(measure_.stiffness()),
                           A_->getLocalMatrixDevice()};
    for (int alpha = 0; alpha < membranes_.count; ++alpha) fill.S[alpha] = membranes_.matrix[alpha]->getLocalMatrixDevice();
    Kokkos::parallel_for("thixis::models::full_system", Kokkos::RangePolicy<Execution>(0, fill.S[0].numRows()), fill);
    solver_.set_matrix(A_, membranes_.count + 1, coordinates_);
  }

  algebra::LinearReport solve(const algebra::Vector& R, algebra::Vector& dX, const algebra::LinearStop& stop) override {
    Fields minus_R(membranes_, R);
    for (int alpha = 0; alpha < membranes_.count; ++alpha) minus_R.u.getVectorNonConst(alpha)->scale(-measure_.weight(alpha));
    minus_R.lambda.elementWiseMultiply(-measure_.contact_weight(), measure_.stiffness(), minus_R.lambda, 0);
    algebra::Vector right_side(R.getMap());
    join(minus_R, right_side);
    dX.putScalar(0);
    return solver_.solve(right_side, dX, stop);
  }

  GlobalIndex nonzeros() const override { return A_->getGlobalNumEntries(); }

 private:
  algebra::GraphPtr make_graph(const algebra::MapPtr& map) const {
    const LocalMatrix S = membranes_.matrix[0]->getLocalMatrixDevice();
    const Layout at = layout(membranes_);
    using LocalGraph = algebra::Graph::local_graph_device_type;
    const std::size_t m = at.membranes;
    LocalGraph::row_map_type::non_const_type row_map("thixis::models::row_map", m * S.numRows() + at.points + 1);
    LocalGraph::entries_type::non_const_type entries("thixis::models::entries", m * S.nnz() + (m * m + m + 1) * at.points);
    Kokkos::parallel_for("thixis::models::full_pattern", Kokkos::RangePolicy<Execution>(0, S.numRows()),
                         Pattern<decltype(row_map), decltype(entries)>{S, at, row_map, entries});
    // of ghosts, the multiplier stands in no row of this rank
    return algebra::make_graph(map, algebra::interlaced(membranes_.matrix[0]->getColMap(), membranes_.count + 1, at.points), row_map,
                               entries);
  }

  const MembraneOperator& membranes_;
  const MembraneMeasure& measure_;
  Teuchos::RCP<const algebra::MultiVector> coordinates_;
  algebra::Solver solver_;
  algebra::MatrixPtr A_;
};

}  // namespace

std::unique_ptr<LinearizedSystem> make_full_system(const MembraneOperator& membranes, const MembraneMeasure& measure,
                                                   const algebra::LinearParams& params, const algebra::MapPtr& map,
                                                   const Teuchos::RCP<const algebra::MultiVector>& coordinates) {
  return std::make_unique<FullSystem>(membranes, measure, params, map, coordinates);
}

}  // namespace thixis::models
