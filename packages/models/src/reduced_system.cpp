#include "reduced_system.hpp"

#include <algorithm>
#include <cmath>

#include "constrained_solver.hpp"

namespace thixis::models {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using Execution = algebra::Matrix::execution_space;
using Range = Kokkos::RangePolicy<Execution>;

constexpr double contact_ratio = 1e10;

auto input(const MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadOnly); }
auto output(MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadWrite); }

/// What both reduced forms share: the contact set, the known part of dz, and the way back to (d1, d2, dlambda).
class ReducedSystem : public LinearizedSystem {
 public:
  ReducedSystem(const MembraneOperator& membranes, const MembraneMeasure& measure)
      : membranes_(membranes),
        measure_(measure),
        diagonal_(membranes.map()),
        penalty_(membranes.map()),
        contact_(membranes.map()),
        a_(membranes.points()),
        b_(membranes.points()) {
    ReducedSystem::renew();
  }

  void renew() override {
    Vector one(membranes_.map());
    diagonal_.putScalar(0);
    for (int alpha = 0; alpha < membranes_.count; ++alpha) {
      membranes_.matrix[alpha]->getLocalDiagCopy(one);
      const double theta = membranes_.theta[1 - alpha];
      diagonal_.update(theta * theta * membranes_.factor[alpha], one, 1);
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
    set_matrix(contact_, penalty_);
  }

  algebra::LinearReport solve(const Vector& R, Vector& dX, const algebra::LinearStop& stop) final {
    const auto map = membranes_.map();
    const Fields residual(membranes_, R);

    // known dz at contact, right-hand sides
    Vector dw(map), dz(map), r_w(map), r_z(map);
    if (membranes_.count == 1) {
      r_z.assign(residual.u);
    } else {
      r_w.update(1, *residual.u.getVector(0), 1, *residual.u.getVector(1), 0);
      r_z.update(membranes_.theta[1], *residual.u.getVector(0), -membranes_.theta[0], *residual.u.getVector(1), 0);
    }
    {
      const auto C = input(residual.lambda), a = input(a_), contact = input(contact_);
      const auto known = output(dz);
      Kokkos::parallel_for(
          "thixis::models::known_gap", Range(0, C.extent_int(0)),
          KOKKOS_LAMBDA(int l) { known(l, 0) = contact(l, 0) > 0 ? -C(l, 0) / a(l, 0) : 0; });
    }
    const auto recover = [&](const Vector& w, const Vector& z, Vector& X) { this->recover(residual.lambda, r_z, w, z, X); };
    const auto report = solve_reduced(residual.lambda, r_w, r_z, dw, dz, stop, recover);
    recover(dw, dz, dX);
    return report;
  }

 protected:
  using Recover = std::function<void(const Vector& dw, const Vector& dz, Vector& dX)>;

  virtual void set_matrix(const Vector& contact, const Vector& penalty) = 0;
  virtual algebra::LinearReport solve_reduced(const Vector& C, const Vector& r_w, const Vector& r_z, Vector& dw, Vector& dz,
                                              const algebra::LinearStop& stop, const Recover& recover) = 0;

  /// y <- factor1 c1 S1 x + factor2 c2 S2 x.
  void apply(double c1, double c2, const Vector& x, Vector& y) const {
    const double f1 = c1 * membranes_.factor[0], f2 = c2 * membranes_.factor[1];
    if (membranes_.count == 1) return membranes_.matrix[0]->apply(x, y, Teuchos::NO_TRANS, f1, 0);
    if (membranes_.shared()) return membranes_.matrix[0]->apply(x, y, Teuchos::NO_TRANS, f1 + f2, 0);
    membranes_.matrix[0]->apply(x, y, Teuchos::NO_TRANS, f1, 0);
    membranes_.matrix[1]->apply(x, y, Teuchos::NO_TRANS, f2, 1);
  }

  /// Right-hand side of the z-rows, given coupling·dz of the known dz: -r_z - D C/b - known at free points, diag·dz at contact; -r_z -
  /// known where there is no contact point.
  void right_side_z(const Vector& C, const Vector& r_z, const Vector& dz, const Vector& coupled, Vector& rhs) const {
    rhs.update(-1, r_z, -1, coupled, 0);
    const auto c = input(C), known = input(dz), D = input(*membranes_.pairing), b = input(b_), contact = input(contact_),
               diagonal = input(diagonal_);
    const auto out = output(rhs);
    Kokkos::parallel_for(
        "thixis::models::right_side_z", Range(0, c.extent_int(0)), KOKKOS_LAMBDA(int l) {
          if (contact(l, 0) > 0) out(l, 0) = diagonal(l, 0) * known(l, 0);
          else out(l, 0) -= D(l, 0) * c(l, 0) / b(l, 0);
        });
  }

  /// d1 = dw + theta2 dz, d2 = dw - theta1 dz; dlambda = -(C + a dz)/b, at contact D dlambda = r_z + theta2 S1 d1 - theta1 S2 d2.
  void recover(const Vector& C, const Vector& r_z, const Vector& dw, const Vector& dz, Vector& dX) const {
    const double theta1 = membranes_.theta[0], theta2 = membranes_.theta[1];
    Fields d(membranes_);
    Vector force(membranes_.map()), force2(membranes_.map());
    d.u.getVectorNonConst(0)->update(1, dw, theta2, dz, 0);
    apply(theta2, 0, *d.u.getVector(0), force);
    if (membranes_.count == 2) {
      d.u.getVectorNonConst(1)->update(1, dw, -theta1, dz, 0);
      apply(0, -theta1, *d.u.getVector(1), force2);
    }
    force.update(1, r_z, 1, force2, 1);
    {
      const auto c = input(C), gap = input(dz), pushed = input(force), D = input(*membranes_.pairing), a = input(a_), b = input(b_),
                 contact = input(contact_);
      const auto out = output(d.lambda);
      Kokkos::parallel_for(
          "thixis::models::recover", Range(0, out.extent_int(0)),
          KOKKOS_LAMBDA(int l) { out(l, 0) = contact(l, 0) > 0 ? pushed(l, 0) / D(l, 0) : -(c(l, 0) + a(l, 0) * gap(l, 0)) / b(l, 0); });
    }
    join(d, dX);
  }

  /// Weights of residuals r_w, r_z of the two equations: with R_1 = theta1 r_w + r_z, R_2 = theta2 r_w - r_z,
  ///
  ///     |(R_1, R_2)| <= 2.5 max(weight_w |r_w|, weight_z |r_z|)          (one membrane: = |r_z|).
  double weight_w() const {
    double weight = 0;
    for (int alpha = 0; alpha < membranes_.count; ++alpha)
      weight = std::max(weight, measure_.weight(alpha) * std::min(1.0, 2 * membranes_.theta[alpha]));
    return weight;
  }
  double weight_z() const { return measure_.contact_weight(); }

  const MembraneOperator& membranes_;
  const MembraneMeasure& measure_;

 private:
  Vector diagonal_;  ///< of theta2² S1 + theta1² S2
  Vector penalty_;   ///< D a/b at free points, else 0
  Vector contact_;   ///< 1 at contact, else 0
  Vector a_, b_;
};

/// Constant tensions: (mu1 + mu2) S dw = -r_w once and for all, kappa S dz + … = …, kappa = mu1 mu2 / (mu1 + mu2). One membrane: dz alone,
/// with kappa S its stiffness.
class DecoupledSystem final : public ReducedSystem {
 public:
  DecoupledSystem(const MembraneOperator& membranes, const MembraneMeasure& measure, const algebra::LinearParams& params,
                  const Teuchos::RCP<const MultiVector>& coordinates)
      : ReducedSystem(membranes, measure),
        sum_(membranes.factor[0] + membranes.factor[1]),
        gap_(make_constrained_solver(membranes, {1, {{{kappa(membranes), 0}}}}, params, coordinates)) {
    if (membranes.count == 2) mean_ = make_constrained_solver(membranes, {1, {{{1, 0}}}}, params, coordinates);
  }
  GlobalIndex nonzeros() const override { return membranes_.count * gap_->nonzeros(); }
  void renew() override {
    ReducedSystem::renew();
    mean_ready_ = false;
  }

