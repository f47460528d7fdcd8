#include "reduced_system.hpp"

#include <cmath>

namespace thixis::models {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using LocalMatrix = algebra::Matrix::local_matrix_device_type;
using Execution = algebra::Matrix::execution_space;
using Range = Kokkos::RangePolicy<Execution>;

constexpr double contact_ratio = 1e10;

auto input(const MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadOnly); }
auto output(MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadWrite); }

/// What both reduced forms share: the contact set, the known part of dz, and the way back to (d1, d2, dlambda).
class ReducedSystem : public LinearizedSystem {
 public:
  ReducedSystem(const MembraneOperator& membranes)
      : membranes_(membranes),
        diagonal_(membranes.map()),
        penalty_(membranes.map()),
        contact_(membranes.map()),
        contact_columns_(membranes.matrix[0]->getColMap()),
        a_(membranes.map()),
        b_(membranes.map()) {
    Vector one(membranes.map());
    for (int alpha = 0; alpha < 2; ++alpha) {
      membranes.matrix[alpha]->getLocalDiagCopy(one);
      const double theta = membranes.theta[1 - alpha];
      diagonal_.update(theta * theta * membranes.factor[alpha], one, 1);
    }
  }

  void linearize(const Vector& a, const Vector& b) final {
    a_.assign(a);
    b_.assign(b);
    {
      const auto D = input(*membranes_.pairing), diagonal = input(diagonal_), a_l = input(a_), b_l = input(b_);
      const auto contact = output(contact_), penalty = output(penalty_);
      Kokkos::parallel_for(
          "thixis::models::contact", Range(0, D.extent_int(0)), KOKKOS_LAMBDA(int l) {
            const double held = D(l, 0) * a_l(l, 0), flexible = contact_ratio * diagonal(l, 0) * b_l(l, 0);
            contact(l, 0) = held * held >= flexible * flexible ? 1 : 0;
            penalty(l, 0) = contact(l, 0) > 0 ? 0 : D(l, 0) * a_l(l, 0) / b_l(l, 0);
          });
    }
    import_columns(contact_, contact_columns_);
    set_matrix();
  }

  algebra::LinearReport solve(const Vector& R, Vector& dX, const algebra::LinearStop& stop) final {
    const auto map = membranes_.map();
    MultiVector fields(map, 3);
    split(R, fields);

    // known dz at contact, right-hand sides
    Vector dw(map), dz(map), r_w(map), r_z(map);
    const double theta1 = membranes_.theta[0], theta2 = membranes_.theta[1];
    r_w.update(1, *fields.getVector(0), 1, *fields.getVector(1), 0);
    r_z.update(theta2, *fields.getVector(0), -theta1, *fields.getVector(1), 0);
    {
      const auto C = input(*fields.getVector(2)), a = input(a_), contact = input(contact_);
      const auto known = output(dz);
      Kokkos::parallel_for(
          "thixis::models::known_gap", Range(0, known.extent_int(0)),
          KOKKOS_LAMBDA(int l) { known(l, 0) = contact(l, 0) > 0 ? -C(l, 0) / a(l, 0) : 0; });
    }
    const auto recover = [&](const Vector& w, const Vector& z, Vector& X) { this->recover(fields, r_z, w, z, X); };
    const auto report = solve_reduced(fields, r_w, r_z, dw, dz, stop, recover);
    recover(dw, dz, dX);
    return report;
  }

 protected:
  using Recover = std::function<void(const Vector& dw, const Vector& dz, Vector& dX)>;

  virtual void set_matrix() = 0;
  virtual algebra::LinearReport solve_reduced(const MultiVector& R, const Vector& r_w, const Vector& r_z, Vector& dw, Vector& dz,
                                              const algebra::LinearStop& stop, const Recover& recover) = 0;

  void import_columns(const Vector& from, Vector& to) const {
    const auto import = membranes_.matrix[0]->getGraph()->getImporter();
    if (import.is_null()) to.assign(from);
    else to.doImport(from, *import, Tpetra::INSERT);
  }

  /// y <- factor1 c1 S1 x + factor2 c2 S2 x.
  void apply(double c1, double c2, const Vector& x, Vector& y) const {
    const double f1 = c1 * membranes_.factor[0], f2 = c2 * membranes_.factor[1];
    if (membranes_.shared()) return membranes_.matrix[0]->apply(x, y, Teuchos::NO_TRANS, f1 + f2, 0);
    membranes_.matrix[0]->apply(x, y, Teuchos::NO_TRANS, f1, 0);
    membranes_.matrix[1]->apply(x, y, Teuchos::NO_TRANS, f2, 1);
  }

