#include "thixis/contact/linearized_system.hpp"
#include "transformed.hpp"

namespace thixis::contact {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using Execution = algebra::Matrix::execution_space;
using Range = Kokkos::RangePolicy<Execution>;
using Indices = Kokkos::View<const LocalIndex*>;

/// Where the unknowns of a node stand, interlaced: its fields, and its multipliers behind them if a contact point lies there.
struct Places {
  int fields, gaps;
  Indices first;  ///< of each node, ghosts included: the local index of its first unknown
  Indices point;  ///< of each node of this rank: its contact point, or -1
  KOKKOS_INLINE_FUNCTION LocalIndex operator()(LocalIndex node, int unknown) const { return first(node) + unknown; }
  KOKKOS_INLINE_FUNCTION int unknowns(LocalIndex node) const { return fields + (point(node) >= 0 ? gaps : 0); }
};

/// Which fields act on which.
struct Couplings {
  bool acts[most_fields][most_fields] = {};
  explicit Couplings(const BlockOperator& S) {
    for (const Small& c : S.weight)
      for (int i = 0; i < S.fields; ++i)
        for (int j = 0; j < S.fields; ++j) acts[i][j] = acts[i][j] || i == j || c(i, j) != 0;
  }
};

/// f(column, entry, field, other) for the columns of row (l, field) in their order: those of S that act on the field; at its own node all
/// unknowns if there is a contact point. entry: of S, or of none.
template <class F>
KOKKOS_INLINE_FUNCTION void for_each_column(const LocalMatrix& S, const Places& at, const Couplings& couplings, LocalIndex l, int field,
                                            const F& f) {
  for (std::size_t e = S.graph.row_map(l); e < S.graph.row_map(l + 1); ++e) {
    const LocalIndex m = S.graph.entries(e);
    const bool whole = m == l && at.point(l) >= 0;
    for (int other = 0; other < at.fields + (whole ? at.gaps : 0); ++other)
      if (whole || couplings.acts[field][other]) f(m, e, other);
  }
}

template <class RowMap>
struct Count {
  LocalMatrix S;
  Places at;
  Couplings couplings;
  RowMap length;

  KOKKOS_FUNCTION void operator()(LocalIndex l) const {
    for (int field = 0; field < at.fields; ++field) {
      std::size_t count = 0;
      for_each_column(S, at, couplings, l, field, [&](LocalIndex, std::size_t, int) { ++count; });
      length(at(l, field)) = count;
    }
    for (int unknown = at.fields; unknown < at.unknowns(l); ++unknown) length(at(l, unknown)) = at.unknowns(l);
  }
};

template <class RowMap, class Entries>
struct Pattern {
  LocalMatrix S;
  Places at;
  Couplings couplings;
  RowMap row_map;
  Entries entries;

  KOKKOS_FUNCTION void operator()(LocalIndex l) const {
    for (int field = 0; field < at.fields; ++field) {
      std::size_t to = row_map(at(l, field));
      for_each_column(S, at, couplings, l, field, [&](LocalIndex m, std::size_t, int other) { entries(to++) = at(m, other); });
    }
    for (int unknown = at.fields; unknown < at.unknowns(l); ++unknown) {
      std::size_t to = row_map(at(l, unknown));
      for (int other = 0; other < at.unknowns(l); ++other) entries(to++) = at(l, other);
    }
  }
};

template <class View>
struct Fill {
  LocalMatrix S[most_matrices];
  Small c[most_matrices];
  int matrices;
  Places at;
  Couplings couplings;
  Frames frames;
  double weight[most_fields], contact_weight;
  View D, a, b, kappa;
  LocalMatrix A;  ///< out, overwritten