 private:
  static double kappa(const MembraneOperator& membranes) {
    const double f1 = membranes.factor[0], f2 = membranes.factor[1];
    return membranes.count == 1 ? f1 : f1 * f2 / (f1 + f2);
  }

  void set_matrix(const Vector& contact, const Vector& penalty) override { gap_->set_matrix(contact, penalty); }

  algebra::LinearReport solve_reduced(const Vector& C, const Vector& r_w, const Vector& r_z, Vector& dw, Vector& dz,
                                      const algebra::LinearStop& stop, const Recover& recover) override {
    const double share = membranes_.count == 1 ? 1 : 0.4, of_w = weight_w(), of_z = weight_z();
    Vector coupled(membranes_.map()), rhs(membranes_.map());
    apply(membranes_.theta[1] * membranes_.theta[1], membranes_.theta[0] * membranes_.theta[0], dz, coupled);
    right_side_z(C, r_z, dz, coupled, rhs);

    algebra::LinearReport mean;
    mean.converged = true;
    mean.residual = membranes_.count == 1 ? 0 : r_w.norm2() / sum_;
    if (of_w * sum_ * mean.residual > share * stop.tolerance) {
      if (!mean_ready_) mean_->set_matrix();
      mean_ready_ = true;
      const double of_gap = of_z * gap_->residual(rhs, dz);
      Vector mean_rhs(r_w, Teuchos::Copy);
      mean_rhs.scale(-1 / sum_);
      algebra::LinearStop inner = stop;
      inner.tolerance = share * stop.tolerance / (of_w * sum_);
      if (stop.criterion)
        inner.criterion = recovered(
            stop, recover, 0, [&](const Vector& x) { return std::pair(&x, &dz); },
            [&](double r) { return std::hypot(of_w * sum_ * r, of_gap); });
      mean = mean_->solve(mean_rhs, dw, inner);
      if (!mean.converged) {
        mean.residual = std::hypot(of_w * sum_ * mean.residual, of_gap);
        return mean;
      }
    }

    algebra::LinearStop inner = stop;
    inner.tolerance = share * stop.tolerance / of_z;
    const double of_mean = of_w * sum_ * mean.residual;
    if (stop.criterion)
      inner.criterion = recovered(
          stop, recover, mean.iterations, [&](const Vector& x) { return std::pair(&dw, &x); },
          [&](double r) { return std::hypot(of_mean, of_z * r); });
    algebra::LinearReport gap = gap_->solve(rhs, dz, inner);
    gap.iterations += mean.iterations;
    gap.residual = std::hypot(of_z * gap.residual, of_mean);
    gap.by_criterion = gap.by_criterion || mean.by_criterion;
    return gap;
  }

