#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sample.hpp"
#include "thixis/scene/membranes.hpp"

namespace thixis::scene {
namespace {

MembraneScene catalogued(const std::string& name) {
  SceneParams params;
  params.case_name = name;
  return membrane_scene(params);
}

/// Where a case lives, and its circle.
struct Geometry {
  double centre, R, outside;
};
Geometry geometry(const std::string& name) {
  if (name.find("disk") == 0) return {0, std::sqrt(0.5), 1};
  return {0.5, 1.0 / 3, 0.5};
}

/// Points on both sides of the circle, so far from it that differences of step `step` do not cross it.
std::vector<Sample> both_sides(const Geometry& g, double step) {
  return {ring(g.centre, g.centre, 0.05, g.R - 5 * step), ring(g.centre, g.centre, g.R + 5 * step, g.outside)};
}

constexpr double step = 2e-3;

TEST(Case, solves_its_equations_on_both_sides_of_the_interface) {
  for (const Case& c : cases()) {
    const MembraneScene scene = catalogued(c.name);
    for (const Sample& sample : both_sides(geometry(c.name), step))
      for (const int alpha : {0, 1}) {
        const auto gradient = scene.exact->gradient[alpha];
        const auto xx = sample(difference_gradient(gradient[0], step)[0]), yy = sample(difference_gradient(gradient[1], step)[1]);
        const auto lambda = sample(scene.exact->multiplier), f = sample(scene.force[alpha]), mu = sample(scene.tension[alpha]);
        for (std::size_t i = 0; i < sample.size(); ++i)
          EXPECT_NEAR(-mu[i] * (xx[i] + yy[i]) - (alpha == 0 ? 1 : -1) * lambda[i], f[i], 2e-10) << c.name << ", membrane " << alpha + 1;
      }
  }
}

TEST(Case, states_the_gradient_of_its_solution) {
  for (const Case& c : cases()) {
    const MembraneScene scene = catalogued(c.name);
    for (const Sample& sample : both_sides(geometry(c.name), step))
      for (const int alpha : {0, 1}) {
        const auto differences = difference_gradient(scene.exact->u[alpha], step);
        for (const int direction : {0, 1}) {
          const auto stated = sample(scene.exact->gradient[alpha][direction]), checked = sample(differences[direction]);
          for (std::size_t i = 0; i < sample.size(); ++i) EXPECT_NEAR(stated[i], checked[i], 1e-11) << c.name;
        }
      }
  }
}

TEST(Case, is_complementary) {
  for (const Case& c : cases()) {
    const MembraneScene scene = catalogued(c.name);
    const Geometry g = geometry(c.name);
    const Sample sample = ring(g.centre, g.centre, 0, g.outside, 5000);
    const auto u1 = sample(scene.exact->u[0]), u2 = sample(scene.exact->u[1]), lambda = sample(scene.exact->multiplier);
    const auto level_set = sample(scene.interface_level_set);
    for (std::size_t i = 0; i < sample.size(); ++i) {
      EXPECT_GE(u1[i] - u2[i], -1e-16) << c.name;
      EXPECT_GE(lambda[i], 0) << c.name;
      EXPECT_EQ((u1[i] - u2[i]) * lambda[i], 0) << c.name;
      EXPECT_EQ(level_set[i]<0, lambda[i]> 0) << c.name << ": contact is where the level set is negative";
      if (level_set[i] > 1e-3) {
        EXPECT_GT(u1[i] - u2[i], 0) << c.name;
      }
    }
  }
}

TEST(Case, has_continuous_values_and_gradients_across_the_interface) {
  constexpr double epsilon = 1e-10;
  for (const Case& c : cases()) {
    const MembraneScene scene = catalogued(c.name);
    const Geometry g = geometry(c.name);
    Sample inside, outside;
    for (double phi = 0; phi < 6; phi += 0.1) {
      inside.add(g.centre + (g.R - epsilon) * std::cos(phi), g.centre + (g.R - epsilon) * std::sin(phi));
      outside.add(g.centre + (g.R + epsilon) * std::cos(phi), g.centre + (g.R + epsilon) * std::sin(phi));
    }
    for (const int alpha : {0, 1})
      for (const FieldPtr& field : {scene.exact->u[alpha], scene.exact->gradient[alpha][0], scene.exact->gradient[alpha][1]}) {
        const auto left = inside(field), right = outside(field);
        for (std::size_t i = 0; i < left.size(); ++i) EXPECT_NEAR(left[i], right[i], 1e-9) << c.name;
      }
  }
}

TEST(Case, takes_the_trace_of_its_solution_as_boundary_data_and_these_are_ordered) {
  for (const Case& c : cases()) {
    const MembraneScene scene = catalogued(c.name);
    const Geometry g = geometry(c.name);
    const Sample sample = g.centre == 0 ? ring(0, 0, 0.9, 1) : ring(0.5, 0.5, 0.5, std::sqrt(0.5));
    EXPECT_EQ(scene.default_boundary.kind, BoundaryKind::dirichlet);
    EXPECT_TRUE(scene.boundary.empty());
    const auto g1 = sample(scene.default_boundary.value[0]), g2 = sample(scene.default_boundary.value[1]);
    EXPECT_EQ(g1, sample(scene.exact->u[0]));
    EXPECT_EQ(g2, sample(scene.exact->u[1]));
    for (std::size_t i = 0; i < g1.size(); ++i) EXPECT_GT(g1[i], g2[i]) << c.name;
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
  for (const Case& c : cases()) {
    const MembraneScene scene = catalogued(c.name);
    EXPECT_EQ(*scene.tension[0]->constant(), 1);
    EXPECT_EQ(*scene.tension[1]->constant(), 1);
    EXPECT_EQ(scene.name, c.name);
    EXPECT_EQ(scene.sentence, c.sentence);
  }
}

}  // namespace
}  // namespace thixis::scene
