/// The bound on several ranks, the adaptive meshes that come from it, and what it costs where nobody asks for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "iterates.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::verification {
namespace {

drive::RunParams tightly(drive::RunParams params) {
  params.stopping.linear_tolerance = 1e-13;
  params.stopping.nonlinear_tolerance = 1e-11;
  params.mesh.cells_per_rank = 20;
  return params;
}

void expect_same(double a, double b, double scale, const std::string& where) { EXPECT_NEAR(a, b, 1e-8 * scale) << where; }

}  // namespace

TEST(BoundOnRanks, is_the_same_on_any_number_of_ranks) {
  for (const char* problem : {"discontinuous multiplier", "disk b", "radial obstacle"})
    for (int p = 1; p <= 2; ++p)
      for (const auto& [name, method] : all_methods(p)) {
        auto params = tightly(known_case(problem, 1, method));
        params.stopping.estimate = true;
        const Solved together = solve(params), alone = solve(params, core::Comm(MPI_COMM_SELF));
        const std::string where = std::string(problem) + ", " + name;
        ASSERT_TRUE(together.outcome.solved && alone.outcome.solved) << where << ": " << together.outcome.finest.why;
        const auto a = *together.outcome.estimate, b = *alone.outcome.estimate;
        expect_same(a.total, b.total, b.total, where + ", total");
        expect_same(a.discretization, b.discretization, b.discretization, where + ", discretization");
        expect_same(a.linearization, b.linearization, b.total, where + ", linearization");
        expect_same(a.algebraic, b.algebraic, b.total, where + ", algebraic");
      }
}

/// A vector that solves nothing: all components are large.
TEST(BoundOnRanks, of_a_start_far_from_the_solution_is_the_same_on_any_number_of_ranks) {
  for (const char* problem : {"discontinuous multiplier", "disk"})
    for (int p = 1; p <= 2; ++p)
      for (const auto& [name, method] : all_methods(p)) {
        const auto params = tightly(known_case(problem, 1, method));
        const auto start = [&](const core::Comm& comm) {
          const Laid laid = lay(params, comm);
          return laid.look(*laid->cold_start());
        };
        const Seen together = start(core::Comm()), alone = start(core::Comm(MPI_COMM_SELF));
        const std::string where = std::string(problem) + ", " + name;
        expect_same(together.eta.total, alone.eta.total, alone.eta.total, where + ", total");
        expect_same(together.eta.discretization, alone.eta.discretization, alone.eta.total, where + ", discretization");
        expect_same(together.eta.linearization, alone.eta.linearization, alone.eta.total, where + ", linearization");
        expect_same(together.eta.algebraic, alone.eta.algebraic, alone.eta.total, where + ", algebraic");
        EXPECT_GE(together.effectivity(), 1) << where;
      }
}

namespace {

struct MeshOf {
  GlobalIndex cells;
  std::vector<std::array<double, 2>> vertices;  ///< of all ranks, sorted
  double bound;
  int level;
};

MeshOf adapted(const drive::RunParams& params, const core::Comm& comm) {
  const Solved run = solve(params, comm);
  EXPECT_TRUE(run.outcome.solved) << run.outcome.finest.why;
  const auto& mesh = *run.outcome.mesh;
  const auto host = mesh::on_host(mesh);
  std::vector<std::array<double, 2>> own;
  for (LocalIndex v = 0; v < mesh.vertices; ++v)
    if (mesh.vertex_owner[v] == mesh.comm.rank()) own.push_back({host.coordinates(v, 0), host.coordinates(v, 1)});
  auto all = mesh.comm.gather(own);
  std::sort(all.begin(), all.end());
  return {mesh.global_cells, all, run.outcome.estimate->total, run.outcome.at.level};
}

void expect_the_same_mesh(const drive::RunParams& params, const std::string& name) {
  const MeshOf together = adapted(params, core::Comm()), alone = adapted(params, core::Comm(MPI_COMM_SELF));
  EXPECT_EQ(together.level, alone.level) << name;
  EXPECT_EQ(together.cells, alone.cells) << name;
  ASSERT_EQ(together.vertices.size(), alone.vertices.size()) << name;
  double distance = 0;
  for (std::size_t v = 0; v < alone.vertices.size(); ++v)
    for (int d = 0; d < 2; ++d) distance = std::max(distance, std::abs(together.vertices[v][d] - alone.vertices[v][d]));
  EXPECT_EQ(distance, 0) << name;
  EXPECT_NEAR(together.bound, alone.bound, 1e-7 * alone.bound) << name;
  EXPECT_GT(alone.level, 2) << name;
}

}  // namespace

TEST(AdaptiveMeshes, are_the_same_on_any_number_of_ranks) {
  for (int p = 1; p <= 2; ++p)
    for (const auto& [name, method] : all_methods(p)) {
      auto params = tightly(known_case("discontinuous multiplier", 0, method));
      params.adapt = drive::AdaptParams();
      params.adapt->max_levels = 4;
      expect_the_same_mesh(params, name);
    }
}

TEST(AdaptiveMeshes, on_the_way_to_a_target_are_the_same_on_any_number_of_ranks) {
  auto params = tightly(known_case("discontinuous multiplier", 0, by("fem", 1)));
  params.stopping.target = 0.03;
  expect_the_same_mesh(params, "target 0.03");
  auto on_disk = tightly(known_case("disk b", 0, by("fem", 2)));
  on_disk.stopping.target = 0.01;
  expect_the_same_mesh(on_disk, "disk, target 0.01");
}

namespace {

std::size_t allocations_of_bounds = 0;

/// Kokkos allocations of the estimate in a whole run.
std::size_t allocations_in(const drive::RunParams& params) {
  Kokkos::Tools::Experimental::set_allocate_data_callback(
      [](Kokkos_Profiling_SpaceHandle, const char* label, const void*, const std::uint64_t) {
        for (const char* package : {"thixis::bound", "thixis::equilibration"})
          if (std::strncmp(label, package, std::strlen(package)) == 0) ++allocations_of_bounds;
      });
  allocations_of_bounds = 0;
  solve(params);
  Kokkos::Tools::Experimental::set_allocate_data_callback(nullptr);
  return allocations_of_bounds;
}

}  // namespace

TEST(BoundOnRequest, allocates_nothing_where_nobody_asks_for_it) {
  for (const auto& [name, method] : all_methods(2)) {
    auto params = known_case("discontinuous multiplier", 0, method);
    for (const auto rule : {complementarity::StoppingRule::exact, complementarity::StoppingRule::inexact}) {
      params.stopping.rule = rule;
      EXPECT_EQ(allocations_in(params), 0u) << name;
    }
    params.stopping.rule = complementarity::StoppingRule::exact;
    params.stopping.estimate = true;
    EXPECT_GT(allocations_in(params), 10u) << name;
    params.stopping.estimate = {};
    params.stopping.rule = complementarity::StoppingRule::adaptive;
    EXPECT_GT(allocations_in(params), 10u) << name;
  }
}

}  // namespace thixis::verification
