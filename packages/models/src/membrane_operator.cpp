#include "membrane_operator.hpp"

namespace thixis::models {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using Range = Kokkos::RangePolicy<Vector::execution_space>;

Layout layout(const Fields& fields) {
  return {static_cast<int>(fields.u.getNumVectors()), static_cast<LocalIndex>(fields.lambda.getLocalLength())};
}

}  // namespace

algebra::MapPtr MembraneOperator::interlaced() const {
  if (points()->getGlobalNumElements() == map()->getGlobalNumElements()) return algebra::interlaced(map(), count + 1);
  return algebra::interlaced(map(), count + 1, algebra::local_size(*points()));
}

Layout layout(const MembraneOperator& membranes) { return {membranes.count, algebra::local_size(*membranes.points())}; }

MembraneOperator membrane_operator(const scene::MembraneScene& scene, const method::Space& space, const method::MethodParams& method,
                                   const method::Coefficients* lift, const Teuchos::RCP<Vector>* body) {
  MembraneOperator membranes;
  membranes.count = scene.count;
  membranes.pairing = Teuchos::rcpFromRef(space.pairing());
  std::array<scene::FieldPtr, 2> tension = {scene.tension[0], scene.tension[1]};  // that of the matrices
  bool constant = true;
  for (int alpha = 0; alpha < scene.count; ++alpha) constant = constant && scene.tension[alpha]->constant();
  for (int alpha = 0; alpha < scene.count && constant; ++alpha) {
    membranes.factor[alpha] = *scene.tension[alpha]->constant();
    tension[alpha] = scene::constant(1);
  }
  if (method.condensed() && space.interior() > 0)
    membranes.condensed = CellForms{space.elements(), space.interior(), space.symmetric(), {}};
  for (int alpha = 0; alpha < scene.count; ++alpha) {
    auto& condensed = membranes.condensed;
    if (constant && alpha > 0) {
      membranes.matrix[alpha] = membranes.matrix[0];
      if (condensed) condensed->form[alpha] = condensed->form[0];
    } else {
      membranes.matrix[alpha] = space.stiffness(*tension[alpha]);
      if (condensed) condensed->form[alpha] = space.cell_form(*tension[alpha]);
    }
    // what the Dirichlet data exert on the unknowns moves to the right
    Vector held(space.map());
    space.forces(*scene.tension[alpha], lift[alpha], held);
    membranes.load[alpha] = Teuchos::rcp(new Vector(*body[alpha], Teuchos::Copy));
    membranes.load[alpha]->update(-1, held, 1);
    Vector diagonal(space.map());
    membranes.matrix[alpha]->getLocalDiagCopy(diagonal);
    membranes.tension[alpha] = membranes.factor[alpha] * diagonal.meanValue();
  }
  if (scene.count == 1) {
    auto psi = Teuchos::rcp(new Vector(space.map()));
    space.interpolate_obstacle(*scene.obstacle, *psi);
    membranes.obstacle = psi;
    membranes.theta = {0, 1};
  } else if (space.map()->getGlobalNumElements() > 0) {
    for (int alpha = 0; alpha < 2; ++alpha)
      membranes.theta[alpha] = membranes.tension[alpha] / (membranes.tension[0] + membranes.tension[1]);
  }
  return membranes;
}

Inertia::Inertia(const method::Space& space, MembraneOperator& membranes)
    : space_(space),
      count_(membranes.shared() && membranes.factor[0] == membranes.factor[1] ? 1 : membranes.count),
      factor_(membranes.factor),
      stiffness_(membranes.matrix),
      mass_(space.mass()) {
  if (membranes.condensed) form_ = membranes.condensed->form;
  for (int alpha = 0; alpha < count_; ++alpha) {
    sum_[alpha] = Teuchos::rcp(new algebra::Matrix(space.graph()));
    sum_[alpha]->fillComplete();
  }
  for (int alpha = 0; alpha < membranes.count; ++alpha) {
    membranes.matrix[alpha] = sum_[alpha % count_];
    membranes.factor[alpha] = 1;
  }
}

