#include "thixis/reference/modal.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "thixis/reference/quadrature.hpp"

namespace thixis::reference {
namespace {

class ModalOfDegree : public testing::TestWithParam<int> {};

TEST_P(ModalOfDegree, is_orthonormal_and_hierarchical) {
  const Modal modal(GetParam());
  const int n = modal.size();
  const auto rule = triangle_quadrature(2 * GetParam());
  const auto table = modal.values(rule.size(), rule.point.data());
  for (int k = 0; k < n; ++k)
    for (int l = 0; l < n; ++l) {
      double product = 0;
      for (int q = 0; q < rule.size(); ++q) product += rule.weight[q] * table[q * n + k] * table[q * n + l];
      EXPECT_NEAR(product, k == l ? 1 : 0, 1e-13);
    }
  for (int lower = 0; lower < GetParam(); ++lower) {
    const Modal smaller(lower);
    const double point[2] = {0.3, 0.2};
    const auto few = smaller.values(1, point), all = modal.values(1, point);
    for (int k = 0; k < smaller.size(); ++k) EXPECT_NEAR(few[k], all[k], 1e-14);
  }
}

TEST_P(ModalOfDegree, differentiates_and_multiplies) {
  const Modal modal(GetParam());
  const int n = modal.size();
  const double h = 1e-5, x = 0.31, y = 0.23, at[10] = {x + h, y, x - h, y, x, y + h, x, y - h, x, y};
  const auto values = modal.values(5, at);
  const double lambda[3] = {1 - x - y, x, y};
  for (int k = 0; k < n; ++k)
    for (int d = 0; d < 2; ++d) {
      double derivative = 0, product[3] = {};
      for (int l = 0; l < n; ++l) {
        derivative += modal.derivative(d)[l * n + k] * values[4 * n + l];
        for (int a = 0; a < 3; ++a) product[a] += modal.times_barycentric(a)[l * n + k] * values[4 * n + l];
      }
      EXPECT_NEAR(derivative, (values[2 * d * n + k] - values[(2 * d + 1) * n + k]) / (2 * h), 1e-5);
      if (k >= dimension(GetParam() - 1)) continue;
      for (int a = 0; a < 3; ++a) EXPECT_NEAR(product[a], lambda[a] * values[4 * n + k], 1e-13);
    }
}

TEST_P(ModalOfDegree, restricts_to_parts) {
  const Modal modal(GetParam());
  const int n = modal.size();
  const Part part = {{{0.5, 0.5, 0}, {0, 1, 0}, {0, 0.5, 0.5}}};
  const auto R = modal.restriction(part);
  const double inside[2] = {0.2, 0.6};
  double outside[2] = {};
  for (int d = 0; d < 2; ++d) outside[d] = 0.2 * part[0][d + 1] + 0.2 * part[1][d + 1] + 0.6 * part[2][d + 1];
  const auto there = modal.values(1, inside), here = modal.values(1, outside);
  for (int k = 0; k < n; ++k) {
    double value = 0;
    for (int l = 0; l < n; ++l) value += R[l * n + k] * there[l];
    EXPECT_NEAR(value, here[k], 1e-13);
  }
}
INSTANTIATE_TEST_SUITE_P(all, ModalOfDegree, testing::Range(0, 7));

class RaviartThomasOfDegree : public testing::TestWithParam<int> {
 protected:
  RaviartThomasOfDegree() : modal(GetParam() + 1), fields(GetParam()) {}

  std::vector<double> normal_moments(const std::vector<double>& v, int face) const {
    const int n = modal.size(), count = GetParam() + 2;
    const auto trace = modal.trace(face, count);
    std::vector<double> moments(count, 0.0);
    for (int j = 0; j < count; ++j)
      for (int d = 0; d < 2; ++d)
        for (int k = 0; k < n; ++k) moments[j] += face_normal[face][d] * trace[j * n + k] * v[d * n + k];
    return moments;
  }
  std::vector<double> divergence(const std::vector<double>& v) const {
    const int n = modal.size();
    std::vector<double> coefficients(n, 0.0);
    for (int l = 0; l < n; ++l)
      for (int d = 0; d < 2; ++d)
        for (int k = 0; k < n; ++k) coefficients[l] += modal.derivative(d)[l * n + k] * v[d * n + k];
    return coefficients;
  }

  Modal modal;
  RaviartThomas fields;
};

TEST_P(RaviartThomasOfDegree, has_fields_with_given_faces_and_density) {
  const int q = GetParam();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= q; ++j) {
      for (int f = 0; f < 3; ++f) {
        const auto moments = normal_moments(fields.from_face(i, j), f);
        for (int m = 0; m < q + 2; ++m) EXPECT_NEAR(moments[m], f == i && m == j ? 1 : 0, 1e-12);
      }
      const auto div = divergence(fields.from_face(i, j));
      for (std::size_t k = 0; k < div.size(); ++k) EXPECT_NEAR(div[k], k == 0 && j == 0 ? std::sqrt(2.0) : 0, 1e-11);
    }
  for (int k = 1; k < dimension(q); ++k) {
    const auto div = divergence(fields.from_density(k));
    for (int l = 0; l < modal.size(); ++l) EXPECT_NEAR(div[l], l == k ? 1 : 0, 1e-11);
    for (int f = 0; f < 3; ++f)
      for (const double moment : normal_moments(fields.from_density(k), f)) EXPECT_NEAR(moment, 0, 1e-12);
  }
}

TEST_P(RaviartThomasOfDegree, has_bubbles_without_flux_and_divergence) {
  const int q = GetParam();
  ASSERT_EQ(fields.bubbles(), q < 2 ? 0 : dimension(q - 2));
  for (int m = 0; m < fields.bubbles(); ++m) {
    for (const double c : divergence(fields.bubble(m))) EXPECT_NEAR(c, 0, 1e-11);
    for (int f = 0; f < 3; ++f)
      for (const double moment : normal_moments(fields.bubble(m), f)) EXPECT_NEAR(moment, 0, 1e-12);
  }
}
INSTANTIATE_TEST_SUITE_P(all, RaviartThomasOfDegree, testing::Range(0, 5));

}  // namespace
}  // namespace thixis::reference
