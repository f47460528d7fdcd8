#include "problem/problem.hpp"

#include <algorithm>
#include <cmath>

#include "problem/increments.hpp"
#include "step/vectors.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::flow {
namespace {

using algebra::Vector;

constexpr int most_sharpenings = 4;
constexpr double small_part = 1e-3;          // of the largest increment, that a row may leave in its unknown
constexpr double smallest_increment = 1e-4;  // in the units of the unknowns, that counts

Teuchos::RCP<algebra::MultiVector> coordinates_of(const TwoPhaseOperator& flow) {
  const fv::Grid& grid = flow.grid();
  const auto coordinates = Teuchos::rcp(new algebra::MultiVector(flow.cells(), grid.dimension));
  const auto x = coordinates->getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const auto centre = grid.centre;
  const int dimension = grid.dimension;
  Kokkos::parallel_for(
      "thixis::flow::coordinates", Cells(0, grid.owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
        for (int i = 0; i < dimension; ++i) x(K, i) = centre(K, i);
      });
  return coordinates;
}

}  // namespace

TwoPhaseProblem::TwoPhaseProblem(const TwoPhaseOperator& flow, const FlowScales& scales, const algebra::LinearParams& params,
                                 Teuchos::RCP<const Vector> origin)
    : flow_(flow), scales_(scales), origin_(std::move(origin)), balance_(flow), coordinates_(coordinates_of(flow)), solver_(params) {}

void TwoPhaseProblem::linearize(const Vector& X, const Vector& a, const Vector& b) {
  const core::Region region("assembly");
  if (!pattern_) pattern_.emplace(flow_);
  at_.X = Teuchos::rcp(new Vector(X, Teuchos::Copy));
  at_.states = flow_.states(X);
  at_.fluxes = flow_.fluxes(at_.states, step_);
  fill_jacobian(at_, step_.length, flow_.grid(), flow_.laws(), row_scales(), a, b, *pattern_);
  solver_.set_matrix(pattern_->matrix, unknowns_per_cell, {coordinates_, {}});
}

/// X <- D X, or D^{-1} X; D holds the scales of the unknowns.
void TwoPhaseProblem::scale(Vector& X, bool up) const {
  const auto x = write(X);
  double factor[unknowns_per_cell];
  for (int u = 0; u < unknowns_per_cell; ++u) factor[u] = up ? scales_.unknown[u] : 1 / scales_.unknown[u];
  Kokkos::parallel_for(
      "thixis::flow::scale", Cells(0, flow_.grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
        for (int u = 0; u < unknowns_per_cell; ++u) x(unknowns_per_cell * K + u, 0) *= factor[u];
      });
}

algebra::LinearReport TwoPhaseProblem::solve(const Vector& R, Vector& dX, const algebra::LinearStop& stop) {
  Vector minus_R(R, Teuchos::Copy);
  minus_R.scale(-1);
  algebra::LinearStop scaled = stop;
  if (stop.criterion)
    scaled.criterion = [&](const Vector& y, int iteration, double residual) {
      Vector x(y, Teuchos::Copy);
      scale(x, true);
      return stop.criterion(x, iteration, residual);
    };
  dX.putScalar(0);
  algebra::LinearReport report = solver_.solve(minus_R, dX, scaled);
  if (report.converged) {
    sharpen(minus_R, dX, report);
    balance_(at_.states, matrix(), minus_R, dX, report.residual);
  }
  scale(dX, true);
  report.shortened = shortened(flow_.laws(), scales_.unknown, *at_.X, dX);
  return report;
}

/// Rows of gas that flows easily are larger by orders of magnitude than others, which a tolerance in |.| then does not see: the solver is
/// asked for less until what any row leaves is small beside the increments.
void TwoPhaseProblem::sharpen(const Vector& B, Vector& Y, algebra::LinearReport& report) const {
  Vector r(B.getMap());
  for (int again = 0; again < most_sharpenings; ++again) {
    matrix().apply(Y, r);
    r.update(1, B, -1);
    const double allowed = small_part * std::max(Y.normInf(), smallest_increment), left = largest_left(matrix(), r);
    if (!(left > allowed)) return;
    algebra::LinearStop stop;
    stop.tolerance = std::min(0.1, 0.3 * allowed / left) * r.norm2();
    const algebra::LinearReport more = solver_.solve(B, Y, stop);
    report.iterations += more.iterations;
    if (std::isfinite(more.residual)) report.residual = more.residual;
    if (!more.converged) return;
  }
}

double TwoPhaseProblem::rhs_norm(const Vector& X, const Vector& R) const {
  Vector Y(X, Teuchos::Copy), B(R, Teuchos::Copy);
  Y.update(-1, *origin_, 1);
  scale(Y, false);
  matrix().apply(Y, B, Teuchos::NO_TRANS, 1, -1);
  return B.norm2();
}

GlobalIndex TwoPhaseProblem::nonzeros() const { return pattern_ ? static_cast<GlobalIndex>(matrix().getGlobalNumEntries()) : 0; }

}  // namespace thixis::flow
