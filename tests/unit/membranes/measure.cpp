/// By what residuals of membranes are measured: forces that act, whatever the units, and from wherever heights are counted.
#include <gtest/gtest.h>

#include <cmath>

#include "problem/membrane_measure.hpp"
#include "scene/heights.hpp"
#include "thixis/fem/entry.hpp"
#include "thixis/fem/forms.hpp"
#include "thixis/fem/lagrange_space.hpp"
#include "thixis/mesh/build.hpp"

namespace thixis::membranes {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using scene::FieldPtr;

class Measure : public ::testing::Test {
 protected:
  Measure() {
    mesh::MeshParams params;
    params.refinements = 1;
    params.cells_per_rank = 50;
    levels_ = mesh::build(params, core::Comm(), ".");
    space_ = fem::make_lagrange_space(mesh(), {std::vector<bool>(mesh().tags.size(), true), nullptr, {}});
  }
  const mesh::Mesh& mesh() const { return levels_.finest(); }

  /// Membranes held at heights g, or one of them over an obstacle.
  MembraneOperator membranes(std::array<double, 2> mu, std::array<FieldPtr, 2> f, const FieldPtr& g, const FieldPtr& psi = nullptr) const {
    MembraneScene scene;
    scene.count = psi ? 1 : 2;
    scene.obstacle = psi;
    const method::BoundaryValues held = {std::vector<FieldPtr>(mesh().tags.size(), g), std::vector<FieldPtr>(mesh().tags.size())};
    method::Coefficients lift[2];
    Teuchos::RCP<Vector> body[2];
    std::array<method::FormPtr, 2> form;
    for (int alpha = 0; alpha < scene.count; ++alpha) {
      scene.tension[alpha] = scene::constant(mu[alpha]);
      scene.force[alpha] = f[alpha];
      lift[alpha] = space_->lift(held, 0);
      body[alpha] = Teuchos::rcp(new Vector(space_->map()));
      form[alpha] = fem::diffusion(*space_, scene.tension[alpha]);
      method::load(*form[alpha], *f[alpha], held, 0, *body[alpha]);
    }
    return membrane_operator(scene, fem::entry(), form, lift, body);
  }
  /// All membranes at one height.
  MultiVector at(const MembraneOperator& membranes, double height) const {
    MultiVector u(membranes.map(), membranes.count());
    u.putScalar(height);
    return u;
  }
  static MembraneMeasure measured(const MembraneOperator& membranes, const Rest& rest = {}) {
    MembraneMeasure measure(membranes);
    measure.set(membranes, rest);
    return measure;
  }

  mesh::Hierarchy levels_;
  std::unique_ptr<method::Space> space_;
  const FieldPtr zero_ = scene::constant(0);
};

FieldPtr force(double factor) {
  return scene::formula([factor](double x, double y) { return factor * (1 + x + std::sin(3 * y)); });
}

}  // namespace

/// T_alpha = max(|A_alpha|, |theta_2 A_1 - theta_1 A_2|), w_alpha = max T/T_alpha.
TEST_F(Measure, what_drives_the_gap_reaches_both_membranes) {
  for (const auto& [on_upper, on_lower] :
       {std::pair(force(3), force(1)), std::pair(force(-2), force(0)), std::pair(force(0), force(-1)), std::pair(force(1), force(1))}) {
    const MembraneOperator two = membranes({1, 3}, {on_upper, on_lower}, zero_);
    Vector on_gap(*two.load(0), Teuchos::Copy);
    on_gap.update(-0.25, *two.load(1), 0.75);
    double T[2];
    for (int alpha = 0; alpha < 2; ++alpha) T[alpha] = std::max(two.load(alpha)->norm2(), on_gap.norm2());
    const MembraneMeasure measure = measured(two);
    EXPECT_NEAR(measure.reference(), std::max(T[0], T[1]), 1e-12);
    for (int alpha = 0; alpha < 2; ++alpha) EXPECT_NEAR(measure.weight(alpha) * T[alpha], measure.reference(), 1e-12) << alpha;
    EXPECT_EQ(measure.contact_weight(), std::max(measure.weight(0), measure.weight(1)));
  }
}

TEST_F(Measure, the_height_of_all_does_not_matter) {
  const auto data = [](double height) { return scene::formula([height](double x, double y) { return height + x * y; }); };
  const MembraneOperator low = membranes({1, 3}, {force(1), force(-2)}, data(0)),
                         high = membranes({1, 3}, {force(1), force(-2)}, data(1e4));
  const MultiVector u = at(high, 1e4);
  const MembraneMeasure is = measured(low), raised = measured(high, {&u, {1e4, 1e4}});
  EXPECT_NEAR(raised.reference(), is.reference(), 1e-9 * is.reference());
  for (int alpha = 0; alpha < 2; ++alpha) EXPECT_NEAR(raised.weight(alpha), is.weight(alpha), 1e-9);
  EXPECT_NEAR(raised.displacement(at(high, 1e4 - 2)), is.displacement(at(low, -2)), 1e-9);
  EXPECT_NEAR(is.displacement(at(low, -2)), 2, 1e-12);
}

