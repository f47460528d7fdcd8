#include "membrane_problem.hpp"

#include <cmath>

#include "full_system.hpp"
#include "projected_jacobi.hpp"
#include "reduced_system.hpp"
#include "thixis/complementarity/active_set.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::models {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using Range = Kokkos::RangePolicy<Vector::execution_space>;

/// Interior unknowns of all cells. Collective.
GlobalIndex count_interior(const CellForms& forms, const algebra::Map& rows) {
  const auto unknowns = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), forms.elements);
  GlobalIndex count = 0;
  for (std::size_t e = 0; e < unknowns.extent(0); ++e)
    for (int i = 0; i < forms.interior; ++i) count += unknowns(e, i) >= 0 && unknowns(e, i) < algebra::local_size(rows);
  return algebra::comm_of(rows).sum(count);
}

/// u_1 = u_2 at their mean, or u_1 = psi.
struct CloseGap {
  decltype(std::declval<MultiVector&>().getLocalViewDevice(Tpetra::Access::ReadWrite)) u;
  decltype(std::declval<const Vector&>().getLocalViewDevice(Tpetra::Access::ReadOnly)) psi;
  double theta1, theta2;

  explicit CloseGap(const MembraneOperator& membranes, MultiVector& fields)
      : u(fields.getLocalViewDevice(Tpetra::Access::ReadWrite)), theta1(membranes.theta[0]), theta2(membranes.theta[1]) {
    if (membranes.count == 1) psi = membranes.obstacle->getLocalViewDevice(Tpetra::Access::ReadOnly);
  }
  KOKKOS_FUNCTION double gap(int l) const { return u.extent(1) == 1 ? u(l, 0) - psi(l, 0) : u(l, 0) - u(l, 1); }
  KOKKOS_FUNCTION void operator()(int l) const {
    if (u.extent(1) == 1) u(l, 0) = psi(l, 0);
    else u(l, 0) = u(l, 1) = theta1 * u(l, 0) + theta2 * u(l, 1);
  }
  /// Leaves a gap.
  KOKKOS_FUNCTION void operator()(int l, double size) const {
    (*this)(l);
    u(l, 0) += u.extent(1) == 1 ? size : theta2 * size;
    if (u.extent(1) == 2) u(l, 1) -= theta1 * size;
  }
};

}  // namespace

MembraneProblem::MembraneProblem(MembraneOperator membranes, const algebra::LinearParams& params,
                                 const Teuchos::RCP<const MultiVector>& coordinates)
    : membranes_(std::move(membranes)), measure_(membranes_), params_(params), coordinates_(coordinates), map_(membranes_.interlaced()) {
  if (membranes_.condensed) interior_ = count_interior(*membranes_.condensed, *membranes_.map());
}

void MembraneProblem::equations(const Vector& X, Vector& R) const {
  const Fields x(membranes_, X);
  Fields r(membranes_);
  for (int alpha = 0; alpha < membranes_.count; ++alpha) {
    const auto row = r.u.getVectorNonConst(alpha);
    membranes_.matrix[alpha]->apply(*x.u.getVector(alpha), *row, Teuchos::NO_TRANS, membranes_.factor[alpha], 0);
    row->update(-1, *membranes_.load[alpha], 1);
    const double sigma = alpha == 0 ? 1 : -1;
    const auto D = membranes_.pairing->getLocalViewDevice(Tpetra::Access::ReadOnly);
    const auto lambda = x.lambda.getLocalViewDevice(Tpetra::Access::ReadOnly);
    const auto out = row->getLocalViewDevice(Tpetra::Access::ReadWrite);
    Kokkos::parallel_for(
        "thixis::models::pressure", Range(0, lambda.extent_int(0)), KOKKOS_LAMBDA(int l) { out(l, 0) -= sigma * D(l, 0) * lambda(l, 0); });
  }
  join(r, R);
}

void MembraneProblem::arguments(const Vector& X, Vector& K, Vector& G) const {
  const Fields x(membranes_, X);
  gap(membranes_, x.u, K);
  G.assign(x.lambda);
}

void MembraneProblem::scaling(Vector& s) const {
  const auto D = membranes_.pairing->getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto kappa = measure_.stiffness().getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto out = s.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  Kokkos::parallel_for(
      "thixis::models::scaling", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int l) { out(l, 0) = D(l, 0) / kappa(l, 0); });
}

bool MembraneProblem::weights(Vector& w) const {
  Fields rows(membranes_);
  for (int alpha = 0; alpha < membranes_.count; ++alpha) rows.u.getVectorNonConst(alpha)->putScalar(measure_.weight(alpha));
  rows.lambda.update(measure_.contact_weight(), measure_.stiffness(), 0);
  join(rows, w);
  return true;
}

double MembraneProblem::noise(const Vector& X) const { return measure_.round_off(Fields(membranes_, X).u); }

