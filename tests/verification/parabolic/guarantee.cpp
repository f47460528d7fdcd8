/// The bound over time against the error: at all times, for solutions and for iterates that solve nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <iomanip>
#include <iostream>

#include "march.hpp"
#include "thixis/complementarity/newton.hpp"
#include "thixis/fem/lagrange_space.hpp"
#include "thixis/hho/space.hpp"

namespace thixis::verification {
namespace {

using complementarity::Estimate;
using method::MethodName;

/// How a step is ended.
enum class Ending { solved, smooth_c_function, two_systems, disturbed };

struct Bounded {
  Estimate so_far;
  double error = 0, worst = 1e300;  ///< the least of bound over error of all steps
  models::StepErrors sums;          ///< roots of sums of squares over the steps
  double worst_linearization = 0;   ///< eta_lin over eta_disc where Newton converged
  bool split = true;                ///< total <= disc + lin + alg in every step and over all
};

bool holds(const Estimate& eta) { return eta.total <= (1 + 1e-12) * (eta.discretization + eta.linearization + eta.algebraic); }

void disturb(algebra::Vector& X, double size) {
  const auto ids = X.getMap();
  const auto values = algebra::host_view(X);
  for (std::size_t i = 0; i < values.extent(0); ++i)
    values(i) += size * std::sin(12.9898 * static_cast<double>(ids->getGlobalElement(static_cast<LocalIndex>(i)) % 1009));
}

Bounded bounded(drive::RunParams params, int steps, double end, Ending ending) {
  const core::Comm comm;
  if (ending == Ending::smooth_c_function) params.newton.c_function = complementarity::CFunction::fischer_burmeister;
  if (ending == Ending::two_systems) params.newton.max_iterations = 2;
  const auto make = params.method.name == MethodName::hho ? hho::make_space : fem::make_lagrange_space;
  const auto model = models::parabolic_membranes(scene::membrane_scene(params.scene), make, params.method, params.linear);
  const auto evolution = model->evolve(params.mesh, comm, "", {});
  auto X = evolution->initial();
  Bounded result;
  double time2 = 0, space2 = 0;
  for (int n = 1; n <= steps; ++n) {
    const algebra::Vector before(*X, Teuchos::Copy);
    evolution->begin({end * (n - 1) / steps, end * n / steps}, before);
    const Estimate first = evolution->estimate(*X);
    const auto report =
        complementarity::newton(evolution->problem(), *X, params.newton, params.stopping, params.linear.check_every, {}, {});
    if (ending == Ending::disturbed) disturb(*X, 1e-3);
    const Estimate eta = evolution->estimate(*X);
    result.split = result.split && holds(first) && holds(eta);
    if (report.converged && ending != Ending::disturbed)
      result.worst_linearization = std::max(result.worst_linearization, eta.linearization / eta.discretization);
    const auto errors = evolution->step_errors().value();
    time2 += errors.time * errors.time;
    space2 += errors.space * errors.space;
    evolution->accept(*X);
    result.so_far = evolution->estimate_so_far().value();
    result.error = evolution->energy_error().value();
    result.split = result.split && holds(result.so_far);
    result.worst = std::min(result.worst, result.so_far.total / result.error);
  }
  result.sums = {std::sqrt(time2), std::sqrt(space2)};
  return result;
}

void show(const std::string& what, const Bounded& b) {
  if (!core::Comm().root()) return;
  std::cout << std::setprecision(4) << what << ": error " << b.error << ", bound " << b.so_far.total << ", index "
            << b.so_far.total / b.error << " (least " << b.worst << "), disc " << b.so_far.discretization << " lin "
            << b.so_far.linearization << " alg " << b.so_far.algebraic << ", time " << b.sums.time << " space " << b.sums.space
            << std::endl;
}

std::string name_of(MethodName method, int degree) { return method::to_text(method) + " P" + std::to_string(degree); }

}  // namespace

TEST(GuaranteeInTime, is_above_the_error_at_all_times) {
  for (const std::string scene : {"moving contact", "smooth moving contact", "resting contact"})
    for (const auto method : {MethodName::fem, MethodName::hho})
      for (int degree = 1; degree <= 4; ++degree) {
        const auto b = bounded(on_squares(scene, 4, method, degree), 4, 1, Ending::solved);
        const std::string what = scene + ", " + name_of(method, degree);
        show(what, b);
        EXPECT_GE(b.worst, 1) << what;
        EXPECT_TRUE(b.split) << what;
        EXPECT_LE(b.worst_linearization, 1e-6) << what;
        EXPECT_LE(b.so_far.algebraic, 1e-6 * b.so_far.discretization) << what;
      }
}

TEST(GuaranteeInTime, is_above_the_error_of_iterates) {
  for (const auto ending : {Ending::smooth_c_function, Ending::two_systems, Ending::disturbed})
    for (const auto method : {MethodName::fem, MethodName::hho})
      for (int degree = 1; degree <= 4; ++degree) {
        const auto b = bounded(on_squares("moving contact", 4, method, degree), 4, 1, ending);
        const std::string what = name_of(method, degree) + ", ending " + std::to_string(static_cast<int>(ending));
        show(what, b);
        EXPECT_GE(b.worst, 1) << what;
        EXPECT_TRUE(b.split) << what;
      }
}

}  // namespace thixis::verification
