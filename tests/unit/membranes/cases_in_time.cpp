/// The catalogued membranes in time.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/sample.hpp"
#include "thixis/membranes/scene.hpp"

namespace thixis::membranes {
namespace {

using scene::constant;
using scene::difference_gradient;
using scene::expression;
using scene::FieldPtr;
using scene::formula;
using scene::ring;
using scene::Sample;

constexpr double step = 2e-3;
const double times[] = {0, 0.1, 0.37, 0.5, 0.8, 1};

MembraneScene catalogued(const std::string& name) {
  models::SceneParams params;
  params.model = "parabolic membranes";
  params.case_name = name;
  return membrane_scene(params);
}

const char* const solved[] = {"moving contact", "smooth moving contact", "resting contact"};

double radius(const std::string& name, double t) { return name == "resting contact" ? 0.25 : 0.25 + 0.1 * std::sin(2 * M_PI * t); }

/// Points inside and outside of the contact disk, so far from its edge that differences in place and time do not cross it.
std::vector<Sample> both_sides(const std::string& name, double t) {
  const double R = radius(name, t);
  return {ring(0.5, 0.5, 0.01, R - 5 * step, 200), ring(0.5, 0.5, R + 5 * step, 0.5, 200)};
}

/// By central differences of order 6.
std::vector<double> rate(const FieldPtr& u, const Sample& sample, double t) {
  constexpr double weight[3] = {45.0 / 60, -9.0 / 60, 1.0 / 60}, tau = 1e-3;
  std::vector<double> sum(sample.size(), 0.0);
  for (int k = 1; k <= 3; ++k)
    for (const int sign : {1, -1}) {
      const auto there = sample(u, t + sign * k * tau);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += sign * weight[k - 1] / tau * there[i];
    }
  return sum;
}

TEST(CaseInTime, solves_its_equations_on_both_sides_of_the_edge) {
  for (const char* name : solved) {
    const MembraneScene scene = catalogued(name);
    for (const double t : times)
      for (const Sample& sample : both_sides(name, t))
        for (int alpha = 0; alpha < 2; ++alpha) {
          const auto gradient = scene.exact->gradient[alpha];
          const auto xx = sample(difference_gradient(gradient[0], step)[0], t), yy = sample(difference_gradient(gradient[1], step)[1], t);
          const auto u_t = rate(scene.exact->u[alpha], sample, t), lambda = sample(scene.exact->multiplier, t),
                     f = sample(scene.force[alpha], t), mu = sample(scene.tension[alpha], t);
          for (std::size_t i = 0; i < sample.size(); ++i)
            ASSERT_NEAR(u_t[i] - mu[i] * (xx[i] + yy[i]) - (alpha == 0 ? 1 : -1) * lambda[i], f[i], 1e-7) << name << ", t = " << t;
        }
  }
}

TEST(CaseInTime, states_the_gradient_of_its_solution) {
  for (const char* name : solved) {
    const MembraneScene scene = catalogued(name);
    for (const double t : times)
      for (const Sample& sample : both_sides(name, t))
        for (int alpha = 0; alpha < 2; ++alpha) {
          const auto differences = difference_gradient(scene.exact->u[alpha], step);
          for (const int direction : {0, 1}) {
            const auto stated = sample(scene.exact->gradient[alpha][direction], t), checked = sample(differences[direction], t);
            for (std::size_t i = 0; i < sample.size(); ++i) ASSERT_NEAR(stated[i], checked[i], 1e-9) << name << ", t = " << t;
          }
        }
  }
}

TEST(CaseInTime, is_complementary_with_contact_inside_of_the_edge) {
  for (const char* name : solved) {
    const MembraneScene scene = catalogued(name);
    for (const double t : times) {
      const auto sides = both_sides(name, t);
      for (int side = 0; side < 2; ++side) {
        const auto u1 = sides[side](scene.exact->u[0], t), u2 = sides[side](scene.exact->u[1], t),
                   lambda = sides[side](scene.exact->multiplier, t);
        for (std::size_t i = 0; i < u1.size(); ++i) {
          if (side == 0) {
            EXPECT_EQ(u1[i], u2[i]);
            EXPECT_GT(lambda[i], 0);
          } else {
            EXPECT_GT(u1[i], u2[i]);
            EXPECT_EQ(lambda[i], 0);
          }
        }
      }
    }
  }
}

/// The multiplier of the moving contact jumps at its edge, and the Laplacian of the gap so that the forces do not.
TEST(CaseInTime, has_forces_without_jumps) {
  constexpr double epsilon = 1e-9;
  for (const char* name : solved) {
    const MembraneScene scene = catalogued(name);
    for (const double t : times) {
      const double R = radius(name, t);
      const Sample inside = ring(0.5, 0.5, R - epsilon, R - epsilon, 50), outside = ring(0.5, 0.5, R + epsilon, R + epsilon, 50);
      for (const FieldPtr& force : scene.force) {
        const auto left = inside(force, t), right = outside(force, t);
        for (std::size_t i = 0; i < left.size(); ++i) EXPECT_NEAR(left[i], right[i], 1e-6) << name << ", t = " << t;
      }
    }
  }
}

TEST(CaseInTime, begins_with_ordered_membranes) {
  for (const char* name : {"rings", "relaxation"}) {
    const MembraneScene scene = catalogued(name);
    EXPECT_FALSE(scene.exact);
    EXPECT_GT(*scene.initial[0]->constant(), *scene.initial[1]->constant());
    for (const int alpha : {0, 1}) {
      EXPECT_EQ(*scene.initial[alpha]->constant(), *scene.default_boundary.value[alpha]->constant());
      EXPECT_TRUE(scene.force[alpha]->steady());
    }
  }
}

TEST(CaseInTime, has_the_published_forces_on_the_rings) {
  Sample points;
  for (const double r : {0.1, 0.3, 0.5, 0.7, 0.9}) points.add(0, -r);
  const MembraneScene scene = catalogued("rings");
  const double upper[] = {-1, -2.5, 2.5, -2.5, 2.5}, lower[] = {4.5, -2, 3.5, -1.5, 2};
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(points(scene.force[0])[i], upper[i], 1e-14);
    EXPECT_NEAR(points(scene.force[1])[i], lower[i], 1e-14);
  }
}

TEST(Steady, is_what_does_not_know_time) {
  const std::vector<double> centre = {0, 0};
  EXPECT_TRUE(constant(3)->steady());
  EXPECT_TRUE(expression("f", "x*y + tan(x)", centre, {})->steady());
  EXPECT_FALSE(expression("f", "x + t", centre, {})->steady());
  EXPECT_TRUE(formula([](double x, double) { return x; })->steady());
  EXPECT_FALSE(formula([](double x, double, double t) { return x + t; })->steady());
  EXPECT_FALSE(difference_gradient(expression("f", "x*t", centre, {}), step)[0]->steady());
}

}  // namespace
}  // namespace thixis::membranes
