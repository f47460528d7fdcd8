/// The bound over time against the error: at all times, for solutions and for iterates that solve nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>

#include "march.hpp"
#include "thixis/complementarity/newton.hpp"
#include "thixis/output/checkpoint.hpp"

namespace thixis::verification {
namespace {

using complementarity::Estimate;

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

Bounded bounded(drive::RunParams params, int steps, double end, Ending ending, const core::Comm& comm = core::Comm()) {
  if (ending == Ending::smooth_c_function) params.newton.c_function = complementarity::CFunction::fischer_burmeister;
  if (ending == Ending::two_systems) params.newton.max_iterations = 2;
  const auto make = method_of(params.method.name);
  const auto model = membranes::parabolic_membranes(membranes::membrane_scene(params.scene), make, params.method, params.linear);
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
    result.error = evolution->error_so_far().value();
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

std::string name_of(std::string method, int degree) { return method + " P" + std::to_string(degree); }

}  // namespace

TEST(GuaranteeInTime, is_above_the_error_at_all_times) {
  for (const std::string scene : {"moving contact", "smooth moving contact", "resting contact"})
    for (const auto& method : built({"fem", "hho"}))
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
    for (const auto& method : built({"fem", "hho"}))
      for (int degree = 1; degree <= 4; ++degree) {
        const auto b = bounded(on_squares("moving contact", 4, method, degree), 4, 1, ending);
        const std::string what = name_of(method, degree) + ", ending " + std::to_string(static_cast<int>(ending));
        show(what, b);
        EXPECT_GE(b.worst, 1) << what;
        EXPECT_TRUE(b.split) << what;
      }
}

TEST(GuaranteeInTime, has_parts_of_the_orders_of_the_method) {
  const auto rate = [](double coarse, double fine) { return std::log2(coarse / fine); };
  const auto in_time = [](int steps) {
    return bounded(on_squares("smooth moving contact", 4, "fem", 3), steps, 1, Ending::solved).sums.time;
  };
  EXPECT_NEAR(rate(in_time(8), in_time(16)), 1, 0.15);
  for (const auto& method : built({"fem", "hho"}))
    for (int degree = 1; degree <= 3; ++degree) {
      const auto in_space = [&](int n) {
        return bounded(on_squares("resting contact", n, method, degree), 2, 1, Ending::solved).sums.space;
      };
      EXPECT_GE(rate(in_space(8), in_space(16)), degree - 0.35) << name_of(method, degree);
    }
}

/// The exact solution is known on all meshes: refined at a time between two steps.
TEST(GuaranteeOnRanks, stays_above_the_error_when_the_mesh_is_refined) {
  for (const auto& method : built({"fem", "hho"}))
    for (const int degree : {1, 2}) {
      auto params = on_squares("moving contact", 4, method, degree);
      params.mesh.cells_per_rank = 8;
      const auto make = method_of(method);
      const auto model = membranes::parabolic_membranes(membranes::membrane_scene(params.scene), make, params.method, params.linear);
      const auto evolution = model->evolve(params.mesh, core::Comm(), "", {});
      auto X = evolution->initial();
      for (int n = 1; n <= 4; ++n) {
        if (n == 3) {
          const auto& mesh = evolution->hierarchy()->finest();
          std::vector<GlobalIndex> marked;
          for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
            if (mesh.cell_id[K] % 3 == 0) marked.push_back(mesh.cell_id[K]);
          const auto before = evolution->estimate_so_far().value();
          X = evolution->refine(marked, *X);
          const auto after = evolution->estimate_so_far().value();
          EXPECT_GE(after.total, before.total) << name_of(method, degree);
          EXPECT_LE(after.total, 2.5 * before.total) << name_of(method, degree);  // the jump of s counts twice, and the mesh is coarse
        }
        const algebra::Vector before(*X, Teuchos::Copy);
        evolution->begin({0.1 * (n - 1), 0.1 * n}, before);
        EXPECT_TRUE(complementarity::newton(evolution->problem(), *X, params.newton, params.stopping, 10, {}, {}).converged);
        evolution->estimate(*X);
        evolution->accept(*X);
        const auto so_far = evolution->estimate_so_far().value();
        EXPECT_GE(so_far.total, evolution->error_so_far().value()) << name_of(method, degree);
        EXPECT_TRUE(holds(so_far)) << name_of(method, degree);
      }
    }
}

TEST(GuaranteeOnRanks, is_the_same_on_any_number_of_them) {
  for (const auto& method : built({"fem", "hho"}))
    for (const int degree : {1, 2}) {
      auto params = on_squares("moving contact", 4, method, degree);
      params.mesh.cells_per_rank = 8;
      const auto together = bounded(params, 2, 0.5, Ending::two_systems),
                 alone = bounded(params, 2, 0.5, Ending::two_systems, core::Comm(MPI_COMM_SELF));
      EXPECT_NEAR(together.so_far.total, alone.so_far.total, 1e-8 * alone.so_far.total) << name_of(method, degree);
      EXPECT_NEAR(together.so_far.linearization, alone.so_far.linearization, 1e-7 * alone.so_far.discretization) << name_of(method, degree);
      EXPECT_NEAR(together.sums.space, alone.sums.space, 1e-8 * alone.sums.space) << name_of(method, degree);
    }
}

/// Bit for bit.
TEST(GuaranteeOnRanks, goes_on_from_a_checkpoint) {
  const core::Comm comm;
  for (const auto& method : built({"fem", "hho"})) {
    auto params = on_squares("moving contact", 4, method, 2);
    params.mesh.cells_per_rank = 8;
    const auto make = method_of(method);
    const auto model = membranes::parabolic_membranes(membranes::membrane_scene(params.scene), make, params.method, params.linear);
    const auto step = [&](models::Evolution& evolution, int n, Teuchos::RCP<algebra::Vector>& X) {
      const algebra::Vector before(*X, Teuchos::Copy);
      evolution.begin({0.1 * (n - 1), 0.1 * n}, before);
      complementarity::newton(evolution.problem(), *X, params.newton, params.stopping, 10, {}, {});
      const Estimate eta = evolution.estimate(*X);
      evolution.accept(*X);
      return eta;
    };
    const auto evolution = model->evolve(params.mesh, comm, "", {});
    auto X = evolution->initial();
    for (int n = 1; n <= 2; ++n) step(*evolution, n, X);
    const auto state = evolution->save(*X);
    const std::string path =
        (std::filesystem::temp_directory_path() / ("bound_checkpoint_" + std::to_string(comm.size()) + ".h5")).string();
    output::write_checkpoint(path, {"", "/", 0, state.attributes, state.blocks}, comm);
    const auto again = model->evolve(params.mesh, comm, "", {});
    auto Y = again->restore(output::read_checkpoint(path, comm));
    for (int n = 3; n <= 4; ++n) {
      const Estimate eta = step(*evolution, n, X), same = step(*again, n, Y);
      EXPECT_EQ(eta.total, same.total);
      EXPECT_EQ(eta.discretization, same.discretization);
      EXPECT_EQ(evolution->estimate_so_far()->total, again->estimate_so_far()->total);
      EXPECT_EQ(evolution->estimate_so_far()->discretization, again->estimate_so_far()->discretization);
    }
  }
}

}  // namespace thixis::verification
