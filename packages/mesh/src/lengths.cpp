#include "lengths.hpp"

#include <fmt/format.h>

#include <limits>

namespace thixis::mesh {
namespace {

constexpr double largest = 1e60, smallest = 1e-60;
/// Of a cell, that rounding of its coordinates may move.
constexpr double share = 0.25;

}  // namespace

std::string lengths_mistake(double coordinate, double length) {
  if (coordinate > largest || length < smallest)
    return fmt::format(
        "cells of {:.3g} at coordinates up to {:.3g} leave the range of what can be computed with; "
        "write lengths in units in which cells are at least {:g} and coordinates at most {:g}.",
        length, coordinate, smallest, largest);
  if (std::numeric_limits<double>::epsilon() * coordinate > share * length)
    return fmt::format("coordinates of {:.3g} have no digits left for cells of {:.3g}; put the mesh near the origin.", coordinate, length);
  return {};
}

}  // namespace thixis::mesh
