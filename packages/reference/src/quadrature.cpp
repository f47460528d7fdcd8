#include "thixis/reference/quadrature.hpp"

#include <string>

#include "basix.hpp"
#include "thixis/core/error.hpp"

namespace thixis::reference {
namespace {

void check(int order) {
  if (order < 0 || order > max_quadrature_order)
    throw core::InputError("The quadrature order must be between 0 and " + std::to_string(max_quadrature_order) + ", not " +
                           std::to_string(order) + ".");
}

}  // namespace

Quadrature triangle_quadrature(int order) {
  check(order);
  auto [point, weight] = basix_interface::triangle_rule(order);
  return {order, std::move(point), std::move(weight)};
}

Quadrature line_quadrature(int order) {
  check(order);
  auto [point, weight] = basix_interface::line_rule(order);
  return {order, std::move(point), std::move(weight)};
}

}  // namespace thixis::reference
