/// Frames of nodes: Bᵀ T = (0 | 1), means and gaps do not act on each other, and two membranes get the mean and the gap that they had.
#include <gtest/gtest.h>

#include <cmath>

#include "setting.hpp"

namespace thixis::contact {
namespace {

struct Case {
  const char* name;
  int fields, gaps;
  std::vector<std::vector<double>> B;
  std::vector<double> weight;
};
const Case all_cases[] = {
    {"obstacle", 1, 1, {{1}}, {3}},
    {"two membranes", 2, 1, {{1}, {-1}}, {1, 5}},
    {"three membranes", 3, 2, {{1, 0}, {-1, 1}, {0, -1}}, {1, 2, 7}},
    {"a normal", 2, 1, {{0.6}, {-0.8}}, {1, 1}},
    {"a normal along an axis", 2, 1, {{0}, {1}}, {1, 1}},
    {"a normal in space", 3, 1, {{0.48}, {0.6}, {-0.64}}, {1, 2, 3}},
};

double entry(const Small& A, const Small& B, int n, int i, int j, bool transpose = false) {
  double sum = 0;
  for (int k = 0; k < n; ++k) sum += (transpose ? A(k, i) : A(i, k)) * B(k, j);
  return sum;
}

}  // namespace

TEST(Frame, makes_the_gaps_the_last_coordinates) {
  for (const Case& of : all_cases) {
    SCOPED_TRACE(of.name);
    const Small B = of_rows(of.B);
    const Frame frame = make_frame(of.fields, of.gaps, B, of.weight);
    const int means = of.fields - of.gaps;
    for (int i = 0; i < of.fields; ++i)
      for (int j = 0; j < of.fields; ++j) EXPECT_NEAR(entry(frame.inverse, frame.T, of.fields, i, j), i == j, 1e-14);
    for (int g = 0; g < of.gaps; ++g)
      for (int i = 0; i < of.fields; ++i) EXPECT_EQ(frame.inverse(means + g, i), B(i, g));
  }
}

TEST(Frame, separates_means_from_gaps_where_fields_share_an_operator) {
  for (const Case& of : all_cases) {
    SCOPED_TRACE(of.name);
    const Frame frame = make_frame(of.fields, of.gaps, of_rows(of.B), of.weight);
    Small weighted = frame.T;
    for (int i = 0; i < of.fields; ++i)
      for (int j = 0; j < of.fields; ++j) weighted(i, j) *= of.weight[i];
    for (int mean = 0; mean < of.fields - of.gaps; ++mean)
      for (int gap = of.fields - of.gaps; gap < of.fields; ++gap)
        EXPECT_NEAR(entry(frame.T, weighted, of.fields, mean, gap, true), 0, 1e-13);
  }
}

TEST(Frame, of_two_membranes_is_the_mean_by_their_tensions_and_the_gap) {
  const Frame frame = make_frame(2, 1, of_rows({{1}, {-1}}), {1, 3});
  const Small T = of_rows({{1, 0.75}, {1, -0.25}}), back = of_rows({{0.25, 0.75}, {1, -1}});
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      EXPECT_NEAR(frame.T(i, j), T(i, j), 1e-15);
      EXPECT_NEAR(frame.inverse(i, j), back(i, j), 1e-15);
    }
}

TEST(Frame, of_gaps_that_depend_on_each_other_is_refused) {
  EXPECT_THROW(make_frame(2, 2, of_rows({{1, 2}, {-1, -2}}), {1, 1}), std::logic_error);
}

}  // namespace thixis::contact
