#include "membrane_problem.hpp"

#include <cmath>

#include "full_system.hpp"
#include "projected_jacobi.hpp"
#include "reduced_system.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::models {

using algebra::MultiVector;
using algebra::Vector;

MembraneProblem::MembraneProblem(MembraneOperator membranes, const algebra::LinearParams& params,
                                 const Teuchos::RCP<const MultiVector>& coordinates)
    : membranes_(std::move(membranes)), params_(params), coordinates_(coordinates), map_(algebra::interlaced(membranes_.map(), 3)) {}

void MembraneProblem::equations(const Vector& X, Vector& R) const {
  MultiVector x(membranes_.map(), 3), r(membranes_.map(), 3);
  split(X, x);
  r.getVectorNonConst(2)->putScalar(0);
  for (int alpha = 0; alpha < 2; ++alpha) {
    const auto row = r.getVectorNonConst(alpha);
    membranes_.matrix[alpha]->apply(*x.getVector(alpha), *row, Teuchos::NO_TRANS, membranes_.factor[alpha], 0);
    row->elementWiseMultiply(alpha == 0 ? -1 : 1, *membranes_.pairing, *x.getVector(2), 1);
    row->update(-1, *membranes_.load[alpha], 1);
  }
  join(r, R);
}

void MembraneProblem::arguments(const Vector& X, Vector& K, Vector& G) const {
  MultiVector x(membranes_.map(), 3);
  split(X, x);
  K.update(1, *x.getVector(0), -1, *x.getVector(1), 0);
  G.assign(*x.getVector(2));
}

void MembraneProblem::scaling(Vector& s) const {
  Vector diagonal(membranes_.map()), inverse(membranes_.map());
  s.putScalar(0);
  for (int alpha = 0; alpha < 2; ++alpha) {
    membranes_.matrix[alpha]->getLocalDiagCopy(diagonal);
    inverse.reciprocal(diagonal);
    s.elementWiseMultiply(1 / membranes_.factor[alpha], *membranes_.pairing, inverse, 1);
  }
}

void MembraneProblem::insert(const Vector& C, Vector& R) const {
  const auto c = C.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto r = R.getLocalViewDevice(Tpetra::Access::ReadWrite);
  Kokkos::parallel_for(
      "thixis::models::insert", Kokkos::RangePolicy<Vector::execution_space>(0, c.extent_int(0)),
      KOKKOS_LAMBDA(int l) { r(3 * l + 2, 0) = c(l, 0); });
}

void MembraneProblem::linearize(const Vector&, const Vector& a, const Vector& b) {
  if (!system_) {
    const core::Region region("assembly");
    system_ = params_.form == algebra::SystemForm::full ? make_full_system(membranes_, params_, map_, coordinates_)
                                                        : make_reduced_system(membranes_, params_, coordinates_);
  }
  system_->linearize(a, b);
}

algebra::LinearReport MembraneProblem::solve(const Vector& R, Vector& dX, const algebra::LinearStop& stop) {
  return system_->solve(R, dX, stop);
}

void MembraneProblem::relax(Vector& X, int sweeps) const {
  MultiVector x(membranes_.map(), 3);
  split(X, x);
  projected_jacobi(membranes_, sweeps, x);
  join(x, X);
}

void MembraneProblem::settle(MultiVector& x) const {
  Vector scale(membranes_.map());
  scaling(scale);
  const auto s = scale.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto fields = x.getLocalViewDevice(Tpetra::Access::ReadWrite);
  const double theta1 = membranes_.theta[0], theta2 = membranes_.theta[1];
  Kokkos::parallel_for(
      "thixis::models::settle", Kokkos::RangePolicy<Vector::execution_space>(0, fields.extent_int(0)), KOKKOS_LAMBDA(int l) {
        if (fields(l, 0) - fields(l, 1) > s(l, 0) * fields(l, 2)) fields(l, 2) = 0;
        else fields(l, 0) = fields(l, 1) = theta1 * fields(l, 0) + theta2 * fields(l, 1);
      });
}

void MembraneProblem::make_complementary(MultiVector& x) const {
  const auto fields = x.getLocalViewDevice(Tpetra::Access::ReadWrite);
  const double theta1 = membranes_.theta[0], theta2 = membranes_.theta[1];
  Kokkos::parallel_for(
      "thixis::models::make_complementary", Kokkos::RangePolicy<Vector::execution_space>(0, fields.extent_int(0)), KOKKOS_LAMBDA(int l) {
        if (fields(l, 2) > 0) fields(l, 0) = fields(l, 1) = theta1 * fields(l, 0) + theta2 * fields(l, 1);
      });
}

double MembraneProblem::reference_norm() const { return std::hypot(membranes_.load[0]->norm2(), membranes_.load[1]->norm2()); }

GlobalIndex MembraneProblem::rows() const {
  return (params_.form == algebra::SystemForm::full ? 3 : 2) * static_cast<GlobalIndex>(membranes_.map()->getGlobalNumElements());
}
GlobalIndex MembraneProblem::nonzeros() const { return system_ ? system_->nonzeros() : 0; }

}  // namespace thixis::models
