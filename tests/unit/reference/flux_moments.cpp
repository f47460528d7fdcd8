#include "thixis/reference/flux_moments.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "thixis/reference/cell_basis.hpp"

namespace thixis::reference {
namespace {

class FluxMomentsOfDegree : public testing::TestWithParam<int> {};

/// Any combination of the Raviart–Thomas fields comes back from its moments.
TEST_P(FluxMomentsOfDegree, determine_a_field) {
  const int q = GetParam(), inside = q > 0 ? dimension(q - 1) : 0;
  const RaviartThomas fields(q);
  const Modal modal(q + 1);
  const int n = modal.size(), size = fields.flux_size();
  std::vector<double> v(size, 0.0), moments;
  int seed = 0;
  const auto add = [&](const std::vector<double>& field) {
    const double c = std::cos(3.7 * ++seed);
    for (int r = 0; r < size; ++r) v[r] += c * field[r];
  };
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= q; ++j) add(fields.from_face(i, j));
  for (int k = 1; k < dimension(q); ++k) add(fields.from_density(k));
  for (int m = 0; m < fields.bubbles(); ++m) add(fields.bubble(m));

  for (int i = 0; i < 3; ++i) {
    const auto trace = modal.trace(i, q + 1);
    for (int j = 0; j <= q; ++j) {
      double moment = 0;
      for (int k = 0; k < n; ++k) moment += trace[j * n + k] * (face_normal[i][0] * v[k] + face_normal[i][1] * v[n + k]);
      moments.push_back(moment);
    }
  }
  for (int d = 0; d < 2; ++d)
    for (int k = 0; k < inside; ++k) moments.push_back(v[d * n + k]);

  const auto T = from_moments(fields);
  const int count = static_cast<int>(moments.size());
  ASSERT_EQ(T.size(), moments.size() * size);
  for (int r = 0; r < size; ++r) {
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += T[r * count + i] * moments[i];
    EXPECT_NEAR(sum, v[r], 1e-11);
  }
}

/// phi_l = sum_k C_kl B_k.
TEST_P(FluxMomentsOfDegree, and_modal_polynomials_in_the_bernstein_basis) {
  const Bernstein basis = bernstein(GetParam());
  const auto C = modal_to_bernstein(basis);
  const double at[2] = {0.31, 0.17}, lambda[3] = {1 - at[0] - at[1], at[0], at[1]};
  const auto phi = Modal(GetParam()).values(1, at);
  std::vector<double> B(basis.size);
  basis.values(lambda, B.data());
  for (int l = 0; l < basis.size; ++l) {
    double sum = 0;
    for (int k = 0; k < basis.size; ++k) sum += C[k * basis.size + l] * B[k];
    EXPECT_NEAR(sum, phi[l], 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(all, FluxMomentsOfDegree, testing::Range(0, 5));

}  // namespace
}  // namespace thixis::reference
