/// The moving contact zone against figures of an independent program.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "march.hpp"

namespace thixis::verification {
namespace {

/// h = tau = 1/n, P1, the rule of degree 5.
struct Row {
  int n;
  double right, affine, l2_u1, l2_u2;
  int newton_min, newton_fb;
};
const Row rows[] = {{8, 5.192163e-1, 5.227598e-1, 1.601e-2, 2.885e-2, 17, 46},
                    {16, 2.634219e-1, 2.642789e-1, 4.942e-3, 8.095e-3, 37, 99},
                    {32, 1.323030e-1, 1.325162e-1, 1.710e-3, 2.599e-3, 74, 207},
                    {64, 6.625709e-2, 6.631004e-2, 6.813e-4, 9.591e-4, 171, 471}};

drive::RunParams as_in_the_table(int n) {
  auto params = on_squares("moving contact", n);
  params.method.quadrature_order = 5;
  return params;
}

void compare(const Row& row) {
  const March run = march(as_in_the_table(row.n), row.n, 1);
  ASSERT_TRUE(run.solved);
  const auto near = [&](const char* what, double value, double reference) {
    EXPECT_NEAR(value, reference, 0.002 * reference) << "n = " << row.n << ", " << what;
  };
  near("energy error, right", run.error_at_ends(1.0 / row.n), row.right);
  near("energy error, affine", run.evolution->error_so_far().value(), row.affine);
  near("L2 error of u1", run.largest("l2_error_u1"), row.l2_u1);
  near("L2 error of u2", run.largest("l2_error_u2"), row.l2_u2);
  EXPECT_LE(run.total(), row.newton_min) << "n = " << row.n;
  std::cout << "n = " << row.n << ": " << run.error_at_ends(1.0 / row.n) << ' ' << run.evolution->error_so_far().value() << ' '
            << run.largest("l2_error_u1") << ' ' << run.largest("l2_error_u2") << " min " << run.total() << " kkt " << run.worst_kkt;
  auto params = as_in_the_table(row.n);
  params.newton.c_function = complementarity::CFunction::fischer_burmeister;
  const March smooth = march(params, row.n, 1);
  std::cout << " fb " << smooth.total() << '\n';
  EXPECT_NEAR(smooth.evolution->error_so_far().value(), run.evolution->error_so_far().value(), 1e-6);
  for (std::size_t n = 0; n < run.series.size(); ++n)
    if ((n + 1) * 4 % row.n == 0) std::cout << "  t = " << (n + 1.0) / row.n << ": " << run.at(n, "contact_area") << '\n';
}

}  // namespace

TEST(MovingContact, has_the_errors_of_an_independent_program) {
  for (int k = 0; k < 3; ++k) compare(rows[k]);
}

TEST(FarMovingContact, has_the_errors_of_an_independent_program) { compare(rows[3]); }

}  // namespace thixis::verification