void Inertia::set(double weight, MembraneOperator& membranes) {
  const auto M = mass_->getLocalMatrixDevice().values;
  for (int alpha = 0; alpha < count_; ++alpha) {
    const double factor = factor_[alpha];
    const auto S = stiffness_[alpha]->getLocalMatrixDevice().values, sum = sum_[alpha]->getLocalMatrixDevice().values;
    Kokkos::parallel_for(
        "thixis::models::inertia", Kokkos::RangePolicy<Vector::execution_space>(0, sum.extent(0)),
        KOKKOS_LAMBDA(std::size_t k) { sum(k) = factor * S(k) + weight * M(k); });
  }
  if (!membranes.condensed) return;
  for (int alpha = 0; alpha < membranes.count; ++alpha)
    membranes.condensed->form[alpha] =
        alpha < count_ ? space_.with_mass(form_[alpha], factor_[alpha], weight) : membranes.condensed->form[0];
}

Fields::Fields(const MembraneOperator& membranes) : u(membranes.map(), membranes.count), lambda(membranes.points()) {}

Fields::Fields(const MembraneOperator& membranes, const Vector& X) : Fields(membranes) { split(X, *this); }

void split(const Vector& X, Fields& fields) {
  const Layout at = layout(fields);
  const auto x = X.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto u = fields.u.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const auto lambda = fields.lambda.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  Kokkos::parallel_for(
      "thixis::models::split", Range(0, u.extent_int(0)), KOKKOS_LAMBDA(int l) {
        for (int f = 0; f < at.membranes; ++f) u(l, f) = x(at(l, f), 0);
        if (l < at.points) lambda(l, 0) = x(at(l, at.membranes), 0);
      });
}

void join(const Fields& fields, Vector& X) {
  const Layout at = layout(fields);
  const auto u = fields.u.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto lambda = fields.lambda.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto x = X.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  Kokkos::parallel_for(
      "thixis::models::join", Range(0, u.extent_int(0)), KOKKOS_LAMBDA(int l) {
        for (int f = 0; f < at.membranes; ++f) x(at(l, f), 0) = u(l, f);
        if (l < at.points) x(at(l, at.membranes), 0) = lambda(l, 0);
      });
}

void split(const Vector& x, MultiVector& columns) {
  const auto in = x.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto out = columns.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const int width = out.extent_int(1);
  Kokkos::parallel_for(
      "thixis::models::split_columns", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int l) {
        for (int f = 0; f < width; ++f) out(l, f) = in(width * l + f, 0);
      });
}

void join(const MultiVector& columns, Vector& x) {
  const auto in = columns.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto out = x.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const int width = in.extent_int(1);
  Kokkos::parallel_for(
      "thixis::models::join_columns", Range(0, in.extent_int(0)), KOKKOS_LAMBDA(int l) {
        for (int f = 0; f < width; ++f) out(width * l + f, 0) = in(l, f);
      });
}

method::Coefficients difference(const method::Coefficients& u, const method::Coefficients& v) {
  const method::Coefficients w("thixis::models::difference", u.extent(0));
  Kokkos::parallel_for(
      "thixis::models::difference", Range(0, u.extent_int(0)), KOKKOS_LAMBDA(int i) { w(i) = u(i) - v(i); });
  return w;
}

void gap(const MembraneOperator& membranes, const MultiVector& u, Vector& K) {
  const auto fields = u.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto out = K.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const Range points(0, out.extent_int(0));
  if (membranes.count == 2) {
    Kokkos::parallel_for(
        "thixis::models::gap", points, KOKKOS_LAMBDA(int l) { out(l, 0) = fields(l, 0) - fields(l, 1); });
  } else {
    const auto psi = membranes.obstacle->getLocalViewDevice(Tpetra::Access::ReadOnly);
    Kokkos::parallel_for(
        "thixis::models::gap_over_obstacle", points, KOKKOS_LAMBDA(int l) { out(l, 0) = fields(l, 0) - psi(l, 0); });
  }
}

}  // namespace thixis::models