  /// Right-hand side of the z-rows, given coupling·dz of the known dz: -r_z - D C/b - known at free points, diag·dz at contact.
  void right_side_z(const MultiVector& R, const Vector& r_z, const Vector& dz, const Vector& coupled, Vector& rhs) const {
    const auto C = input(*R.getVector(2)), r = input(r_z), known = input(dz), y = input(coupled);
    const auto D = input(*membranes_.pairing), b = input(b_), contact = input(contact_), diagonal = input(diagonal_);
    const auto out = output(rhs);
    Kokkos::parallel_for(
        "thixis::models::right_side_z", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int l) {
          out(l, 0) = contact(l, 0) > 0 ? diagonal(l, 0) * known(l, 0) : -r(l, 0) - D(l, 0) * C(l, 0) / b(l, 0) - y(l, 0);
        });
  }

  /// d1 = dw + theta2 dz, d2 = dw - theta1 dz; dlambda = -(C + a dz)/b, at contact D dlambda = r_z + theta2 S1 d1 - theta1 S2 d2.
  void recover(const MultiVector& R, const Vector& r_z, const Vector& dw, const Vector& dz, Vector& dX) const {
    const double theta1 = membranes_.theta[0], theta2 = membranes_.theta[1];
    MultiVector d(membranes_.map(), 3);
    d.getVectorNonConst(0)->update(1, dw, theta2, dz, 0);
    d.getVectorNonConst(1)->update(1, dw, -theta1, dz, 0);
    Vector y1(membranes_.map()), y2(membranes_.map());
    apply(theta2, 0, *d.getVector(0), y1);
    apply(0, -theta1, *d.getVector(1), y2);
    {
      const auto C = input(*R.getVector(2)), r = input(r_z), gap = input(dz), force1 = input(y1), force2 = input(y2);
      const auto D = input(*membranes_.pairing), a = input(a_), b = input(b_), contact = input(contact_);
      const auto out = output(*d.getVectorNonConst(2));
      Kokkos::parallel_for(
          "thixis::models::recover", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int l) {
            out(l, 0) = contact(l, 0) > 0 ? (r(l, 0) + force1(l, 0) + force2(l, 0)) / D(l, 0) : -(C(l, 0) + a(l, 0) * gap(l, 0)) / b(l, 0);
          });
    }
    join(d, dX);
  }

  const MembraneOperator& membranes_;
  Vector diagonal_;                   ///< of theta2² S1 + theta1² S2
  Vector penalty_;                    ///< D a/b at free points
  Vector contact_, contact_columns_;  ///< 1 at contact, 0 elsewhere
  Vector a_, b_;
};

/// Values of the z-matrix, rows and columns of contact points cleared but for the diagonal.
template <class V>
struct FillGap {
  LocalMatrix S;
  double kappa;
  V contact, penalty;
  LocalMatrix A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex l) const {
    for (std::size_t e = S.graph.row_map(l); e < S.graph.row_map(l + 1); ++e) {
      const LocalIndex m = S.graph.entries(e);
      const double value = kappa * S.values(e);
      if (m == l) A.values(e) = value + penalty(l, 0);
      else A.values(e) = contact(l, 0) > 0 || contact(m, 0) > 0 ? 0 : value;
    }
  }
};

/// Constant tensions: (mu1 + mu2) S dw = -r_w once and for all, kappa S dz + … = …, kappa = mu1 mu2 / (mu1 + mu2).
class DecoupledSystem final : public ReducedSystem {
 public:
  DecoupledSystem(const MembraneOperator& membranes, const algebra::LinearParams& params,
                  const Teuchos::RCP<const MultiVector>& coordinates)
      : ReducedSystem(membranes),
        coordinates_(coordinates),
        mean_(params),
        gap_(params),
        A_(Teuchos::rcp(new algebra::Matrix(membranes.matrix[0]->getCrsGraph()))),
        sum_(membranes.factor[0] + membranes.factor[1]),
        kappa_(membranes.factor[0] * membranes.factor[1] / sum_) {
    A_->fillComplete();
  }
  GlobalIndex rows() const override { return 2 * A_->getGlobalNumRows(); }
  GlobalIndex nonzeros() const override { return 2 * A_->getGlobalNumEntries(); }

 private:
  void set_matrix() override {
    const auto contact = input(contact_columns_), penalty = input(penalty_);
    Kokkos::parallel_for(
        "thixis::models::gap_matrix", Range(0, penalty.extent_int(0)),
        FillGap<decltype(contact)>{membranes_.matrix[0]->getLocalMatrixDevice(), kappa_, contact, penalty, A_->getLocalMatrixDevice()});
    gap_.set_matrix(A_, 1, coordinates_);
  }

