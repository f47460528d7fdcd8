#include "problem/membrane_operator.hpp"

#include <algorithm>

#include "thixis/bound/shares.hpp"

namespace thixis::membranes {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using contact::Small;
using Range = Kokkos::RangePolicy<Vector::execution_space>;

/// The mean diagonal of S_alpha: a few mu_alpha.
double mean_tension(const MembraneOperator& membranes, int alpha) {
  Vector diagonal(membranes.map());
  membranes.system.S.matrix[membranes.matrix_of(alpha)]->getLocalDiagCopy(diagonal);
  return membranes.factor(alpha) * diagonal.meanValue();
}

/// 1 for the fields from `begin` to `end`, else 0.
Small only(int begin, int end) {
  Small c;
  for (int alpha = begin; alpha < end; ++alpha) c(alpha, alpha) = 1;
  return c;
}

/// Matrices of tensions that are constants: one, times each of them; else one for each membrane.
contact::BlockOperator block_operator(const MembraneScene& scene, const method::Method& by, const std::array<method::FormPtr, 2>& form) {
  const method::Space& space = form[0]->space();
  contact::BlockOperator S;
  S.fields = scene.count;
  auto cells = std::make_shared<contact::CellForms>(contact::CellForms{space.elements(), space.interior(), form[0]->symmetric(), {}});
  const bool condensed = space.interior() > 0;
  const auto add = [&](const method::Form& a, const Small& weight) {
    S.matrix.push_back(method::assemble(a));
    S.weight.push_back(weight);
    if (condensed) cells->form.push_back(a.cells());
  };
  if (std::all_of(scene.tension, scene.tension + scene.count, [](const auto& tension) { return tension->constant() != nullptr; })) {
    Small mu;
    for (int alpha = 0; alpha < scene.count; ++alpha) mu(alpha, alpha) = *scene.tension[alpha]->constant();
    add(*by.diffusion(space, scene::constant(1)), mu);
  } else {
    for (int alpha = 0; alpha < scene.count; ++alpha) add(*form[alpha], only(alpha, alpha + 1));
  }
  if (condensed) S.cells = cells;
  return S;
}

/// The first unknowns, with D; a gap moves both membranes as their shares of the tension let it.
contact::Constraint constraint(const method::Space& space, const MembraneOperator& membranes) {
  contact::Constraint constraint;
  constraint.pairing = Teuchos::rcpFromRef(space.pairing());
  constraint.points = constraint.pairing->getMap();
  const Kokkos::View<LocalIndex*> node("thixis::membranes::node", algebra::local_size(*constraint.points));
  Kokkos::parallel_for(
      "thixis::membranes::node", Range(0, node.extent_int(0)), KOKKOS_LAMBDA(int p) { node(p) = p; });
  constraint.node = node;
  Small B;
  B(0, 0) = 1;
  if (membranes.count() == 2) B(1, 0) = -1;
  const auto& theta = membranes.theta;
  constraint.frames = contact::Frames({contact::make_frame(
      membranes.count(), 1, B, membranes.count() == 1 ? std::vector<double>{1} : std::vector<double>{theta[0], theta[1]})});
  return constraint;
}

/// -psi at the contact points.
Teuchos::RCP<const MultiVector> offset(const Vector& obstacle, const algebra::MapPtr& points) {
  auto offset = Teuchos::rcp(new MultiVector(points, 1));
  const auto psi = obstacle.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto out = offset->getLocalViewDevice(Tpetra::Access::OverwriteAll);
  Kokkos::parallel_for(
      "thixis::membranes::offset", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int p) { out(p, 0) = -psi(p, 0); });
  return offset;
}

}  // namespace

void MembraneOperator::apply(int alpha, const Vector& u, Vector& y, double c, double d) const {
  system.S.matrix[matrix_of(alpha)]->apply(u, y, Teuchos::NO_TRANS, c * factor(alpha), d);
}

