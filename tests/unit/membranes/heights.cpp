#include "scene/heights.hpp"

#include <gtest/gtest.h>

#include "scene/sample.hpp"

namespace thixis::membranes {
namespace {

scene::FieldPtr height(const std::string& text) { return scene::expression("height", text, {0, 0}, {}); }

double at(const scene::FieldPtr& field, double x, double y) {
  scene::Sample sample;
  sample.add(x, y);
  return sample(field).front();
}

}  // namespace

TEST(Heights, are_counted_from_an_origin) {
  MembraneScene scene;
  scene.count = 1;
  scene.obstacle = height("5 + x");
  scene.default_boundary.kind = BoundaryKind::dirichlet;
  scene.default_boundary.value[0] = height("6 + y");
  scene.boundary["left"] = {BoundaryKind::neumann, {height("x"), nullptr}};
  const MembraneScene counted = counted_from(5, scene);
  EXPECT_NEAR(at(counted.obstacle, 0.25, 0), 0.25, 1e-14);
  EXPECT_NEAR(at(counted.default_boundary.value[0], 0, 0.25), 1.25, 1e-14);
  EXPECT_EQ(counted.boundary.at("left").value[0], scene.boundary.at("left").value[0]);
}

}  // namespace thixis::membranes