  /// The criterion of the caller sees the full increment and the residual of both parts, whichever is being solved.
  template <class Parts, class Residual>
  std::function<bool(const Vector&, int, double)> recovered(const algebra::LinearStop& stop, const Recover& recover, int before,
                                                            Parts parts, Residual both) const {
    return [&stop, recover, before, parts, both, map = membranes_.interlaced()](const Vector& x, int i, double residual) {
      Vector dX(map);
      const auto [w, z] = parts(x);
      recover(*w, *z, dX);
      return stop.criterion(dX, before + i, both(residual));
    };
  }

  double sum_;
  std::unique_ptr<ConstrainedSolver> gap_, mean_;
  bool mean_ready_ = false;
};

/// Tensions that vary: one system for (w, z), interlaced.
class CoupledSystem final : public ReducedSystem {
 public:
  CoupledSystem(const MembraneOperator& membranes, const MembraneMeasure& measure, const algebra::LinearParams& params,
                const Teuchos::RCP<const MultiVector>& coordinates)
      : ReducedSystem(membranes, measure), map_(algebra::interlaced(membranes.map(), 2)), params_(params), coordinates_(coordinates) {
    stretch(wanted_stretch());
  }
  GlobalIndex nonzeros() const override { return solver_->nonzeros(); }

 private:
  /// The nearest power of two: it rounds nothing, and what acts in a step of time alone decides, not what acted in the first one.
  double wanted_stretch() const { return std::exp2(std::round(std::log2(weight_z() / weight_w()))); }