  algebra::LinearReport solve_reduced(const MultiVector& R, const Vector& r_w, const Vector& r_z, Vector& dw, Vector& dz,
                                      const algebra::LinearStop& stop, const Recover& recover) override {
    // |r|² = |theta1 r_w + r_z|² + |theta2 r_w - r_z|² <= 5 max(|r_w|, |r_z|)²
    constexpr double share = 0.4;
    Vector coupled(membranes_.map()), rhs(membranes_.map());
    apply(membranes_.theta[1] * membranes_.theta[1], membranes_.theta[0] * membranes_.theta[0], dz, coupled);
    right_side_z(R, r_z, dz, coupled, rhs);

    algebra::LinearReport mean;
    mean.converged = true;
    mean.residual = r_w.norm2() / sum_;
    if (sum_ * mean.residual > share * stop.tolerance) {
      if (!mean_ready_) mean_.set_matrix(membranes_.matrix[0], 1, coordinates_);
      mean_ready_ = true;
      const double of_gap = algebra::residual(*A_, rhs, dz, coupled);
      Vector mean_rhs(r_w, Teuchos::Copy);
      mean_rhs.scale(-1 / sum_);
      algebra::LinearStop inner = stop;
      inner.tolerance = share * stop.tolerance / sum_;
      if (stop.criterion)
        inner.criterion = recovered(
            stop, recover, 0, [&](const Vector& x) { return std::pair(&x, &dz); }, [&](double r) { return std::hypot(sum_ * r, of_gap); });
      mean = mean_.solve(mean_rhs, dw, inner);
      if (!mean.converged) {
        mean.residual = std::hypot(sum_ * mean.residual, of_gap);
        return mean;
      }
    }

    algebra::LinearStop inner = stop;
    inner.tolerance = share * stop.tolerance;
    const double of_mean = sum_ * mean.residual;
    if (stop.criterion)
      inner.criterion = recovered(
          stop, recover, mean.iterations, [&](const Vector& x) { return std::pair(&dw, &x); },
          [&](double r) { return std::hypot(of_mean, r); });
    algebra::LinearReport gap = gap_.solve(rhs, dz, inner);
    gap.iterations += mean.iterations;
    gap.residual = std::hypot(gap.residual, of_mean);
    gap.by_criterion = gap.by_criterion || mean.by_criterion;
    return gap;
  }

  /// The criterion of the caller sees the full increment and the residual of both parts, whichever is being solved.
  template <class Parts, class Residual>
  std::function<bool(const Vector&, int, double)> recovered(const algebra::LinearStop& stop, const Recover& recover, int before,
                                                            Parts parts, Residual both) const {
    return [&stop, recover, before, parts, both, map = algebra::interlaced(membranes_.map(), 3)](const Vector& x, int i, double residual) {
      Vector dX(map);
      const auto [w, z] = parts(x);
      recover(*w, *z, dX);
      return stop.criterion(dX, before + i, both(residual));
    };
  }

  Teuchos::RCP<const MultiVector> coordinates_;
  algebra::Solver mean_, gap_;
  algebra::MatrixPtr A_;
  double sum_, kappa_;
  bool mean_ready_ = false;
};

template <class V>
struct FillCoupled {
  LocalMatrix S1, S2;
  double factor1, factor2, theta1, theta2;
  V contact, penalty;
  LocalMatrix A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex l) const {
    const std::size_t begin = S1.graph.row_map(l), end = S1.graph.row_map(l + 1);
    const std::size_t w_row = 4 * begin, z_row = w_row + 2 * (end - begin);
    for (std::size_t e = begin; e < end; ++e) {
      const LocalIndex m = S1.graph.entries(e);
      const double s1 = factor1 * S1.values(e), s2 = factor2 * S2.values(e);
      const double wz = theta2 * s1 - theta1 * s2, zz = theta2 * theta2 * s1 + theta1 * theta1 * s2;
      const bool row_known = contact(l, 0) > 0, column_known = contact(m, 0) > 0;
      const std::size_t k = 2 * (e - begin);
      A.values(w_row + k) = s1 + s2;
      A.values(w_row + k + 1) = column_known ? 0 : wz;
      A.values(z_row + k) = row_known ? 0 : wz;
      A.values(z_row + k + 1) = m == l ? zz + penalty(l, 0) : (row_known || column_known ? 0 : zz);
    }
  }
};

template <class RowMap, class Entries>
struct PatternCoupled {
  LocalMatrix S;
  LocalIndex rows;
  RowMap row_map;
  Entries entries;

