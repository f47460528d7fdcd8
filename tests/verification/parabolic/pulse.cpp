/// Forces that act between the points in time at which the bound takes them.
#include <gtest/gtest.h>

#include "march.hpp"
#include "thixis/complementarity/newton.hpp"
#include "thixis/fem/entry.hpp"

namespace thixis::verification {
namespace {

struct Seen {
  double bound = 0;
  complementarity::Promise promise = complementarity::Promise::indicator;
  std::string remark;
};

/// Of one step from 0 to 1/10 with the force f_1 on the upper membrane, which the boundary holds at g_1.
Seen one_step(const std::string& force, const std::string& height = "0.1") {
  drive::RunParams params = on_squares("", 4);
  params.scene.case_name.reset();
  membranes::of(params.scene).data.emplace();
  membranes::DataParams& data = *membranes::of(params.scene).data;
  data.f1 = {force};
  data.g1 = {height};
  data.g2 = {"0"};
  data.initial.emplace();
  data.initial->u1 = {"0.1"};
  data.initial->u2 = {"0"};
  const auto model = membranes::parabolic_membranes(membranes::membrane_scene(params.scene), fem::entry(), params.method, params.linear);
  const auto evolution = model->evolve(params.mesh, core::Comm(), "", {});
  auto X = evolution->initial();
  const algebra::Vector before(*X, Teuchos::Copy);
  evolution->begin({0, 0.1}, before);
  EXPECT_TRUE(complementarity::newton(evolution->problem(), *X, params.newton, params.stopping, 10, {}, {}).converged);
  Seen seen;
  const auto eta = evolution->estimate(*X);
  seen.bound = eta.total;
  seen.promise = eta.promise;
  EXPECT_EQ(eta.promise == complementarity::Promise::guaranteed, evolution->doubts().empty()) << force;
  seen.remark = evolution->remark();
  return seen;
}

}  // namespace

/// 2000 for a hundredth of time moves the membrane by 20, a thousand times the gap of the boundary; with the membrane at rest at the end of
/// the step nothing but the change of the force tells of it: C |f| √(1/100) = 2000 · 0.225 / 10 = 45.
TEST(Pulse, between_the_points_of_the_rule_is_seen) {
  const Seen seen = one_step("t > 0.03 && t < 0.04 ? -2000 : 0");
  EXPECT_GE(seen.bound, 40);
  EXPECT_NE(seen.remark.find("between t = 0 and 0.1 a force changes"), std::string::npos) << seen.remark;
}

TEST(Pulse, is_not_seen_where_there_is_none) {
  for (const char* force : {"-1", "-30*sin(3*t)", "-t", "-exp(-20*t)*x", "-1 + 1e-16*sin(1e6*t)"})
    EXPECT_EQ(one_step(force).remark, "") << force;
  EXPECT_EQ(one_step("-t*t").bound, one_step("-t^2").bound);
}

/// Where integrals in time are exact, and nowhere else.
TEST(PromiseInTime, is_kept_for_polynomials_of_the_degrees_of_the_rules) {
  using complementarity::Promise;
  for (const char* force : {"-1", "-t", "-(1 + t)^2", "-t^2*x^2"}) EXPECT_EQ(one_step(force).promise, Promise::guaranteed) << force;
  for (const char* force :
       {"-t^3", "-((((((1 + 1e-10*t)^64)^64)^64)^64)^64)^64", "-sin(t)", "t > 0.03 && t < 0.04 ? -2000 : 0", "t < 0.05 ? -1 : -2"})
    EXPECT_EQ(one_step(force).promise, Promise::up_to_quadrature) << force;
  for (const char* height : {"0.1 + t", "0.1 + x*t"}) EXPECT_EQ(one_step("-1", height).promise, Promise::guaranteed) << height;
  for (const char* height : {"0.1 + t^2", "0.1 + abs(t - 0.05)", "0.1 + t*x^2", "0.2 + 0.1*sin(10*t)"})
    EXPECT_EQ(one_step("-1", height).promise, Promise::up_to_quadrature) << height;
}

}  // namespace thixis::verification