  KOKKOS_FUNCTION double block(std::size_t e, int i, int j) const {
    double value = 0;
    for (int k = 0; k < matrices; ++k) value += c[k](i, j) * S[k].values(e);
    return value;
  }
  KOKKOS_FUNCTION void operator()(LocalIndex l) const {
    const int m = at.fields, means = m - at.gaps;
    const LocalIndex p = at.point(l);
    const Small& Q = frames.inverse(frames.at(l));
    for (int field = 0; field < m; ++field) {
      std::size_t to = A.graph.row_map(at(l, field));
      for_each_column(S[0], at, couplings, l, field, [&](LocalIndex, std::size_t e, int other) {
        A.values(to++) = weight[field] * (other < m ? block(e, field, other) : -Q(means + other - m, field) * D(p, 0));
      });
    }
    for (int g = 0; m + g < at.unknowns(l); ++g) {
      const double w = contact_weight * kappa(p, g);
      std::size_t to = A.graph.row_map(at(l, m + g));
      for (int field = 0; field < m; ++field) A.values(to++) = w * a(p, g) * Q(means + g, field);
      for (int other = 0; other < at.gaps; ++other) A.values(to++) = other == g ? w * b(p, g) : 0;
    }
  }
};

class FullSystem final : public LinearizedSystem {
 public:
  FullSystem(const System& system, const Weights& weights, const algebra::LinearParams& params, const algebra::Nodes& nodes)
      : system_(system),
        weights_(weights),
        nodes_(nodes),
        couplings_(system.S),
        places_(make_places()),
        map_(make_map(system.map())),
        solver_(params),
        A_(Teuchos::rcp(new algebra::Matrix(make_graph()))),
        rhs_(map_),
        x_(map_) {
    A_->fillComplete();
  }

  void linearize(const Vector& a, const Vector& b) override {
    const auto read = [](const MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadOnly); };
    const MultiVector a_gaps = gaps(system_, a), b_gaps = gaps(system_, b);
    const auto D = read(*system_.constraint.pairing);
    Fill<std::decay_t<decltype(D)>> fill{{}, {}, static_cast<int>(system_.S.matrix.size()), places_, couplings_, system_.constraint.frames};
    for (int k = 0; k < fill.matrices; ++k) {
      fill.S[k] = system_.S.matrix[k]->getLocalMatrixDevice();
      fill.c[k] = system_.S.weight[k];
    }
    for (int field = 0; field < system_.fields(); ++field) fill.weight[field] = weights_.field[field];
    fill.contact_weight = weights_.contact;
    fill.D = D;
    fill.a = read(a_gaps);
    fill.b = read(b_gaps);
    fill.kappa = read(*weights_.stiffness);
    fill.A = A_->getLocalMatrixDevice();
    Kokkos::parallel_for("thixis::contact::full_system", Range(0, fill.S[0].numRows()), fill);
    solver_.set_matrix(A_, system_.fields() + system_.gaps(), nodes_);
  }

  algebra::LinearReport solve(const Vector& R, Vector& dX, const algebra::LinearStop& stop) override {
    set_right_side(R);
    x_.putScalar(0);
    algebra::LinearStop inner = stop;
    if (stop.criterion)
      inner.criterion = [&](const Vector& x, int i, double residual) {
        to_columns(x, dX);
        return stop.criterion(dX, i, residual);
      };
    const auto report = solver_.solve(rhs_, x_, inner);
    to_columns(x_, dX);
    return report;
  }

  GlobalIndex nonzeros() const override { return static_cast<GlobalIndex>(A_->getGlobalNumEntries()); }

 private:
  LocalIndex nodes() const { return algebra::local_size(*system_.map()); }

  Places make_places() const {
    const LocalIndex columns = algebra::local_columns(*system_.S.matrix[0]), rows = nodes();
    const Kokkos::View<LocalIndex*> first("thixis::contact::first", columns + 1);
    const Indices point = points_of_nodes(system_);
    const int fields = system_.fields(), gaps = system_.gaps();
    // of ghosts, the multipliers stand in no row of this rank
    Kokkos::parallel_scan(
        "thixis::contact::places", Range(0, columns + 1), KOKKOS_LAMBDA(int l, LocalIndex& sum, bool final) {
          if (final) first(l) = sum;
          sum += fields + (l < rows && point(l) >= 0 ? gaps : 0);
        });
    return {fields, gaps, first, point};
  }

