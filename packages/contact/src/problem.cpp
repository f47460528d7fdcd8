#include "thixis/contact/problem.hpp"

#include <cmath>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::contact {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using Range = Kokkos::RangePolicy<Vector::execution_space>;

double norm_of_all(const MultiVector& columns) {
  double sum = 0;
  for (std::size_t j = 0; j < columns.getNumVectors(); ++j) sum = std::hypot(sum, columns.getVector(j)->norm2());
  return sum;
}

GlobalIndex size(const algebra::MapPtr& map) { return static_cast<GlobalIndex>(map->getGlobalNumElements()); }

/// Interior unknowns of all cells. Collective.
GlobalIndex count_interior(const CellForms& cells, const algebra::Map& map) {
  const auto elements = cells.elements;
  const int interior = cells.interior;
  const LocalIndex rows = algebra::local_size(map);
  GlobalIndex count = 0;
  Kokkos::parallel_reduce(
      "thixis::contact::interior", Range(0, elements.extent_int(0)),
      KOKKOS_LAMBDA(int e, GlobalIndex& sum) {
        for (int i = 0; i < interior; ++i) sum += elements(e, i) >= 0 && elements(e, i) < rows;
      },
      count);
  return algebra::comm_of(map).sum(count);
}

Weights unit_weights(const System& system) {
  const BlockOperator& S = system.S;
  MultiVector diagonals(S.map(), S.fields);
  S.diagonals(diagonals);
  Weights weights;
  weights.field.assign(S.fields, 1);
  weights.stiffness = stiffness_of_gaps(system, diagonals);
  return weights;
}

}  // namespace

Problem::Problem(std::shared_ptr<const System> system, const algebra::LinearParams& params, const algebra::Nodes& nodes)
    : Problem(system, unit_weights(*system), norm_of_all(*system->load), params, nodes) {}

Problem::Problem(std::shared_ptr<const System> system, Weights weights, double reference, const algebra::LinearParams& params,
                 const algebra::Nodes& nodes)
    : system_(std::move(system)),
      weights_(std::move(weights)),
      reference_(reference),
      params_(params),
      nodes_(nodes),
      map_(map_of_all(*system_)),
      gaps_map_(map_of_gaps(*system_)),
      left_(system_->fields() * size(system_->map())),
      product_(Teuchos::rcp(new MultiVector(system_->map(), system_->fields()))) {
  const BlockOperator& S = system_->S;
  if (S.cells) left_ -= system_->fields() * count_interior(*S.cells, *S.map());
}

void Problem::equations(const Vector& X, Vector& R) const {
  if (&X == shown_) {
    R.assign(*shown_residual_);
    return;
  }
  R.putScalar(0);
  MultiVector r = fields_nonconst(*system_, R);
  system_->S.apply(fields(*system_, X), r, *product_);
  r.update(-1, *system_->load, 1);
  subtract_pressure(*system_, multipliers(*system_, X), r);
}

void Problem::arguments(const Vector& X, Vector& K, Vector& G) const {
  MultiVector gaps_of_X = gaps_nonconst(*system_, K), given = gaps_nonconst(*system_, G);
  gap(*system_, fields(*system_, X), gaps_of_X);
  Tpetra::deep_copy(given, multipliers(*system_, X));
}

void Problem::scaling(Vector& s) const {
  MultiVector columns = gaps_nonconst(*system_, s);
  const auto D = system_->constraint.pairing->getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto kappa = weights_.stiffness->getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto out = columns.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  Kokkos::parallel_for(
      "thixis::contact::scaling", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int p) {
        for (int g = 0; g < out.extent_int(1); ++g) out(p, g) = D(p, 0) / kappa(p, g);
      });
}

bool Problem::weights(Vector& w) const {
  MultiVector of_fields = fields_nonconst(*system_, w), of_gaps = multipliers_nonconst(*system_, w);
  for (int i = 0; i < system_->fields(); ++i) of_fields.getVectorNonConst(i)->putScalar(weights_.field[i]);
  of_gaps.update(weights_.contact, *weights_.stiffness, 0);
  return true;
}

void Problem::insert(const Vector& C, Vector& R) const {
  MultiVector rows = multipliers_nonconst(*system_, R);
  Tpetra::deep_copy(rows, gaps(*system_, C));
}

void Problem::linearize(const Vector&, const Vector& a, const Vector& b) {
  if (!linearized_) {
    const core::Region region("assembly");
    linearized_ =
        full() ? make_full_system(*system_, weights_, params_, nodes_) : make_reduced_system(*system_, weights_, params_, nodes_, product_);
  }
  linearized_->linearize(a, b);
}

algebra::LinearReport Problem::solve(const Vector& R, Vector& dX, const algebra::LinearStop& stop) {
  return linearized_->solve(R, dX, stop);
}

void Problem::look_at(const Vector& Xi, const Vector& R) const {
  if (full()) return;
  if (shown_residual_.is_null()) shown_residual_ = Teuchos::rcp(new Vector(map_));
  if (linearized_->residual_of_shown(R, *shown_residual_)) shown_ = &Xi;
}

void Problem::relax(Vector& X, int sweeps) const {
  if (!smoother_) smoother_ = std::make_unique<ProjectedJacobi>(*system_);
  (*smoother_)(sweeps, X);
}

void Problem::measure_by(Weights weights, double reference) {
  weights_ = std::move(weights);
  reference_ = reference;
}

void Problem::renew() {
  smoother_.reset();
  if (linearized_) linearized_->renew();
}

GlobalIndex Problem::unknowns() const { return system_->fields() * size(system_->map()) + system_->gaps() * size(system_->points()); }
GlobalIndex Problem::rows() const { return full() ? unknowns() : left_; }
GlobalIndex Problem::nonzeros() const { return linearized_ ? linearized_->nonzeros() : 0; }

}  // namespace thixis::contact