MembraneOperator membrane_operator(const MembraneScene& scene, const method::Method& by, const std::array<method::FormPtr, 2>& form,
                                   const method::Coefficients* lift, const Teuchos::RCP<Vector>* body) {
  MembraneOperator membranes;
  const method::Space& space = form[0]->space();
  membranes.system.S = block_operator(scene, by, form);
  membranes.system.load = Teuchos::rcp(new MultiVector(space.map(), scene.count));
  for (int alpha = 0; alpha < scene.count; ++alpha) {
    // what the Dirichlet data exert on the unknowns moves to the right
    Vector held(space.map());
    method::apply(*form[alpha], lift[alpha], held);
    membranes.system.load->getVectorNonConst(alpha)->update(1, *body[alpha], -1, held, 0);
  }
  if (scene.count == 2) {
    const bool any = space.map()->getGlobalNumElements() > 0;
    membranes.theta = any ? bound::shares(mean_tension(membranes, 0), mean_tension(membranes, 1)).of_mean : bound::Shares().of_mean;
  }
  membranes.system.constraint = constraint(space, membranes);
  if (scene.count == 1) {
    auto psi = Teuchos::rcp(new Vector(space.map()));
    space.interpolate_obstacle(*scene.obstacle, *psi);
    membranes.obstacle = psi;
    membranes.system.constraint.offset = offset(*psi, membranes.points());
  }
  return membranes;
}

Inertia::Inertia(const method::Space& space, MembraneOperator& membranes) : space_(space), mass_(method::assemble(*method::mass(space))) {
  contact::BlockOperator& S = membranes.system.S;
  const bool one = S.matrix.size() == 1 && membranes.factor(0) == membranes.factor(membranes.count() - 1);
  const int different = one ? 1 : membranes.count();
  for (int k = 0; k < different; ++k) {
    factor_.push_back(membranes.factor(k));
    stiffness_.push_back(S.matrix[membranes.matrix_of(k)]);
    if (S.cells) form_.push_back(S.cells->form[membranes.matrix_of(k)]);
    sum_.push_back(Teuchos::rcp(new algebra::Matrix(space.graph())));
    sum_.back()->fillComplete();
  }
  S.matrix.assign(sum_.begin(), sum_.end());
  S.weight.clear();
  for (int k = 0; k < different; ++k) S.weight.push_back(one ? only(0, membranes.count()) : only(k, k + 1));
}

void Inertia::set(double weight, MembraneOperator& membranes) {
  const auto M = mass_->getLocalMatrixDevice().values;
  for (std::size_t k = 0; k < sum_.size(); ++k) {
    const double factor = factor_[k];
    const auto S = stiffness_[k]->getLocalMatrixDevice().values, sum = sum_[k]->getLocalMatrixDevice().values;
    Kokkos::parallel_for(
        "thixis::membranes::inertia", Range(0, sum.extent(0)), KOKKOS_LAMBDA(std::size_t e) { sum(e) = factor * S(e) + weight * M(e); });
  }
  auto& cells = membranes.system.S.cells;
  if (!cells) return;
  auto with_mass = std::make_shared<contact::CellForms>(*cells);
  with_mass->form.clear();
  for (std::size_t k = 0; k < form_.size(); ++k) with_mass->form.push_back(method::with_mass(space_, form_[k], factor_[k], weight));
  cells = with_mass;
}

Fields::Fields(const MembraneOperator& membranes, Vector& X)
    : u(contact::fields_nonconst(membranes.system, X)), lambda(*contact::multipliers_nonconst(membranes.system, X).getVectorNonConst(0)) {}

Fields::Fields(const MembraneOperator& membranes, const Vector& X)
    : u(contact::fields(membranes.system, X)), lambda(*contact::multipliers(membranes.system, X).getVectorNonConst(0)) {}

method::Coefficients difference(const method::Coefficients& u, const method::Coefficients& v) {
  const method::Coefficients w("thixis::membranes::difference", u.extent(0));
  Kokkos::parallel_for(
      "thixis::membranes::difference", Range(0, u.extent_int(0)), KOKKOS_LAMBDA(int i) { w(i) = u(i) - v(i); });
  return w;
}

void gap(const MembraneOperator& membranes, const MultiVector& u, Vector& K) { contact::gap(membranes.system, u, K); }

}  // namespace thixis::membranes