  /// The unknowns of node g are (m + q) g, …; multipliers that are not there leave out their ids.
  algebra::MapPtr make_map(const algebra::MapPtr& of_nodes) const {
    const auto point = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), places_.point);
    const int all = places_.fields + places_.gaps;
    std::vector<GlobalIndex> ids;
    ids.reserve(static_cast<std::size_t>(all) * algebra::local_size(*of_nodes));
    for (LocalIndex l = 0; l < algebra::local_size(*of_nodes); ++l)
      for (int unknown = 0; unknown < (l < nodes() && point(l) >= 0 ? all : places_.fields); ++unknown)
        ids.push_back(all * of_nodes->getGlobalElement(l) + unknown);
    return algebra::map_of(ids, algebra::comm_of(*of_nodes));
  }

  algebra::GraphPtr make_graph() const {
    using LocalGraph = algebra::Graph::local_graph_device_type;
    using RowMap = LocalGraph::row_map_type::non_const_type;
    const LocalMatrix S = system_.S.matrix[0]->getLocalMatrixDevice();
    const LocalIndex rows = algebra::local_size(*map_);
    const RowMap length("thixis::contact::length", rows), row_map("thixis::contact::row_map", rows + 1);
    Kokkos::parallel_for("thixis::contact::count", Range(0, S.numRows()), Count<RowMap>{S, places_, couplings_, length});
    Kokkos::parallel_scan(
        "thixis::contact::rows", Range(0, rows + 1), KOKKOS_LAMBDA(int row, std::size_t& sum, bool final) {
          if (final) row_map(row) = sum;
          if (row < rows) sum += length(row);
        });
    std::size_t total = 0;
    Kokkos::deep_copy(total, Kokkos::subview(row_map, rows));
    const LocalGraph::entries_type::non_const_type entries("thixis::contact::entries", total);
    Kokkos::parallel_for("thixis::contact::full_pattern", Range(0, S.numRows()),
                         Pattern<RowMap, std::decay_t<decltype(entries)>>{S, places_, couplings_, row_map, entries});
    return algebra::make_graph(map_, make_map(system_.S.matrix[0]->getColMap()), row_map, entries);
  }

  /// -R, weighted and interlaced.
  void set_right_side(const Vector& R) {
    const MultiVector r_fields = fields(system_, R), r_gaps = multipliers(system_, R);
    const auto r = r_fields.getLocalViewDevice(Tpetra::Access::ReadOnly), C = r_gaps.getLocalViewDevice(Tpetra::Access::ReadOnly),
               kappa = weights_.stiffness->getLocalViewDevice(Tpetra::Access::ReadOnly);
    const auto out = rhs_.getLocalViewDevice(Tpetra::Access::OverwriteAll);
    const Places at = places_;
    Small weight;
    for (int field = 0; field < at.fields; ++field) weight(0, field) = weights_.field[field];
    const double of_contact = weights_.contact;
    Kokkos::parallel_for(
        "thixis::contact::full_right_side", Range(0, nodes()), KOKKOS_LAMBDA(int l) {
          for (int field = 0; field < at.fields; ++field) out(at(l, field), 0) = -weight(0, field) * r(l, field);
          const LocalIndex p = at.point(l);
          for (int g = 0; at.fields + g < at.unknowns(l); ++g) out(at(l, at.fields + g), 0) = -of_contact * kappa(p, g) * C(p, g);
        });
  }

  void to_columns(const Vector& x, Vector& X) const {
    MultiVector u_columns = fields_nonconst(system_, X), lambda_columns = multipliers_nonconst(system_, X);
    const auto in = x.getLocalViewDevice(Tpetra::Access::ReadOnly);
    const auto u = u_columns.getLocalViewDevice(Tpetra::Access::OverwriteAll),
               lambda = lambda_columns.getLocalViewDevice(Tpetra::Access::OverwriteAll);
    const Places at = places_;
    Kokkos::parallel_for(
        "thixis::contact::to_columns", Range(0, nodes()), KOKKOS_LAMBDA(int l) {
          for (int field = 0; field < at.fields; ++field) u(l, field) = in(at(l, field), 0);
          const LocalIndex p = at.point(l);
          for (int g = 0; at.fields + g < at.unknowns(l); ++g) lambda(p, g) = in(at(l, at.fields + g), 0);
        });
  }

  const System& system_;
  const Weights& weights_;
  algebra::Nodes nodes_;
  Couplings couplings_;
  Places places_;
  algebra::MapPtr map_;
  algebra::Solver solver_;
  algebra::MatrixPtr A_;
  Vector rhs_, x_;
};

}  // namespace

std::unique_ptr<LinearizedSystem> make_full_system(const System& system, const Weights& weights, const algebra::LinearParams& params,
                                                   const algebra::Nodes& nodes) {
  return std::make_unique<FullSystem>(system, weights, params, nodes);
}

}  // namespace thixis::contact