  void stretch(double q) {
    stretch_ = q;
    const double f1 = membranes_.factor[0], f2 = membranes_.factor[1];
    const double theta1 = q * membranes_.theta[0], theta2 = q * membranes_.theta[1];
    const Blocks blocks = {
        2, {{{f1, f2}, {theta2 * f1, -theta1 * f2}}, {{theta2 * f1, -theta1 * f2}, {theta2 * theta2 * f1, theta1 * theta1 * f2}}}};
    solver_ = make_constrained_solver(membranes_, blocks, params_, coordinates_);
  }

  void set_matrix(const Vector& contact, const Vector& penalty) override {
    if (const double q = wanted_stretch(); q != stretch_) stretch(q);
    Vector stretched(penalty, Teuchos::Copy);
    stretched.scale(stretch_ * stretch_);
    solver_->set_matrix(contact, stretched);
  }

  algebra::LinearReport solve_reduced(const Vector& C, const Vector& r_w, const Vector& r_z, Vector& dw, Vector& dz,
                                      const algebra::LinearStop& stop, const Recover& recover) override {
    const double theta1 = membranes_.theta[0], theta2 = membranes_.theta[1];
    Vector coupled(membranes_.map()), rhs_z(membranes_.map()), rhs(map_), x(map_);
    MultiVector parts(membranes_.map(), 2);
    apply(theta2 * theta2, theta1 * theta1, dz, coupled);
    right_side_z(C, r_z, dz, coupled, rhs_z);
    apply(theta2, -theta1, dz, coupled);
    parts.getVectorNonConst(0)->update(-1, r_w, -1, coupled, 0);
    parts.getVectorNonConst(1)->update(stretch_, rhs_z, 0);
    join(parts, rhs);
    parts.getVectorNonConst(0)->putScalar(0);
    parts.getVectorNonConst(1)->update(1 / stretch_, dz, 0);
    join(parts, x);

    const double weight = std::max(weight_w(), weight_z() / stretch_);  // of a residual of this system
    algebra::LinearStop inner = stop;
    inner.tolerance = 0.4 * stop.tolerance / weight;
    if (stop.criterion)
      inner.criterion = [&](const Vector& y, int i, double residual) {
        MultiVector d(membranes_.map(), 2);
        Vector dX(membranes_.interlaced());
        split(y, d);
        d.getVectorNonConst(1)->scale(stretch_);
        recover(*d.getVector(0), *d.getVector(1), dX);
        return stop.criterion(dX, i, weight * residual);
      };
    auto report = solver_->solve(rhs, x, inner);
    report.residual *= weight;
    split(x, parts);
    dw.assign(*parts.getVector(0));
    dz.update(stretch_, *parts.getVector(1), 0);
    return report;
  }

  algebra::MapPtr map_;
  algebra::LinearParams params_;
  Teuchos::RCP<const MultiVector> coordinates_;
  double stretch_ =
      1;  ///< q: the second unknown is z/q, and its equation is multiplied by q, so that both are solved as well as they must be
  std::unique_ptr<ConstrainedSolver> solver_;
};

}  // namespace

std::unique_ptr<LinearizedSystem> make_reduced_system(const MembraneOperator& membranes, const MembraneMeasure& measure,
                                                      const algebra::LinearParams& params,
                                                      const Teuchos::RCP<const algebra::MultiVector>& coordinates) {
  if (membranes.shared()) return std::make_unique<DecoupledSystem>(membranes, measure, params, coordinates);
  return std::make_unique<CoupledSystem>(membranes, measure, params, coordinates);
}

}  // namespace thixis::models
