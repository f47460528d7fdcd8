#include "problem/membrane_problem.hpp"

#include <algorithm>

#include "thixis/complementarity/active_set.hpp"

namespace thixis::membranes {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using Range = Kokkos::RangePolicy<Vector::execution_space>;

/// u_1 = u_2 at their mean, or u_1 = psi.
struct CloseGap {
  decltype(std::declval<MultiVector&>().getLocalViewDevice(Tpetra::Access::ReadWrite)) u;
  decltype(std::declval<const Vector&>().getLocalViewDevice(Tpetra::Access::ReadOnly)) psi;
  double theta1, theta2;

  explicit CloseGap(const MembraneOperator& membranes, MultiVector& fields)
      : u(fields.getLocalViewDevice(Tpetra::Access::ReadWrite)), theta1(membranes.theta[0]), theta2(membranes.theta[1]) {
    if (membranes.count() == 1) psi = membranes.obstacle->getLocalViewDevice(Tpetra::Access::ReadOnly);
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

MembraneProblem::MembraneProblem(MembraneOperator membranes, const algebra::LinearParams& params, const algebra::Nodes& nodes)
    : MembraneProblem(std::make_shared<MembraneOperator>(std::move(membranes)), params, nodes) {}

MembraneProblem::MembraneProblem(const std::shared_ptr<MembraneOperator>& membranes, const algebra::LinearParams& params,
                                 const algebra::Nodes& nodes)
    : MembraneProblem(membranes, MembraneMeasure(*membranes), params, nodes) {}

MembraneProblem::MembraneProblem(const std::shared_ptr<MembraneOperator>& membranes, const MembraneMeasure& measure,
                                 const algebra::LinearParams& params, const algebra::Nodes& nodes)
    : contact::Problem({membranes, &membranes->system}, measure.weights(), measure.reference(), params, nodes),
      membranes_(membranes),
      measure_(measure) {}

void MembraneProblem::measure_from(const Rest& rest, const Teuchos::RCP<Vector>* body) {
  measure_.set(*membranes_, rest, body);
  measure_by(measure_.weights(), measure_.reference());
}

void MembraneProblem::set_inertia(const method::Space& space, double weight) {
  if (!inertia_) inertia_ = std::make_unique<Inertia>(space, *membranes_);
  inertia_->set(weight, *membranes_);
  measure_ = MembraneMeasure(*membranes_);
  measure_by(measure_.weights(), measure_.reference());
  renew();
}

double MembraneProblem::noise(const Vector& X) const { return measure_.round_off(Fields(*membranes_, X).u); }

/// Beside what contact forces open at one point: the way of the membranes, since gaps to what is out of reach say nothing.
double MembraneProblem::gap_size(const Vector& X, const Vector&, const Vector& G, const Vector& s) const {
  return std::max(measure_.displacement(Fields(*membranes_, X).u), complementarity::largest_multiplier(G, s));
}

void MembraneProblem::settle(Vector& X) const {
  Fields x(*membranes_, X);
  Vector scale(points());
  scaling(scale);
  const auto s = std::as_const(scale).getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto lambda = x.lambda.getLocalViewDevice(Tpetra::Access::ReadWrite);
  const CloseGap close(*membranes_, x.u);
  Kokkos::parallel_for(
      "thixis::membranes::settle", Range(0, lambda.extent_int(0)), KOKKOS_LAMBDA(int l) {
        if (close.gap(l) > s(l, 0) * lambda(l, 0)) lambda(l, 0) = 0;
        else close(l);
      });
}

void MembraneProblem::make_admissible(const Vector& before, Vector& X) const {
  Fields x(*membranes_, X);
  Vector scale(points()), gap_before(points()), multiplier_before(points());
  scaling(scale);
  arguments(before, gap_before, multiplier_before);
  const auto s = std::as_const(scale).getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto K = std::as_const(gap_before).getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto G = std::as_const(multiplier_before).getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto lambda = x.lambda.getLocalViewDevice(Tpetra::Access::ReadWrite);
  const CloseGap close(*membranes_, x.u);
  Kokkos::parallel_for(
      "thixis::membranes::make_admissible", Range(0, lambda.extent_int(0)), KOKKOS_LAMBDA(int l) {
        const bool stays_free = K(l, 0) > s(l, 0) * G(l, 0) && close.gap(l) > -K(l, 0);
        if (stays_free || close.gap(l) > s(l, 0) * lambda(l, 0) || lambda(l, 0) < 0) lambda(l, 0) = 0;
        const double least = stays_free && K(l, 0) > 0 ? K(l, 0) / 2 : 0;
        if (lambda(l, 0) > 0) close(l);
        else if (close.gap(l) < least) close(l, least);
      });
}

void MembraneProblem::make_complementary(Vector& X) const {
  Fields x(*membranes_, X);
  const auto lambda = std::as_const(x.lambda).getLocalViewDevice(Tpetra::Access::ReadOnly);
  const CloseGap close(*membranes_, x.u);
  Kokkos::parallel_for(
      "thixis::membranes::make_complementary", Range(0, lambda.extent_int(0)), KOKKOS_LAMBDA(int l) {
        if (lambda(l, 0) > 0) close(l);
      });
}

}  // namespace thixis::membranes
