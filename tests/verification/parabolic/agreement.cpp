/// One answer whatever the form of the systems and the number of ranks; the same from a checkpoint and on a finer mesh.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "march.hpp"
#include "thixis/complementarity/newton.hpp"
#include "thixis/core/error.hpp"
#include "thixis/membranes/membranes.hpp"

namespace thixis::verification {
namespace {

using algebra::Vector;

double distance(const Vector& X, const Vector& Y) {
  Vector d(X, Teuchos::Copy);
  d.update(-1, Y, 1);
  return d.normInf();
}

drive::RunParams fit_for_ranks(drive::RunParams params) {
  params.mesh.generator = mesh::Generator::criss_cross;
  params.mesh.cells_per_side = 3;
  params.mesh.refinements = 1;
  params.mesh.cells_per_rank = 12;
  params.newton.scaling = complementarity::Scaling::physical;
  return params;
}

/// Every form and solver that the method has.
std::vector<drive::RunParams> all_ways(drive::RunParams params) {
  std::vector<drive::RunParams> all;
  for (const bool condensed : {true, false})
    for (const auto form : {algebra::SystemForm::full, algebra::SystemForm::reduced})
      for (const auto solver : {algebra::SolverKind::direct, algebra::SolverKind::gmres}) {
        params.method.condensation = condensed;
        params.linear.form = form;
        params.linear.solver = solver;
        all.push_back(params);
      }
  return all;
}

}  // namespace

/// Different tensions, one tension, one that varies; steps whose length changes.
TEST(Agreement, of_all_forms_step_by_step) {
  const auto steps = [](drive::RunParams params) {
    params = fit_for_ranks(params);
    return march(params, 3, 0.3);
  };
  for (const auto& [method, degree] : built(std::vector<std::pair<std::string, int>>{{"fem", 1}, {"fem", 3}, {"hho", 2}}))
    for (const char* name : {"moving contact", "rings"}) {
      const auto ways = all_ways(on_squares(name, 4, method, degree));
      const March reference = steps(ways[0]);
      EXPECT_LE(reference.worst_kkt, 1e-8);
      for (const auto& way : ways) {
        const March run = steps(way);
        EXPECT_EQ(run.newton, reference.newton) << name << ", degree " << degree;
        EXPECT_LE(distance(*run.X, *reference.X), 1e-7) << name << ", degree " << degree;
        EXPECT_LE(run.worst_kkt, 1e-7) << name << ", degree " << degree;
      }
    }
}

TEST(Agreement, on_any_number_of_ranks) {
  for (const auto& [method, degree] : built(std::vector<std::pair<std::string, int>>{{"fem", 1}, {"fem", 2}, {"hho", 1}})) {
    const auto params = fit_for_ranks(on_squares("moving contact", 4, method, degree));
    const March together = march(params, 4, 1), alone = march(params, 4, 1, {}, core::Comm(MPI_COMM_SELF));
    EXPECT_EQ(together.newton, alone.newton);
    ASSERT_EQ(together.series.size(), alone.series.size());
    for (std::size_t n = 0; n < alone.series.size(); ++n)
      for (std::size_t k = 0; k < alone.series[n].size(); ++k)
        EXPECT_NEAR(together.series[n][k], alone.series[n][k], 1e-9 * (1 + std::abs(alone.series[n][k])));
    EXPECT_NEAR(together.evolution->error_so_far().value(), alone.evolution->error_so_far().value(), 1e-9);
  }
}

/// Steps of other lengths in between leave no trace: matrices are those of the step.
TEST(Agreement, after_steps_that_are_begun_again) {
  for (const auto form : {algebra::SystemForm::full, algebra::SystemForm::reduced})
    for (const char* name : {"moving contact", "rings"}) {
      auto params = fit_for_ranks(on_squares(name, 4));
      params.linear.form = form;
      March run = march(params, 2, 0.2), other = march(params, 2, 0.2);
      const Vector before(*run.X, Teuchos::Copy);
      const auto solve = [&](models::Evolution& evolution, models::TimeStep step) {
        Vector X(before, Teuchos::Copy);
        evolution.begin(step, before);
        EXPECT_TRUE(
            complementarity::newton(evolution.problem(), X, params.newton, params.stopping, params.linear.check_every, {}, {}).converged);
        return X;
      };
      solve(*run.evolution, {0.2, 0.9});
      solve(*run.evolution, {0.2, 0.21});
      const Vector X = solve(*run.evolution, {0.2, 0.3}), Y = solve(*other.evolution, {0.2, 0.3});
      EXPECT_EQ(distance(X, Y), 0) << name;
    }
}

TEST(Relaxation, ends_at_the_stationary_solution) {
  for (const auto& [method, degree] : built(std::vector<std::pair<std::string, int>>{{"fem", 1}, {"fem", 2}, {"hho", 2}})) {
    const auto params = fit_for_ranks(on_squares("relaxation", 4, method, degree));
    const March run = march(params, 20, 20);
    EXPECT_EQ(march(params, 1, 1e-3).at(0, "contact_area"), 0);
    EXPECT_GT(run.at(19, "contact_area"), 0.05);
    EXPECT_GT(run.at(19, "contact_force"), 0);
    const auto hierarchy = mesh::build(params.mesh, core::Comm(), "");
    const auto make_space = method_of(method);
    const auto model = membranes::membranes(membranes::membrane_scene(params.scene), make_space, params.method, params.linear, {});
    const auto rest = model->discretize(hierarchy, static_cast<int>(hierarchy.levels.size()) - 1);
    const auto X = rest->cold_start();
    EXPECT_TRUE(complementarity::newton(rest->problem(), *X, params.newton, params.stopping, 10, {}, {}).converged);
    EXPECT_GT(X->normInf(), 0.05);
    EXPECT_LE(distance(*X, *run.X), 1e-8 * X->normInf());
  }
}

TEST(Refinement, keeps_the_functions) {
  auto params = fit_for_ranks(on_squares("rings", 4, "fem", 2));
  March run = march(params, 2, 0.02);
  models::Evolution& evolution = *run.evolution;
  const auto before = evolution.series(*run.X);
  const auto& mesh = evolution.hierarchy()->finest();
  const GlobalIndex cells = evolution.cells();
  std::vector<GlobalIndex> marked;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    if (mesh.cell_id[K] % 3 == 0) marked.push_back(mesh.cell_id[K]);
  const auto X = evolution.refine(marked, *run.X);
  EXPECT_GT(evolution.cells(), cells);
  const auto after = evolution.series(*X);
  EXPECT_NEAR(after[1], before[1], 0.05 * before[1] + 1e-10);
  evolution.begin({0.02, 0.03}, *X);
  Vector Y(*X, Teuchos::Copy);
  EXPECT_TRUE(complementarity::newton(evolution.problem(), Y, params.newton, params.stopping, 10, {}, {}).converged);
  evolution.accept(Y);
  EXPECT_LE(complementarity::verify(evolution.kkt_data(Y)).worst(), 1e-8);
}

/// Nothing to go by in the first step; then complementary at every point, and closer to the end of the step than its begin.
TEST(Prediction, is_admissible_and_closer) {
  for (const auto& [method, degree] : built(std::vector<std::pair<std::string, int>>{{"fem", 1}, {"fem", 2}, {"hho", 1}})) {
    const auto params = fit_for_ranks(on_squares("smooth moving contact", 4, method, degree));
    March run = march(params, 1, 0.05);
    models::Evolution& evolution = *run.evolution;
    const auto fresh = run.model->evolve(params.mesh, core::Comm(), "", {});
    const auto initial = fresh->initial();
    fresh->begin({0, 0.05}, *initial);
    EXPECT_FALSE(fresh->predict(*initial));
    double from_before = 0, from_prediction = 0;
    for (int n = 2; n <= 6; ++n) {
      const Vector before(*run.X, Teuchos::Copy);
      evolution.begin({0.05 * (n - 1), 0.05 * n}, before);
      Vector start(before, Teuchos::Copy);
      ASSERT_TRUE(evolution.predict(start));
      Vector K(evolution.problem().points()), G(evolution.problem().points());
      evolution.problem().arguments(start, K, G);
      const auto gap = algebra::host_view(K), multiplier = algebra::host_view(G);
      for (std::size_t l = 0; l < gap.extent(0); ++l) {
        EXPECT_GE(multiplier(l), 0);
        EXPECT_GE(gap(l), -1e-15);
        EXPECT_LE(std::abs(gap(l) * multiplier(l)), 1e-15);
      }
      complementarity::newton(evolution.problem(), *run.X, params.newton, params.stopping, 10, {}, {});
      evolution.accept(*run.X);
      from_before += distance(before, *run.X);
      from_prediction += distance(start, *run.X);
    }
    EXPECT_LT(from_prediction, from_before) << "degree " << degree;
  }
}

TEST(Checkpoint, brings_everything_to_the_next_step) {
  SKIP_UNLESS_BUILT("hho");
  const core::Comm comm;
  const auto params = fit_for_ranks(on_squares("moving contact", 4, "hho", 2));
  March run = march(params, 3, 0.6);
  const auto state = run.evolution->save(*run.X);
  const std::string path =
      (std::filesystem::temp_directory_path() / ("parabolic_checkpoint_" + std::to_string(comm.size()) + ".h5")).string();
  output::write_checkpoint(path, {"", "/", 0, state.attributes, state.blocks}, comm);
  const auto again = run.model->evolve(params.mesh, comm, "", {});
  const auto X = again->restore(output::read_checkpoint(path, comm));
  EXPECT_EQ(distance(*X, *run.X), 0);
  EXPECT_EQ(again->series(*X), run.evolution->series(*run.X));
  for (models::Evolution* evolution : {again.get(), run.evolution.get()}) {
    evolution->begin({0.6, 0.8}, *X);
    Vector Y(*X, Teuchos::Copy);
    complementarity::newton(evolution->problem(), Y, params.newton, params.stopping, 10, {}, {});
    evolution->accept(Y);
    if (evolution == again.get()) run.X = Teuchos::rcp(new Vector(Y, Teuchos::Copy));
    else EXPECT_EQ(distance(Y, *run.X), 0);
  }
  EXPECT_EQ(again->error_so_far(), run.evolution->error_so_far());
}

/// Mesh, prediction and bound of a run whose mesh was refined twice, bit for bit.
TEST(Checkpoint, brings_the_refined_mesh) {
  const core::Comm comm;
  for (const auto& method : built({"fem", "hho"})) {
    auto params = fit_for_ranks(on_squares("smooth moving contact", 4, method, 2));
    params.mesh.refinements = 0;
    params.mesh.cells_per_rank = 4;
    const auto model =
        membranes::parabolic_membranes(membranes::membrane_scene(params.scene), method_of(method), params.method, params.linear);
    const auto step = [&](models::Evolution& evolution, int n, Teuchos::RCP<Vector>& X) {
      const Vector before(*X, Teuchos::Copy);
      evolution.begin({0.1 * (n - 1), 0.1 * n}, before);
      evolution.predict(*X);
      const auto report = complementarity::newton(evolution.problem(), *X, params.newton, params.stopping, 10, {}, {});
      EXPECT_TRUE(report.converged) << report.why;
      evolution.estimate(*X);
      evolution.accept(*X);
    };
    const auto evolution = model->evolve(params.mesh, comm, "", {});
    auto X = evolution->initial();
    for (int n = 1; n <= 4; ++n) {
      step(*evolution, n, X);
      if (n > 2) continue;
      std::vector<GlobalIndex> marked;  // all of them on all ranks
      for (GlobalIndex id = n; id < evolution->cells(); id += 9) marked.push_back(id);
      X = evolution->refine(marked, *X);
    }
    const auto state = evolution->save(*X);
    const std::string path =
        (std::filesystem::temp_directory_path() / ("refined_checkpoint_" + std::to_string(comm.size()) + ".h5")).string();
    output::write_checkpoint(path, {"", "/", 0, state.attributes, state.blocks}, comm);
    const auto again = model->evolve(params.mesh, comm, "", {});
    EXPECT_LT(again->cells(), evolution->cells());
    auto Y = again->restore(output::read_checkpoint(path, comm));
    ASSERT_EQ(again->cells(), evolution->cells());
    ASSERT_EQ(again->hierarchy()->levels.size(), evolution->hierarchy()->levels.size());
    EXPECT_EQ(distance(*X, *Y), 0);
    for (int n = 5; n <= 6; ++n) {
      step(*evolution, n, X);
      step(*again, n, Y);
      EXPECT_EQ(distance(*X, *Y), 0);
      EXPECT_EQ(evolution->estimate_so_far()->total, again->estimate_so_far()->total);
      EXPECT_EQ(evolution->error_so_far(), again->error_so_far());
    }
  }
}

TEST(Mistakes, are_told_before_the_first_step) {
  const auto told = [](drive::RunParams params) -> std::string {
    try {
      march(params, 1, 0.1);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "";
  };
  auto params = fit_for_ranks(on_squares("rings", 4));
  params.scene.case_name.reset();
  membranes::of(params.scene).data.emplace();
  auto& data = *membranes::of(params.scene).data;
  data.g1 = core::Formula{"1 - 20*t"};
  data.g2 = core::Formula{"0"};
  EXPECT_NE(told(params).find("scene/data/initial: nothing says where the membranes are at time 0"), std::string::npos) << told(params);
  data.initial.emplace();
  data.initial->u1 = core::Formula{"1 - 2*x"};
  EXPECT_NE(told(params).find("give both u1 and u2"), std::string::npos) << told(params);
  data.initial->u2 = core::Formula{"0"};
  EXPECT_NE(told(params).find("the upper membrane begins below the lower one: u1 = "), std::string::npos) << told(params);
  data.initial->u1 = core::Formula{"1"};
  EXPECT_NE(told(params).find("t = 0.1; give boundary data with g1 >= g2"), std::string::npos) << told(params);
  data.g1 = core::Formula{"1"};
  EXPECT_EQ(told(params), "");
  data.mu1 = core::Formula{"1 + t"};
  EXPECT_NE(told(params).find("scene/data/mu1: a tension must not depend on time"), std::string::npos) << told(params);
}

}  // namespace thixis::verification
