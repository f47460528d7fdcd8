#include "estimate/measure.hpp"

#include <cmath>

#include "step/extremes.hpp"
#include "step/vectors.hpp"
#include "thixis/method/sums.hpp"
#include "thixis/method/worst_cells.hpp"

namespace thixis::flow {
namespace {

using Errors = fv::View<double* [parts_of_cell]>;

struct Summed {
  Errors errors;
  KOKKOS_FUNCTION void operator()(LocalIndex K, method::Sums<Part>& sums) const {
    for (int part = 0; part < Part::count; ++part) sums[part] += errors(K, part);
  }
};

/// Over all ranks. Collective.
method::Sums<Part> summed(const Errors& errors, const fv::Grid& grid) {
  return method::sum_over_cells<Part>("thixis::flow::sums", grid.owned_cells, Summed{errors}).over(grid.comm);
}

}  // namespace

StepMeasure::StepMeasure(const fv::Grid& grid, const TwoPhaseBoundParams& params)
    : grid_(grid), params_(params), volume_(volume(grid)), squared_diagonal_(squared_diagonal(grid)) {
  cells_ = {fv::View<double*>("thixis::flow::discretization", grid.owned_cells),
            fv::View<double*>("thixis::flow::linearization", grid.owned_cells),
            fv::View<double*>("thixis::flow::algebraic", grid.owned_cells),
            fv::View<double*>("thixis::flow::phase_transition", grid.owned_cells)};
}

complementarity::Estimate StepMeasure::operator()(const Errors& errors, double length) {
  complementarity::Estimate eta = literature() ? of_literature(errors, length) : of_residuals(errors, length);
  const method::WorstCells worst = method::worst_cells({cells_.discretization, cells_.linearization, cells_.algebraic}, eta.discretization,
                                                       grid_.global_cells, grid_.comm);
  eta.worst_algebraic = worst.algebraic;
  eta.worst_linearization = worst.linearization;
  eta.evident = true;
  return eta;
}

/// Without units.                                                                                                        (5.2)
complementarity::Estimate StepMeasure::of_residuals(const Errors& errors, double length) {
  const double alpha = params_.time_scale, tau = length;
  const double residual_unit = tau * alpha / (squared_diagonal_ * volume_), transition_unit = tau / (alpha * volume_);
  set_cells(errors, residual_unit, residual_unit, transition_unit);
  const method::Sums<Part> sum = summed(errors, grid_);
  const auto norm = [&](int part) { return std::sqrt(residual_unit * sum[part]); };
  of_step_.space = norm(Part::space);
  of_step_.time = norm(Part::in_time) + std::sqrt(transition_unit * sum[Part::appearing]);
  complementarity::Estimate eta;
  eta.discretization = of_step_.space + of_step_.time;
  eta.linearization = norm(Part::linearization);
  eta.algebraic = norm(Part::algebraic);
  eta.total = norm(Part::all_residuals) + of_step_.time;
  return eta;
}

/// (6.1)
complementarity::Estimate StepMeasure::of_literature(const Errors& errors, double length) {
  const double alpha = params_.time_scale, tau = length;
  set_cells(errors, tau, 2 * tau, std::pow(tau / alpha, 2));
  const method::Sums<Part> sum = summed(errors, grid_);
  of_step_.space = std::sqrt(2 * tau) * (std::sqrt(sum[Part::space]) + std::sqrt(sum[Part::bent]));
  of_step_.time = std::sqrt(2 * tau * sum[Part::in_time]) + tau / alpha * sum[Part::appearing];
  complementarity::Estimate eta;
  eta.discretization = of_step_.space + of_step_.time;
  eta.linearization = std::sqrt(tau * sum[Part::linearization]) + tau / alpha * sum[Part::disappearing];
  eta.algebraic = std::sqrt(tau * sum[Part::algebraic]);
  eta.total = eta.discretization + eta.linearization + eta.algebraic;
  return eta;
}

void StepMeasure::set_cells(const Errors& errors, double iteration_unit, double discretization_unit, double transition_unit) {
  const CellParts out = cells_;
  const auto& e = errors;
  const auto volume = grid_.volume;
  const double bent_unit = literature() ? discretization_unit : 0;
  Kokkos::parallel_for(
      "thixis::flow::cell_estimates", Cells(0, grid_.owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
        using Kokkos::Experimental::sqrt;
        out.discretization(K) = sqrt(discretization_unit * e(K, Part::space)) + sqrt(discretization_unit * e(K, Part::in_time)) +
                                sqrt(bent_unit * e(K, Part::bent)) + sqrt(transition_unit * e(K, Part::appearing));
        out.linearization(K) = sqrt(iteration_unit * e(K, Part::linearization));
        out.algebraic(K) = sqrt(iteration_unit * e(K, Part::algebraic));
        out.phase_transition(K) = e(K, Part::appearing) / volume(K);
      });
}

}  // namespace thixis::flow
