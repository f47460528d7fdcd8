/// Fluxes with a given divergence, by the hierarchy.
#include "thixis/equilibration/multilevel_flux.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "flux_checks.hpp"
#include "thixis/mesh/build.hpp"

namespace thixis::equilibration {
namespace {

struct Case {
  mesh::Generator generator;
  int refinements, cells_per_rank;
};

class Lift : public testing::TestWithParam<std::tuple<Case, int>> {
 protected:
  Lift() {
    const auto& [of, q] = GetParam();
    mesh::MeshParams params;
    params.generator = of.generator;
    params.refinements = of.refinements;
    params.cells_per_rank = of.cells_per_rank;
    params.cells_per_side = 2;
    params.rings = 2;
    hierarchy = mesh::build(params, core::Comm(), "");
    level = of.refinements;
  }
  const mesh::Mesh& finest() const { return hierarchy.levels[level]; }
  std::vector<bool> held() const { return std::vector<bool>(finest().tags.size(), true); }

  mesh::Hierarchy hierarchy;
  int level;
};

/// Values that depend on the id of the cell alone.
CellTable noise(const mesh::Mesh& mesh, int modes) {
  const CellTable r("noise", mesh.owned_cells, modes);
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
    std::mt19937 random(static_cast<unsigned>(mesh.cell_id[K]));
    for (int k = 0; k < modes; ++k) r(K, k) = std::uniform_real_distribution<double>(-1, 1)(random);
  }
  return r;
}

TEST_P(Lift, has_the_divergence_and_continuous_normal_fluxes) {
  const int q = std::get<1>(GetParam());
  const MultilevelFlux lift(mesh::ancestry(hierarchy, level), finest().comm, held(), q);
  const CellTable r = noise(finest(), reference::dimension(q)), sigma("sigma", finest().owned_cells, 2 * reference::dimension(q + 1));
  lift(r, sigma);
  EXPECT_LE(divergence_error(finest(), q, sigma, r), 1e-10);
  EXPECT_LE(jump_of_normal_flux(finest(), q, sigma), 1e-10);
}

TEST_P(Lift, is_the_same_on_any_number_of_ranks) {
  const int q = std::get<1>(GetParam());
  const auto norm = [&](const mesh::Hierarchy& of) {
    const mesh::Mesh& mesh = of.levels[level];
    const MultilevelFlux lift(mesh::ancestry(of, level), mesh.comm, std::vector<bool>(mesh.tags.size(), true), q);
    const CellTable r = noise(mesh, reference::dimension(q)), sigma("sigma", mesh.owned_cells, 2 * reference::dimension(q + 1));
    lift(r, sigma);
    return energy(mesh, sigma);
  };
  const auto& of = std::get<0>(GetParam());
  mesh::MeshParams params;
  params.generator = of.generator;
  params.refinements = of.refinements;
  params.cells_per_side = 2;
  params.rings = 2;
  const double alone = norm(mesh::build(params, core::Comm(MPI_COMM_SELF), ""));
  EXPECT_NEAR(norm(hierarchy), alone, 1e-10 * alone);
}

INSTANTIATE_TEST_SUITE_P(uniform, Lift,
                         testing::Combine(testing::Values(Case{mesh::Generator::criss_cross, 0, 1000},
                                                          Case{mesh::Generator::criss_cross, 3, 30},
                                                          Case{mesh::Generator::criss_cross, 2, 100000}, Case{mesh::Generator::disk, 2, 20},
                                                          Case{mesh::Generator::rectangle, 2, 1}),
                                          testing::Values(0, 1, 2, 3, 4)));

/// The lift is efficient: for residuals of smooth functions the flux is not much larger than the dual norm, on any level.
TEST(LiftOfSmoothResiduals, stays_near_the_dual_norm_under_refinement) {
  double ratio_before = 0;
  for (const int refinements : {1, 3, 5}) {
    mesh::MeshParams params;
    params.cells_per_side = 2;
    params.refinements = refinements;
    const auto hierarchy = mesh::build(params, core::Comm(), "");
    const auto& mesh = hierarchy.finest();
    const MultilevelFlux lift(mesh::ancestry(hierarchy, refinements), mesh.comm, std::vector<bool>(mesh.tags.size(), true), 1);
    const auto owned = method::owned_cells(mesh);
    const auto metric = metrics(mesh, owned);
    const CellTable r("r", mesh.owned_cells, 3), sigma("sigma", mesh.owned_cells, 12);
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K) r(K, 0) = metric(K).det * std::sqrt(0.5);  // r = 1: |r|_* = |grad w|, -Δw = 1
    lift(r, sigma);
    const double ratio = std::sqrt(energy(mesh, sigma) / 0.0351442537);  // ∫ w over the unit square
    EXPECT_GE(ratio, 1);
    EXPECT_LE(ratio, 1.5);
    if (ratio_before > 0) {
      EXPECT_NEAR(ratio, ratio_before, 0.1);
    }
    ratio_before = ratio;
  }
}

}  // namespace
}  // namespace thixis::equilibration
