#include "thixis/bound/shares.hpp"

#include <algorithm>

namespace thixis::bound {

Shares shares(double upper, double lower) {
  const double both = upper + lower;
  if (!(both > 0)) return {};
  const double first = std::clamp(upper / both, 0.0, 1.0), second = std::clamp(lower / both, 0.0, 1.0);
  return {{first, second}, {second, first}};
}

std::vector<double> ways_of_upper(const std::array<scene::FieldPtr, 2>& tension, const std::vector<double>& x,
                                  const std::vector<double>& y) {
  std::vector<double> mu[2];
  for (int alpha = 0; alpha < 2; ++alpha) {
    mu[alpha].resize(x.size());
    tension[alpha]->evaluate({x.size(), x.data(), y.data()}, 0, mu[alpha].data());
  }
  std::vector<double> ways(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) ways[i] = shares(mu[0][i], mu[1][i]).of_way[0];
  return ways;
}

}  // namespace thixis::bound
