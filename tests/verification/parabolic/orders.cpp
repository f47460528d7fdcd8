/// Orders of convergence in h and in tau.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "march.hpp"

namespace thixis::verification {
namespace {

drive::RunParams reduced(const std::string& name, int n, std::string method, int degree) {
  auto params = on_squares(name, n, method, degree);
  params.linear.form = algebra::SystemForm::reduced;
  params.newton.scaling = complementarity::Scaling::physical;
  return params;
}

double error(const drive::RunParams& params, int steps) {
  const March run = march(params, steps, 1);
  return run.evolution->error_so_far().value();
}

/// The solution is affine in time and the zone rests: 2 steps are exact, what is left is the error in space.
void expect_order_in_space(const std::string& method, int degree, int coarsest, double tolerance) {
  if (!tests::is_built(method)) return void(std::cout << method << " is not built\n");
  double errors[3];
  for (int k = 0; k < 3; ++k) errors[k] = error(reduced("resting contact", coarsest << k, method, degree), 2);
  std::cout << method << " of degree " << degree << ", n = " << coarsest << "…: " << errors[0] << ' ' << errors[1] << ' ' << errors[2]
            << ", orders " << order(errors[0], errors[1]) << ' ' << order(errors[1], errors[2]) << '\n';
  EXPECT_NEAR(order(errors[1], errors[2]), degree, tolerance) << method << " of degree " << degree;
}

/// n = 8, 16, …, tau = factor / n²: the mean order from the coarsest to the finest.
double mean_order(const std::string& method, int degree, int refinements, double factor) {
  std::vector<double> errors;
  for (int k = 0; k <= refinements; ++k) {
    const int n = 8 << k;
    errors.push_back(error(reduced("moving contact", n, method, degree), static_cast<int>(std::lround(n * n / factor))));
  }
  std::cout << method << " of degree " << degree << ", moving contact, tau = " << factor << " h²:";
  for (const double e : errors) std::cout << ' ' << e;
  const double mean = order(errors.front(), errors.back()) / refinements;
  std::cout << ", mean order " << mean << '\n';
  return mean;
}

/// On a mesh whose own error is far below; at the ends of the steps, where the error of the affine interpolation, of order 2, is not seen.
void expect_order_in_time(const std::string& method, int n, int fewest) {
  if (!tests::is_built(method)) return void(std::cout << method << " is not built\n");
  std::vector<double> ends, all;
  for (const int factor : {1, 2, 4}) {
    const March run = march(reduced("smooth moving contact", n, method, 4), fewest * factor, 1);
    ends.push_back(run.error_at_ends(1.0 / (fewest * factor)));
    all.push_back(run.evolution->error_so_far().value());
  }
  std::cout << method << " in time, " << fewest << " … steps:";
  for (int k = 0; k < 3; ++k) std::cout << ' ' << ends[k] << " (" << all[k] << ')';
  std::cout << ", orders " << order(ends[0], ends[1]) << ' ' << order(ends[1], ends[2]) << " (" << order(all[1], all[2]) << ")\n";
  EXPECT_NEAR(order(ends[1], ends[2]), 1, 0.1) << method;
}

}  // namespace

TEST(Orders, in_space_of_finite_elements) {
  expect_order_in_space("fem", 1, 16, 0.1);
  expect_order_in_space("fem", 2, 8, 0.1);
  expect_order_in_space("fem", 3, 8, 0.1);
}

TEST(Orders, in_space_of_hybrid_methods) {
  expect_order_in_space("hho", 1, 16, 0.1);
  expect_order_in_space("hho", 2, 8, 0.1);
  expect_order_in_space("hho", 3, 8, 0.1);
}

TEST(FarOrders, in_space_of_discontinuous_methods) { expect_order_in_space("dg", 2, 8, 0.1); }

TEST(FarOrders, in_space_of_degree_4) {
  expect_order_in_space("fem", 4, 8, 0.15);
  expect_order_in_space("hho", 4, 8, 0.15);
}

TEST(Orders, is_1_in_time) { expect_order_in_time("fem", 12, 8); }

TEST(FarOrders, is_1_in_time) {
  expect_order_in_time("fem", 20, 16);
  expect_order_in_time("hho", 20, 16);
}

/// The multiplier jumps at the free boundary: 1.5 is what degrees above 1 can reach.
TEST(Orders, is_above_1_3_where_the_multiplier_jumps) { EXPECT_GE(mean_order("fem", 2, 1, 4), 1.3); }

TEST(FarOrders, is_above_1_4_where_the_multiplier_jumps) {
  SKIP_UNLESS_BUILT("hho");
  for (const int degree : {2, 3}) {
    EXPECT_GE(mean_order("fem", degree, 2, 4), 1.4) << degree;
    EXPECT_GE(mean_order("hho", degree, 2, 4), 1.4) << degree;
  }
}

}  // namespace thixis::verification