  KOKKOS_FUNCTION void operator()(LocalIndex l) const {
    const std::size_t begin = S.graph.row_map(l), end = S.graph.row_map(l + 1);
    for (int field = 0; field < 2; ++field) {
      const std::size_t row = 4 * begin + field * 2 * (end - begin);
      row_map(2 * l + field) = row;
      for (std::size_t e = begin; e < end; ++e) {
        entries(row + 2 * (e - begin)) = 2 * S.graph.entries(e);
        entries(row + 2 * (e - begin) + 1) = 2 * S.graph.entries(e) + 1;
      }
    }
    if (l + 1 == rows) row_map(2 * rows) = 4 * end;
  }
};

/// Tensions that vary: one system for (w, z), interlaced.
class CoupledSystem final : public ReducedSystem {
 public:
  CoupledSystem(const MembraneOperator& membranes, const algebra::LinearParams& params, const Teuchos::RCP<const MultiVector>& coordinates)
      : ReducedSystem(membranes), coordinates_(coordinates), solver_(params), map_(algebra::interlaced(membranes.map(), 2)) {
    const LocalMatrix S = membranes.matrix[0]->getLocalMatrixDevice();
    using LocalGraph = algebra::Graph::local_graph_device_type;
    LocalGraph::row_map_type::non_const_type row_map("thixis::models::row_map", 2 * static_cast<std::size_t>(S.numRows()) + 1);
    LocalGraph::entries_type::non_const_type entries("thixis::models::entries", 4 * S.nnz());
    Kokkos::parallel_for("thixis::models::coupled_pattern", Range(0, S.numRows()),
                         PatternCoupled<decltype(row_map), decltype(entries)>{S, S.numRows(), row_map, entries});
    A_ = Teuchos::rcp(
        new algebra::Matrix(algebra::make_graph(map_, algebra::interlaced(membranes.matrix[0]->getColMap(), 2), row_map, entries)));
    A_->fillComplete();
  }
  GlobalIndex rows() const override { return A_->getGlobalNumRows(); }
  GlobalIndex nonzeros() const override { return A_->getGlobalNumEntries(); }

 private:
  void set_matrix() override {
    const auto contact = input(contact_columns_), penalty = input(penalty_);
    Kokkos::parallel_for(
        "thixis::models::coupled_matrix", Range(0, penalty.extent_int(0)),
        FillCoupled<decltype(contact)>{membranes_.matrix[0]->getLocalMatrixDevice(), membranes_.matrix[1]->getLocalMatrixDevice(),
                                       membranes_.factor[0], membranes_.factor[1], membranes_.theta[0], membranes_.theta[1], contact,
                                       penalty, A_->getLocalMatrixDevice()});
    solver_.set_matrix(A_, 2, coordinates_);
  }

  algebra::LinearReport solve_reduced(const MultiVector& R, const Vector& r_w, const Vector& r_z, Vector& dw, Vector& dz,
                                      const algebra::LinearStop& stop, const Recover& recover) override {
    const double theta1 = membranes_.theta[0], theta2 = membranes_.theta[1];
    Vector coupled(membranes_.map()), rhs(map_), x(map_);
    MultiVector parts(membranes_.map(), 2);
    apply(theta2 * theta2, theta1 * theta1, dz, coupled);
    right_side_z(R, r_z, dz, coupled, *parts.getVectorNonConst(1));
    apply(theta2, -theta1, dz, coupled);
    parts.getVectorNonConst(0)->update(-1, r_w, -1, coupled, 0);
    join(parts, rhs);
    parts.getVectorNonConst(0)->putScalar(0);
    parts.getVectorNonConst(1)->assign(dz);
    join(parts, x);

    algebra::LinearStop inner = stop;
    inner.tolerance = 0.4 * stop.tolerance;
    if (stop.criterion)
      inner.criterion = [&](const Vector& y, int i, double residual) {
        MultiVector d(membranes_.map(), 2);
        Vector dX(algebra::interlaced(membranes_.map(), 3));
        split(y, d);
        recover(*d.getVector(0), *d.getVector(1), dX);
        return stop.criterion(dX, i, residual);
      };
    const auto report = solver_.solve(rhs, x, inner);
    split(x, parts);
    dw.assign(*parts.getVector(0));
    dz.assign(*parts.getVector(1));
    return report;
  }

  Teuchos::RCP<const MultiVector> coordinates_;
  algebra::Solver solver_;
  algebra::MapPtr map_;
  algebra::MatrixPtr A_;
};

}  // namespace

std::unique_ptr<LinearizedSystem> make_reduced_system(const MembraneOperator& membranes, const algebra::LinearParams& params,
                                                      const Teuchos::RCP<const algebra::MultiVector>& coordinates) {
  if (membranes.shared()) return std::make_unique<DecoupledSystem>(membranes, params, coordinates);
  return std::make_unique<CoupledSystem>(membranes, params, coordinates);
}

}  // namespace thixis::models
