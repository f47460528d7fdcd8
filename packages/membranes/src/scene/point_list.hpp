#pragma once
#include <vector>

#include "thixis/scene/field.hpp"

namespace thixis::membranes {

/// Places at which functions are asked for.
struct PointList {
  std::vector<double> x, y;
  void add(double px, double py) {
    x.push_back(px);
    y.push_back(py);
  }
  /// Throws on this rank only.
  std::vector<double> evaluate(const scene::Field& field, double t = 0) const {
    std::vector<double> values(x.size());
    field.evaluate({x.size(), x.data(), y.data()}, t, values.data());
    return values;
  }
};

}  // namespace thixis::membranes