TEST_F(Measure, units_of_tension_and_height_are_those_of_the_forces) {
  const double m = 1e6, a = 1e-3;
  const MembraneOperator one = membranes({1, 3}, {force(1), force(-2)}, scene::constant(1)),
                         other = membranes({m, 3 * m}, {force(m * a), force(-2 * m * a)}, scene::constant(a));
  const MembraneMeasure is = measured(one), scaled = measured(other);
  EXPECT_NEAR(scaled.reference(), m * a * is.reference(), 1e-9 * m * a * is.reference());
  for (int alpha = 0; alpha < 2; ++alpha) EXPECT_NEAR(scaled.weight(alpha), is.weight(alpha), 1e-9);
  EXPECT_NEAR(scaled.stiffness().normInf(), m * is.stiffness().normInf(), 1e-9 * m * is.stiffness().normInf());
  EXPECT_NEAR(scaled.round_off(at(other, a)), m * a * is.round_off(at(one, 1)), 1e-12 * m * a);
}

/// 1/kappa = 1/S_1 + 1/S_2; rounding is 8 eps diag(S_1) (|u_1| + theta_2 |u_2|), likewise S_2, in the norm that the residual is measured
/// by.
TEST_F(Measure, contact_is_as_stiff_as_both_membranes_in_a_row) {
  const MembraneOperator two = membranes({1, 3}, {force(1), force(0)}, zero_);
  const MembraneMeasure measure = measured(two);
  Vector softness(two.map()), other(two.map());
  softness.reciprocal(measure.stiffness());
  other.reciprocal(measure.diagonal(0));
  softness.update(-4.0 / 3, other, 1);
  EXPECT_LT(softness.normInf(), 1e-13);
  const double eps = std::numeric_limits<double>::epsilon();
  const double first = 1 + 0.75, second = 1 + 0.25;
  EXPECT_NEAR(measure.round_off(0, at(two, -2)), 16 * eps * first * measure.diagonal(0).normInf(), 1e-20);
  const double squares = std::pow(first * measure.weight(0) * measure.diagonal(0).norm2(), 2) +
                         std::pow(second * measure.weight(1) * measure.diagonal(1).norm2(), 2);
  EXPECT_NEAR(measure.round_off(at(two, -2)), 16 * eps * std::sqrt(squares), 1e-20 * measure.contact_weight());
}

namespace {

Rest within(double reach) {
  Rest rest;
  rest.reach = reach;
  return rest;
}

}  // namespace

TEST_F(Measure, an_obstacle_counts_by_what_it_can_exert_and_only_within_reach) {
  const FieldPtr bump = scene::formula([](double x, double y) { return 1 - 8 * (std::pow(x - 0.5, 2) + std::pow(y - 0.5, 2)); });
  const MembraneOperator over = membranes({2, 0}, {zero_, nullptr}, zero_, bump);
  Vector pushed(over.map());
  over.apply(0, *over.obstacle, pushed);
  double squares = 0;
  {
    const auto values = algebra::host_view(pushed);
    for (std::size_t l = 0; l < values.extent(0); ++l) squares += std::pow(std::max(values(l), 0.0), 2);
  }
  const double exerted = std::sqrt(mesh().comm.sum(squares));
  EXPECT_GT(exerted, 0.1);
  EXPECT_NEAR(measured(over, within(-1e3)).reference(), exerted, 1e-12);

  const FieldPtr none = scene::formula([](double x, double y) { return -1e10 * (1 + x * x + y); });
  const MembraneOperator free = membranes({2, 0}, {force(1), nullptr}, zero_, none);
  EXPECT_EQ(measured(free, within(0)).reference(), free.load(0)->norm2());
  const MembraneOperator pressed = membranes({2, 0}, {force(-1), nullptr}, zero_, none);
  EXPECT_LT(measured(pressed, within(-1)).reference(), 1e3) << "and not 1e10";
}

namespace {

Heights heights_on(const mesh::Mesh& mesh, const char* g1, const char* g2) {
  models::SceneParams params{model::two, {}, {}};
  DataParams& data = of(params).data.emplace();
  data.g1.text = g1;
  data.g2.text = g2;
  return heights_of(membrane_scene(params), mesh, 0);
}

}  // namespace

TEST_F(Measure, membranes_rest_at_the_height_closest_to_zero_at_which_they_are_held) {
  const Heights above = heights_on(mesh(), "5 + x", "2 + y");
  EXPECT_EQ(above.rest(0), 5);
  EXPECT_EQ(above.rest(1), 2);
  EXPECT_EQ(above.origin(), 2);
  EXPECT_EQ(above.high[0], 6);
  const Heights below = heights_on(mesh(), "-3 + x", "-9 + y");
  EXPECT_EQ(below.rest(0), -2);
  EXPECT_EQ(below.rest(1), -8);
  EXPECT_EQ(below.origin(), -2);
  const Heights around = heights_on(mesh(), "1 + x", "y - 2");
  EXPECT_EQ(around.rest(0), 1);
  EXPECT_EQ(around.rest(1), -1);
  EXPECT_EQ(around.origin(), 0);
  EXPECT_FALSE(Heights().any());
  EXPECT_EQ(Heights().rest(0), 0);
  EXPECT_EQ(Heights().origin(), 0);
}

}  // namespace thixis::membranes
