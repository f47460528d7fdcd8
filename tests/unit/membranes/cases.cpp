#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene/sample.hpp"
#include "thixis/core/error.hpp"
#include "thixis/membranes/family.hpp"
#include "thixis/membranes/scene.hpp"

namespace thixis::membranes {
namespace {

using scene::FieldPtr;
using scene::ring;
using scene::Sample;

/// A case with the name of its model.
struct Case {
  std::string name, model, sentence;
};
std::vector<Case> cases() {
  std::vector<Case> all;
  for (const models::Entry& entry : family().models)
    for (const models::Case& known : entry.cases) all.push_back({known.name, entry.name, known.sentence});
  return all;
}

MembraneScene catalogued(const std::string& name) {
  models::SceneParams params;
  params.case_name = name;
  for (const Case& c : cases())
    if (c.name == name) params.model = c.model;
  return membrane_scene(params);
}

/// The cases without time.
std::vector<Case> still_cases() {
  std::vector<Case> still;
  for (const Case& c : cases())
    if (c.model == "membranes" || c.model == "obstacle") still.push_back(c);
  return still;
}

/// Their scenes whose solution is known.
std::vector<MembraneScene> solved_scenes() {
  std::vector<MembraneScene> scenes;
  for (const Case& c : still_cases())
    if (MembraneScene scene = catalogued(c.name); scene.exact) scenes.push_back(scene);
  return scenes;
}

/// What the upper membrane may touch: the lower one, or the obstacle.
FieldPtr below(const MembraneScene& scene) { return scene.count == 1 ? scene.obstacle : scene.exact->u[1]; }

/// Where a case lives, and its circle.
struct Geometry {
  double centre, R, outside;
};
Geometry geometry(const std::string& name) {
  if (name.find("disk") == 0) return {0, std::sqrt(0.5), 1};
  if (name == "radial obstacle") return {0, 0.6, 1};
  return {0.5, 1.0 / 3, 0.5};
}

/// Points on both sides of the circle, so far from it that differences of step `step` do not cross it.
std::vector<Sample> both_sides(const Geometry& g, double step) {
  return {ring(g.centre, g.centre, 0.05, g.R - 5 * step), ring(g.centre, g.centre, g.R + 5 * step, g.outside)};
}

constexpr double step = 2e-3;

TEST(Case, solves_its_equations_on_both_sides_of_the_interface) {
  for (const MembraneScene& scene : solved_scenes()) {
    for (const Sample& sample : both_sides(geometry(scene.name), step))
      for (int alpha = 0; alpha < scene.count; ++alpha) {
        const auto gradient = scene.exact->gradient[alpha];
        const auto xx = sample(difference_gradient(gradient[0], step)[0]), yy = sample(difference_gradient(gradient[1], step)[1]);
        const auto lambda = sample(scene.exact->multiplier), f = sample(scene.force[alpha]), mu = sample(scene.tension[alpha]);
        for (std::size_t i = 0; i < sample.size(); ++i)
          EXPECT_NEAR(-mu[i] * (xx[i] + yy[i]) - (alpha == 0 ? 1 : -1) * lambda[i], f[i], 2e-10)
              << scene.name << ", membrane " << alpha + 1;
      }
  }
}

TEST(Case, states_the_gradient_of_its_solution) {
  for (const MembraneScene& scene : solved_scenes()) {
    for (const Sample& sample : both_sides(geometry(scene.name), step))
      for (int alpha = 0; alpha < scene.count; ++alpha) {
        const auto differences = difference_gradient(scene.exact->u[alpha], step);
        for (const int direction : {0, 1}) {
          const auto stated = sample(scene.exact->gradient[alpha][direction]), checked = sample(differences[direction]);
          for (std::size_t i = 0; i < sample.size(); ++i) EXPECT_NEAR(stated[i], checked[i], 1e-11) << scene.name;
        }
      }
  }
}

TEST(Case, is_complementary) {
  for (const MembraneScene& scene : solved_scenes()) {
    const Geometry g = geometry(scene.name);
    const Sample sample = ring(g.centre, g.centre, 0, g.outside, 5000);
    const auto u1 = sample(scene.exact->u[0]), u2 = sample(below(scene)), lambda = sample(scene.exact->multiplier);
    const auto level_set = sample(scene.interface_level_set);
    for (std::size_t i = 0; i < sample.size(); ++i) {
      EXPECT_GE(u1[i] - u2[i], -1e-16) << scene.name;
      EXPECT_GE(lambda[i], 0) << scene.name;
      EXPECT_EQ((u1[i] - u2[i]) * lambda[i], 0) << scene.name;
      EXPECT_EQ(level_set[i]<0, lambda[i]> 0) << scene.name << ": contact is where the level set is negative";
      if (level_set[i] > 1e-3) {
        EXPECT_GT(u1[i] - u2[i], 0) << scene.name;
      }
    }
  }
}

TEST(Case, has_continuous_values_and_gradients_across_the_interface) {
  constexpr double epsilon = 1e-10;
  for (const MembraneScene& scene : solved_scenes()) {
    const Geometry g = geometry(scene.name);
    Sample inside, outside;
    for (double phi = 0; phi < 6; phi += 0.1) {
      inside.add(g.centre + (g.R - epsilon) * std::cos(phi), g.centre + (g.R - epsilon) * std::sin(phi));
      outside.add(g.centre + (g.R + epsilon) * std::cos(phi), g.centre + (g.R + epsilon) * std::sin(phi));
    }
    for (int alpha = 0; alpha < scene.count; ++alpha)
      for (const FieldPtr& field : {scene.exact->u[alpha], scene.exact->gradient[alpha][0], scene.exact->gradient[alpha][1]}) {
        const auto left = inside(field), right = outside(field);
        for (std::size_t i = 0; i < left.size(); ++i) EXPECT_NEAR(left[i], right[i], 1e-9) << scene.name;
      }
  }
}

TEST(Case, takes_the_trace_of_its_solution_as_boundary_data_and_these_are_ordered) {
  for (const MembraneScene& scene : solved_scenes()) {
    const Geometry g = geometry(scene.name);
    const Sample sample = g.centre == 0 ? ring(0, 0, 0.9, 1) : ring(0.5, 0.5, 0.5, std::sqrt(0.5));
    EXPECT_EQ(scene.default_boundary.kind, BoundaryKind::dirichlet);
    EXPECT_TRUE(scene.boundary.empty());
    const auto upper = sample(scene.default_boundary.value[0]), lower = sample(below(scene));
    for (int alpha = 0; alpha < scene.count; ++alpha) EXPECT_EQ(sample(scene.default_boundary.value[alpha]), sample(scene.exact->u[alpha]));
    for (std::size_t i = 0; i < upper.size(); ++i) EXPECT_GT(upper[i], lower[i]) << scene.name;
  }
}

TEST(Case, is_finite_at_the_centre_of_the_disk) {
  Sample origin;
  origin.add(0, 0);
  for (const char* name : {"disk", "disk b"}) {
    const MembraneScene scene = catalogued(name);
    for (const int alpha : {0, 1}) {
      EXPECT_NEAR(origin(scene.exact->u[alpha])[0], -0.05, 1e-16);
      EXPECT_EQ(origin(scene.exact->gradient[alpha][0])[0], 0);
    }
    EXPECT_NEAR(origin(scene.force[0])[0], -0.5, 1e-15);
    EXPECT_NEAR(origin(scene.force[1])[0], -0.3, 1e-15);
    EXPECT_NEAR(origin(scene.exact->multiplier)[0], 0.1, 1e-15);
  }
}

TEST(Case, of_the_radial_obstacle_is_a_paraboloid_inside_of_its_circle_and_a_logarithm_outside) {
  const MembraneScene scene = catalogued("radial obstacle");
  Sample points;
  points.add(0, 0);
  points.add(0, 0.6);
  points.add(1, 0);
  const auto u = points(scene.exact->u[0]), psi = points(scene.obstacle);
  EXPECT_NEAR(u[0], 0.5, 1e-15);
  EXPECT_NEAR(u[1], 0.14, 1e-15);
  EXPECT_NEAR(u[2], 0.14 + 0.72 * std::log(0.6), 1e-15);
  EXPECT_EQ(u[0], psi[0]);
  EXPECT_NEAR(psi[2], -0.5, 1e-15);
  EXPECT_EQ(points(scene.exact->multiplier)[0], 4);
}

TEST(Case, of_torsion_has_contact_on_the_unit_square_and_the_unit_disk) {
  const MembraneScene scene = catalogued("torsion");
  EXPECT_FALSE(scene.exact);
  EXPECT_EQ(*scene.default_boundary.value[0]->constant(), 0);
  const double psi = *scene.obstacle->constant(), f = *scene.force[0]->constant();
  EXPECT_LT(psi, 0);
  // both domains contain a disk of radius R; without the obstacle -Lap u = f in it and u <= 0 on its edge, so u <= f (R^2 - r^2)/4
  const double R = 0.5;
  EXPECT_LT(f * R * R / 4, 1.5 * psi);
}

TEST(Case, starts_the_disks_from_flat_membranes) {
  for (const char* name : {"disk", "disk b"}) {
    const MembraneScene scene = catalogued(name);
    EXPECT_EQ(*scene.initial[0]->constant(), 0.05);
    EXPECT_EQ(*scene.initial[1]->constant(), 0);
    EXPECT_EQ(*scene.initial[2]->constant(), 0);
  }
  for (const FieldPtr& start : catalogued("smooth contact").initial) EXPECT_EQ(start, nullptr);
}

TEST(Case, has_unit_tensions_that_kernels_may_take_as_constant) {
  for (const Case& c : still_cases()) {
    const MembraneScene scene = catalogued(c.name);
    for (int alpha = 0; alpha < scene.count; ++alpha) EXPECT_EQ(*scene.tension[alpha]->constant(), 1);
    EXPECT_EQ(scene.name, c.name);
    EXPECT_EQ(scene.sentence, c.sentence);
  }
}

TEST(Case, over_an_obstacle_has_one_membrane_and_leaves_the_other_null) {
  for (const Case& c : still_cases()) {
    const MembraneScene scene = catalogued(c.name);
    const bool one = c.model == "obstacle";
    EXPECT_EQ(scene.count, one ? 1 : 2) << c.name;
    EXPECT_EQ(scene.obstacle != nullptr, one) << c.name;
    for (const FieldPtr& second : {scene.tension[1], scene.force[1], scene.default_boundary.value[1]})
      EXPECT_EQ(second == nullptr, one) << c.name;
    if (scene.exact) {
      EXPECT_EQ(scene.exact->u[1] == nullptr, one) << c.name;
      EXPECT_EQ(scene.exact->gradient[1][0] == nullptr, one) << c.name;
    }
  }
}

}  // namespace
}  // namespace thixis::membranes