/// Beside what contact forces open at one point: the way of the membranes, since gaps to what is out of reach say nothing.
double MembraneProblem::gap_size(const Vector& X, const Vector& K, const Vector& G, const Vector& s) const {
  const Vector touching(K.getMap());
  return std::max(measure_.displacement(Fields(membranes_, X).u), complementarity::largest_argument(touching, G, s));
}

void MembraneProblem::insert(const Vector& C, Vector& R) const {
  const Layout at = layout(membranes_);
  const auto c = C.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto r = R.getLocalViewDevice(Tpetra::Access::ReadWrite);
  Kokkos::parallel_for(
      "thixis::models::insert", Range(0, c.extent_int(0)), KOKKOS_LAMBDA(int l) { r(at(l, at.membranes), 0) = c(l, 0); });
}

void MembraneProblem::linearize(const Vector&, const Vector& a, const Vector& b) {
  if (!system_) {
    const core::Region region("assembly");
    const bool full = params_.form == algebra::SystemForm::full && !membranes_.condensed;
    system_ = full ? make_full_system(membranes_, measure_, params_, map_, coordinates_)
                   : make_reduced_system(membranes_, measure_, params_, coordinates_);
  }
  system_->linearize(a, b);
}

void MembraneProblem::set_inertia(const method::Space& space, double weight) {
  if (!inertia_) inertia_ = std::make_unique<Inertia>(space, membranes_);
  inertia_->set(weight, membranes_);
  measure_ = MembraneMeasure(membranes_);
  smoother_.reset();
  if (system_) system_->renew();
}

algebra::LinearReport MembraneProblem::solve(const Vector& R, Vector& dX, const algebra::LinearStop& stop) {
  return system_->solve(R, dX, stop);
}

void MembraneProblem::relax(Vector& X, int sweeps) const {
  Fields x(membranes_, X);
  if (!smoother_) smoother_ = std::make_unique<ProjectedJacobi>(membranes_);
  (*smoother_)(sweeps, x);
  join(x, X);
}

void MembraneProblem::settle(Fields& x) const {
  Vector scale(membranes_.points());
  scaling(scale);
  const auto s = std::as_const(scale).getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto lambda = x.lambda.getLocalViewDevice(Tpetra::Access::ReadWrite);
  const CloseGap close(membranes_, x.u);
  Kokkos::parallel_for(
      "thixis::models::settle", Range(0, lambda.extent_int(0)), KOKKOS_LAMBDA(int l) {
        if (close.gap(l) > s(l, 0) * lambda(l, 0)) lambda(l, 0) = 0;
        else close(l);
      });
}

void MembraneProblem::make_admissible(const Fields& before, Fields& x) const {
  Vector scale(membranes_.points()), gap_before(membranes_.points());
  scaling(scale);
  gap(membranes_, before.u, gap_before);
  const auto s = std::as_const(scale).getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto K = std::as_const(gap_before).getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto G = before.lambda.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto lambda = x.lambda.getLocalViewDevice(Tpetra::Access::ReadWrite);
  const CloseGap close(membranes_, x.u);
  Kokkos::parallel_for(
      "thixis::models::make_admissible", Range(0, lambda.extent_int(0)), KOKKOS_LAMBDA(int l) {
        const bool stays_free = K(l, 0) > s(l, 0) * G(l, 0) && close.gap(l) > -K(l, 0);
        if (stays_free || close.gap(l) > s(l, 0) * lambda(l, 0) || lambda(l, 0) < 0) lambda(l, 0) = 0;
        const double least = stays_free && K(l, 0) > 0 ? K(l, 0) / 2 : 0;
        if (lambda(l, 0) > 0) close(l);
        else if (close.gap(l) < least) close(l, least);
      });
}

void MembraneProblem::make_complementary(Fields& x) const {
  const auto lambda = std::as_const(x.lambda).getLocalViewDevice(Tpetra::Access::ReadOnly);
  const CloseGap close(membranes_, x.u);
  Kokkos::parallel_for(
      "thixis::models::make_complementary", Range(0, lambda.extent_int(0)), KOKKOS_LAMBDA(int l) {
        if (lambda(l, 0) > 0) close(l);
      });
}

GlobalIndex MembraneProblem::unknowns() const {
  return static_cast<GlobalIndex>(membranes_.count * membranes_.map()->getGlobalNumElements() +
                                  membranes_.points()->getGlobalNumElements());
}
GlobalIndex MembraneProblem::rows() const {
  if (params_.form == algebra::SystemForm::full && !membranes_.condensed) return unknowns();
  return membranes_.count * (static_cast<GlobalIndex>(membranes_.map()->getGlobalNumElements()) - interior_);
}
GlobalIndex MembraneProblem::nonzeros() const { return system_ ? system_->nonzeros() : 0; }

}  // namespace thixis::models
