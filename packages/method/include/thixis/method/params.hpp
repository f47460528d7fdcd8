#pragma once
#include <algorithm>
#include <optional>
#include <string>

#include "thixis/core/schema.hpp"

namespace thixis::method {

enum class Nodes { gauss_lobatto, equispaced, bernstein };

/// Block `method` of the deck: what methods share. `own` holds what one of them has for itself (method.hpp).
struct MethodParams {
  std::string name;  ///< of a Method
  int degree = 1;
  Nodes nodes = Nodes::gauss_lobatto;
  int quadrature_order = 0;          ///< 0: 2 degree + 4; never below 2 degree
  std::optional<bool> condensation;  ///< not given: as the method does
  core::Extras own;
  int order() const { return quadrature_order > 0 ? std::max(quadrature_order, 2 * degree) : 2 * degree + 4; }
};

}  // namespace thixis::method
