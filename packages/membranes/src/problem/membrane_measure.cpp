#include "problem/membrane_measure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thixis::membranes {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using Range = Kokkos::RangePolicy<Vector::execution_space>;

/// Rounding errors of a sum S u of some ten terms, in units of S_ll |u_l|.
constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();

/// No force is a scale that is so many times what drives the gap: the tolerance of 1e-10 leaves 1e-7 of that.
constexpr double farthest = 1e3;

auto read(const Vector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadOnly); }

/// |(S psi - F)^+| at the contact points: no obstacle exerts more (Lewy and Stampacchia).
double pushed(const Vector& on_closed_gap, const MembraneOperator& membranes) {
  const auto force = read(on_closed_gap);
  double sum = 0;
  Kokkos::parallel_reduce(
      "thixis::membranes::contact_force", Range(0, algebra::local_size(*membranes.points())),
      KOKKOS_LAMBDA(int l, double& squares) { squares += force(l, 0) < 0 ? force(l, 0) * force(l, 0) : 0; }, sum);
  return std::sqrt(algebra::comm_of(*membranes.map()).sum(sum));
}

/// max_l psi_l at the contact points. Collective.
double highest(const Vector& psi, const algebra::Map& points) {
  const auto height = read(psi);
  double worst = 0;
  Kokkos::parallel_reduce(
      "thixis::membranes::highest", Range(0, algebra::local_size(points)),
      KOKKOS_LAMBDA(int l, double& largest) {
        if (largest < height(l, 0)) largest = height(l, 0);
      },
      Kokkos::Max<double>(worst));
  return algebra::comm_of(*psi.getMap()).max(worst);
}

}  // namespace

MembraneMeasure::MembraneMeasure(const MembraneOperator& membranes) : count_(membranes.count()) {
  if (count_ == 2) theta_ = membranes.theta;
  MultiVector diagonals(membranes.map(), count_);
  membranes.system.S.diagonals(diagonals);
  for (int alpha = 0; alpha < count_; ++alpha) diagonal_[alpha] = diagonals.getVectorNonConst(alpha);
  weights_.field.assign(count_, 1);
  weights_.stiffness = contact::stiffness_of_gaps(membranes.system, diagonals);
  stiffness_ = weights_.stiffness->getVector(0);
}

void MembraneMeasure::set(const MembraneOperator& membranes, const Rest& rest, const Teuchos::RCP<Vector>* body) {
  height_ = rest.height;
  size_ = rest.size;
  std::array<double, 2> force = {0, 0};
  Vector acting(membranes.map()), on_gap(membranes.map());
  for (int alpha = 0; alpha < count_; ++alpha) {
    acting.assign(*membranes.load(alpha));
    if (rest.u) membranes.apply(alpha, *rest.u->getVector(alpha), acting, -1, 1);
    force[alpha] = acting.norm2();
    if (body) force[alpha] = std::max(force[alpha], body[alpha]->norm2());
    on_gap.update(alpha == 0 ? yields(0) : -yields(1), acting, 1);
  }
  const Vector on_closed = force_on_closed_gap(membranes, rest.reach);
  on_gap_ = on_closed.norm2();
  if (rest.force) bound_by_gap(rest, force);
  // what drives the gap reaches both membranes through contact
  const double through_contact = count_ == 1 ? force[0] : on_gap.norm2();
  reference_ = 0;
  for (int alpha = 0; alpha < count_; ++alpha) {
    const double round_off = rounding * diagonal_[alpha]->norm2() * carried(alpha, size_);
    force[alpha] = std::max({force[alpha], through_contact, round_off / smallest_digit});
    reference_ = std::max(reference_, force[alpha]);
  }
  if (count_ == 1) reference_ = std::max(reference_, pushed(on_closed, membranes));
  for (int alpha = 0; alpha < count_; ++alpha) weights_.field[alpha] = count_ == 2 && force[alpha] > 0 ? reference_ / force[alpha] : 1;
  weights_.contact = *std::max_element(weights_.field.begin(), weights_.field.end());
}

/// A tilt that all heights have in common acts on each membrane and not on the gap: a residual of R_1 leaves theta_2 R_1 there.
void MembraneMeasure::bound_by_gap(const Rest& rest, std::array<double, 2>& force) const {
  if (on_gap(force) <= farthest * on_gap_) return;
  std::array<double, 2> alone = {0, 0};
  for (int alpha = 0; alpha < count_; ++alpha) alone[alpha] = rest.force(alpha);
  const double most = farthest * std::max(on_gap_, on_gap(alone));
  for (int alpha = 0; alpha < count_; ++alpha) force[alpha] = std::min(force[alpha], most / yields(alpha));
}

