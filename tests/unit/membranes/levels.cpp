/// What lives on the levels of a hierarchy is made once, and let go of when the run has left the level.
#include <gtest/gtest.h>

#include "methods.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/membranes/membranes.hpp"
#include "thixis/membranes/parabolic_membranes.hpp"
#include "thixis/mesh/build.hpp"

namespace thixis::membranes {
namespace {

class LevelsOfMembranes : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    SKIP_UNLESS_BUILT(GetParam());
    mesh_.refinements = 2;
    mesh_.cells_per_side = 2;
    mesh_.cells_per_rank = 10;
    method_.name = GetParam();
    by_ = tests::method_of(method_.name);
    by_.make_space = [this, make = by_.make_space](const mesh::Mesh& mesh, const method::SpaceOptions& options) {
      ++made_;
      return make(mesh, options);
    };
  }
  static MembraneScene scene(const char* model, const char* name) {
    models::SceneParams params;
    params.model = model;
    params.case_name = name;
    return membrane_scene(params);
  }

  mesh::MeshParams mesh_;
  method::MethodParams method_;
  method::Method by_;
  int made_ = 0;  ///< spaces
};

}  // namespace

TEST_P(LevelsOfMembranes, a_nested_run_makes_each_space_once) {
  const auto hierarchy = mesh::build(mesh_, core::Comm(), ".");
  const auto model = membranes(scene(model::two, "discontinuous multiplier"), by_, method_, {}, {});
  auto on_mesh = model->discretize(hierarchy, 0);
  auto X = on_mesh->cold_start();
  for (int level = 1; level <= 2; ++level) {
    auto finer = model->discretize(hierarchy, level);
    X = finer->nested_start(*on_mesh, *X);
    on_mesh = std::move(finer);
    EXPECT_EQ(made_, level + 1);
  }
  const auto beside = model->discretize(hierarchy, 2);
  EXPECT_EQ(made_, 3);
  on_mesh = model->discretize(hierarchy, 1);
  EXPECT_EQ(made_, 4) << "the space of level 1 was kept when level 2 had begun";
  on_mesh = model->discretize(hierarchy, 2);
  EXPECT_EQ(made_, 5) << "the space of level 2 was kept when the run had gone back";
}

TEST_P(LevelsOfMembranes, another_hierarchy_has_other_levels) {
  const auto model = membranes(scene(model::two, "discontinuous multiplier"), by_, method_, {}, {});
  for (int run = 1; run <= 2; ++run) {
    const auto hierarchy = mesh::build(mesh_, core::Comm(), ".");
    const auto on_mesh = model->discretize(hierarchy, 2);
    EXPECT_EQ(on_mesh->cells(), hierarchy.finest().global_cells);
    EXPECT_EQ(made_, run);
  }
}

TEST_P(LevelsOfMembranes, a_refinement_in_time_makes_one_space) {
  const auto model = parabolic_membranes(scene(model::in_time, "relaxation"), by_, method_, {}, {});
  const auto evolution = model->evolve(mesh_, core::Comm(), ".", {});
  auto X = evolution->initial();
  EXPECT_EQ(made_, 1);
  for (int round = 1; round <= 2; ++round) {
    const mesh::Mesh& mesh = evolution->hierarchy()->finest();
    std::vector<GlobalIndex> marked;
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
      if (mesh.cell_id[K] % 3 == 0) marked.push_back(mesh.cell_id[K]);
    X = evolution->refine(marked, *X);
    EXPECT_EQ(made_, 1 + round);
    EXPECT_EQ(X->getMap()->getGlobalNumElements(), evolution->problem().map()->getGlobalNumElements());
  }
}

INSTANTIATE_TEST_SUITE_P(Membranes, LevelsOfMembranes, ::testing::Values("fem", "dg", "hho"), [](const auto& name) { return name.param; });

}  // namespace thixis::membranes
