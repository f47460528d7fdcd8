#include "thixis/reference/quadrature.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "thixis/core/error.hpp"

namespace thixis::reference {
namespace {

double factorial(int n) { return std::tgamma(n + 1.0); }

/// Integral of xi^a eta^b over the reference triangle.
double exact(int a, int b) { return factorial(a) * factorial(b) / factorial(a + b + 2); }

double integrate(const Quadrature& rule, int a, int b) {
  double sum = 0;
  for (int q = 0; q < rule.size(); ++q) sum += rule.weight[q] * std::pow(rule.point[2 * q], a) * std::pow(rule.point[2 * q + 1], b);
  return sum;
}

TEST(TriangleQuadrature, integrates_all_monomials_up_to_its_order) {
  for (int order = 0; order <= max_quadrature_order; ++order) {
    const Quadrature rule = triangle_quadrature(order);
    EXPECT_EQ(rule.order, order);
    for (int a = 0; a <= order; ++a)
      for (int b = 0; a + b <= order; ++b)
        EXPECT_NEAR(integrate(rule, a, b) / exact(a, b), 1.0, 1e-12) << "order " << order << ", xi^" << a << " eta^" << b;
  }
}

TEST(TriangleQuadrature, has_positive_weights_of_sum_one_half_and_points_inside) {
  for (int order = 0; order <= max_quadrature_order; ++order) {
    const Quadrature rule = triangle_quadrature(order);
    double sum = 0;
    for (int q = 0; q < rule.size(); ++q) {
      const double xi = rule.point[2 * q], eta = rule.point[2 * q + 1];
      EXPECT_GT(rule.weight[q], 0.0) << "order " << order;
      EXPECT_TRUE(xi > 0 && eta > 0 && xi + eta < 1) << "order " << order << ": (" << xi << ", " << eta << ")";
      sum += rule.weight[q];
    }
    EXPECT_NEAR(sum, 0.5, 1e-14) << "order " << order;
  }
}

TEST(LineQuadrature, integrates_all_powers_up_to_its_order_with_positive_weights) {
  for (int order = 0; order <= max_quadrature_order; ++order) {
    const Quadrature rule = line_quadrature(order);
    for (int a = 0; a <= order; ++a) {
      double sum = 0;
      for (int q = 0; q < rule.size(); ++q) sum += rule.weight[q] * std::pow(rule.point[q], a);
      EXPECT_NEAR(sum * (a + 1), 1.0, 1e-13) << "order " << order << ", s^" << a;
    }
    for (const double weight : rule.weight) EXPECT_GT(weight, 0.0);
  }
}

TEST(Quadrature, refuses_orders_it_does_not_have) {
  EXPECT_THROW(triangle_quadrature(-1), core::InputError);
  EXPECT_THROW(triangle_quadrature(31), core::InputError);
  try {
    line_quadrature(31);
    FAIL();
  } catch (const core::InputError& error) {
    EXPECT_STREQ(error.what(), "The quadrature order must be between 0 and 30, not 31.");
  }
}

}  // namespace
}  // namespace thixis::reference
