#include "thixis/reference/cell_basis.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "thixis/core/error.hpp"
#include "thixis/reference/bernstein_gradient.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::reference {
namespace {

class Basis : public ::testing::TestWithParam<std::tuple<int, Family>> {
 protected:
  CellBasis basis{std::get<0>(GetParam()), std::get<1>(GetParam())};
  const int p = basis.degree(), n = basis.size();

  double polynomial(double x, double y) const { return std::pow(1 + 2 * x - y, p) + 3 * y; }
  /// Coefficients of the polynomial by its values at the points.
  std::vector<double> coefficients() const {
    std::vector<double> c(n, 0.0);
    for (int l = 0; l < n; ++l)
      for (int m = 0; m < n; ++m) c[l] += basis.from_values()[l * n + m] * polynomial(basis.points()[2 * m], basis.points()[2 * m + 1]);
    return c;
  }
};

}  // namespace

TEST_P(Basis, reproduces_polynomials_of_its_degree_and_their_derivatives) {
  const auto c = coefficients();
  const double at[] = {0.1, 0.2, 0.35, 0.6, 0, 0.45};
  const auto table = basis.tabulate(3, at);
  for (int q = 0; q < 3; ++q) {
    double value = 0, dx = 0, dy = 0;
    for (int l = 0; l < n; ++l) {
      value += c[l] * table.value[q * n + l];
      dx += c[l] * table.gradient[2 * (q * n + l)];
      dy += c[l] * table.gradient[2 * (q * n + l) + 1];
    }
    const double x = at[2 * q], y = at[2 * q + 1], slope = p * std::pow(1 + 2 * x - y, p - 1);
    EXPECT_NEAR(value, polynomial(x, y), 1e-12);
    EXPECT_NEAR(dx, 2 * slope, 1e-11);
    EXPECT_NEAR(dy, 3 - slope, 1e-11);
  }
}

TEST_P(Basis, agrees_with_its_bernstein_coefficients) {
  const auto c = coefficients();
  double b[max_functions] = {};
  for (int k = 0; k < n; ++k)
    for (int l = 0; l < n; ++l) b[k] += basis.to_bernstein()[k * n + l] * c[l];
  const double lambda[3] = {0.2, 0.5, 0.3};
  EXPECT_NEAR(basis.bernstein().value(b, lambda), polynomial(0.5, 0.3), 1e-12);
  double slope[3];
  basis.bernstein().gradient(b, lambda, slope);
  EXPECT_NEAR(slope[1] - slope[0], 2 * p * std::pow(1 + 2 * 0.5 - 0.3, p - 1), 1e-11);

  const BernsteinGradient gradient = bernstein_gradient(basis.bernstein());
  const double directions[3][2] = {{-1, -1}, {1, 0}, {0, 1}};
  double along[2][BernsteinGradient::most];
  gradient.coefficients(b, directions, along);
  EXPECT_NEAR(gradient.lower.value(along[0], lambda), slope[1] - slope[0], 1e-11);
  EXPECT_NEAR(gradient.lower.value(along[1], lambda), slope[2] - slope[0], 1e-11);
}

TEST_P(Basis, lists_functions_inside_then_of_vertices_then_of_faces) {
  EXPECT_EQ(basis.interior(), (p - 1) * (p - 2) / 2);
  for (int l = 0; l < n; ++l) {
    const Entity expected = l < basis.interior() ? Entity::interior : l < basis.interior() + 3 ? Entity::vertex : Entity::face;
    EXPECT_EQ(basis.entities()[l].kind, expected);
  }
}

TEST_P(Basis, functions_vanish_on_faces_on_which_their_entity_does_not_lie) {
  constexpr double corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  for (int f = 0; f < 3; ++f)
    for (const double t : {0.15, 0.7}) {
      double at[2];
      for (int d = 0; d < 2; ++d) at[d] = (1 - t) * corner[(f + 1) % 3][d] + t * corner[(f + 2) % 3][d];
      const auto table = basis.tabulate(1, at);
      for (int l = 0; l < n; ++l) {
        const auto& entity = basis.entities()[l];
        const bool on_face = (entity.kind == Entity::vertex && entity.index != f) || (entity.kind == Entity::face && entity.index == f);
        if (!on_face) {
          EXPECT_NEAR(table.value[l], 0, 1e-13);
        }
      }
    }
}

TEST_P(Basis, has_a_symmetric_mass_whose_rows_sum_to_the_integrals) {
  double total = 0;
  for (int l = 0; l < n; ++l) {
    double row = 0;
    for (int m = 0; m < n; ++m) {
      row += basis.mass()[l * n + m];
      EXPECT_NEAR(basis.mass()[l * n + m], basis.mass()[m * n + l], 1e-16);
    }
    EXPECT_NEAR(row, basis.integrals()[l], 1e-15);
    total += basis.integrals()[l];
  }
  EXPECT_NEAR(total, 0.5, 1e-14);
}

TEST_P(Basis, has_no_negative_mean_but_on_the_regular_lattice_of_degree_4) {
  double least = 1;
  for (const double integral : basis.integrals()) least = std::min(least, integral);
  if (p == 4 && basis.family() == Family::equispaced) EXPECT_NEAR(least, -0.5 / 45, 1e-14);
  else EXPECT_GE(least, -1e-16);
}

INSTANTIATE_TEST_SUITE_P(CellBasis, Basis,
                         ::testing::Combine(::testing::Values(1, 2, 3, 4),
                                            ::testing::Values(Family::gauss_lobatto, Family::equispaced, Family::bernstein)));

TEST(CellBasis, refuses_other_degrees) {
  EXPECT_THROW(CellBasis(0, Family::bernstein), core::InputError);
  EXPECT_THROW(CellBasis(5, Family::gauss_lobatto), core::InputError);
}

}  // namespace thixis::reference