/// theta_2 F_1 - theta_1 F_2, or F - S psi, where a psi out of reach is cut; and so is what its projection on faces leaves above it beside
/// a step.
Vector MembraneMeasure::force_on_closed_gap(const MembraneOperator& membranes, double reach) const {
  Vector force(*membranes.load(0), Teuchos::Copy);
  if (count_ == 2) {
    force.update(-yields(1), *membranes.load(1), yields(0));
    return force;
  }
  const double top = std::max(reach, highest(*membranes.obstacle, *membranes.points()));
  Vector psi(*membranes.obstacle, Teuchos::Copy);
  {
    const auto height = psi.getLocalViewDevice(Tpetra::Access::ReadWrite);
    Kokkos::parallel_for(
        "thixis::membranes::in_reach", Range(0, height.extent_int(0)), KOKKOS_LAMBDA(int l) {
          if (height(l, 0) < reach) height(l, 0) = reach;
          if (height(l, 0) > top) height(l, 0) = top;
        });
  }
  membranes.apply(0, psi, force, -1, 1);
  return force;
}

/// u_1 = w + theta_2 z and u_2 = w - theta_1 z, w = theta_1 u_1 + theta_2 u_2, z = u_1 - u_2, are as steady as w and z: a membrane has the
/// rounding of its own height, and of the other one's as far as it yields to it.
double MembraneMeasure::carried(int alpha, const std::array<double, 2>& heights) const {
  return count_ == 1 ? heights[0] : heights[alpha] + theta_[1 - alpha] * heights[1 - alpha];
}

double MembraneMeasure::on_gap(const std::array<double, 2>& forces) const {
  return count_ == 1 ? forces[0] : yields(0) * forces[0] + yields(1) * forces[1];
}

std::array<double, 2> MembraneMeasure::rounded_forces(const MultiVector& u) const {
  std::array<double, 2> forces = {0, 0};
  const auto x = u.getLocalViewDevice(Tpetra::Access::ReadOnly);
  for (int alpha = 0; alpha < count_; ++alpha) {
    const auto S = read(*diagonal_[alpha]);
    const int beta = count_ == 1 ? 0 : 1 - alpha;
    const double share = count_ == 1 ? 0 : theta_[beta];
    double sum = 0;
    Kokkos::parallel_reduce(
        "thixis::membranes::round_off", Range(0, x.extent_int(0)),
        KOKKOS_LAMBDA(int l, double& squares) {
          const double force = S(l, 0) * (std::abs(x(l, alpha)) + share * std::abs(x(l, beta)));
          squares += force * force;
        },
        sum);
    forces[alpha] = rounding * std::sqrt(algebra::comm_of(*u.getMap()).sum(sum));
  }
  return forces;
}

double MembraneMeasure::round_off(const MultiVector& u) const {
  const std::array<double, 2> forces = rounded_forces(u);
  double sum = 0;
  for (int alpha = 0; alpha < count_; ++alpha) sum = std::hypot(sum, weight(alpha) * forces[alpha]);
  return sum;
}

double MembraneMeasure::round_off(int alpha, const MultiVector& u) const {
  return rounding * diagonal_[alpha]->normInf() * carried(alpha, heights(u));
}

double MembraneMeasure::round_off_of_height(int alpha, const MultiVector& u) const {
  return std::numeric_limits<double>::epsilon() * carried(alpha, heights(u));
}

std::array<double, 2> MembraneMeasure::heights(const MultiVector& u) const {
  std::array<double, 2> largest = size_;
  for (int alpha = 0; alpha < count_; ++alpha) largest[alpha] = std::max(largest[alpha], u.getVector(alpha)->normInf());
  return largest;
}

double MembraneMeasure::displacement(int alpha, const MultiVector& u) const {
  const auto x = u.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const double height = height_[alpha];
  double worst = 0;
  Kokkos::parallel_reduce(
      "thixis::membranes::displacement", Range(0, algebra::local_size(*stiffness_->getMap())),
      KOKKOS_LAMBDA(int l, double& largest) {
        const double moved = x(l, alpha) < height ? height - x(l, alpha) : x(l, alpha) - height;
        if (largest < moved) largest = moved;
      },
      Kokkos::Max<double>(worst));
  return algebra::comm_of(*u.getMap()).max(std::max(worst, 0.0));
}

double MembraneMeasure::displacement(const MultiVector& u) const {
  double worst = 0;
  for (int alpha = 0; alpha < count_; ++alpha) worst = std::max(worst, displacement(alpha, u));
  return worst;
}

}  // namespace thixis::membranes
