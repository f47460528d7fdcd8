#pragma once
#include <cmath>
#include <random>
#include <vector>

#include "thixis/scene/field.hpp"

namespace thixis::scene {

/// Points and what fields are there.
struct Sample {
  std::vector<double> x, y;
  void add(double px, double py) {
    x.push_back(px);
    y.push_back(py);
  }
  std::size_t size() const { return x.size(); }
  std::vector<double> operator()(const FieldPtr& field, double t = 0) const {
    std::vector<double> values(size());
    field->evaluate({size(), x.data(), y.data()}, t, values.data());
    return values;
  }
};

/// Points at distances from `inner` to `outer` from a centre, in all directions.
inline Sample ring(double cx, double cy, double inner, double outer, int count = 500) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  Sample sample;
  for (int i = 0; i < count; ++i) {
    const double r = inner + (outer - inner) * unit(random), phi = 2 * M_PI * unit(random);
    sample.add(cx + r * std::cos(phi), cy + r * std::sin(phi));
  }
  return sample;
}

}  // namespace thixis::scene
