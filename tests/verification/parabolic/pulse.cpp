/// Forces that act between the points in time at which the bound takes them.
#include <gtest/gtest.h>

#include "march.hpp"
#include "thixis/complementarity/newton.hpp"
#include "thixis/fem/lagrange_space.hpp"

namespace thixis::verification {
namespace {

struct Seen {
  double bound = 0;
  std::string remark;
};

/// Of one step from 0 to 1/10 with the force f_1 on the upper membrane.
Seen one_step(const std::string& force) {
  drive::RunParams params = on_squares("", 4);
  params.scene.case_name.reset();
  params.scene.data.emplace();
  scene::DataParams& data = *params.scene.data;
  data.f1 = {force};
  data.g1 = {"0.1"};
  data.g2 = {"0"};
  data.initial.emplace();
  data.initial->u1 = {"0.1"};
  data.initial->u2 = {"0"};
  const auto model =
      models::parabolic_membranes(scene::membrane_scene(params.scene), fem::make_lagrange_space, params.method, params.linear);
  const auto evolution = model->evolve(params.mesh, core::Comm(), "", {});
  auto X = evolution->initial();
  const algebra::Vector before(*X, Teuchos::Copy);
  evolution->begin({0, 0.1}, before);
  EXPECT_TRUE(complementarity::newton(evolution->problem(), *X, params.newton, params.stopping, 10, {}, {}).converged);
  Seen seen;
  seen.bound = evolution->estimate(*X).total;
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

}  // namespace thixis::verification
