#pragma once
#include <array>

#include "thixis/algebra/fwd.hpp"
#include "thixis/method/form.hpp"
#include "thixis/scene/field.hpp"

namespace thixis::bound {

/// A contact problem as its bound sees it: -div(mu_alpha grad u_alpha) + (-1)^alpha lambda = f_alpha for two membranes, or for one over an
/// obstacle (alpha = 1).
struct ContactProblem {
  int count = 2;
  std::array<scene::FieldPtr, 2> tension, force;
  std::array<method::FormPtr, 2> form;  ///< (mu_alpha grad u, grad v) on the space of the iterates
  std::array<method::BoundaryValues, 2> boundary;
  scene::FieldPtr obstacle;   ///< count = 1
  scene::FieldPtr interface;  ///< level set of the curves across which data jump; may be null
  double time = 0;            ///< at which the data are taken
};

/// An iterate, any.
struct Iterate {
  method::Coefficients u[2];
  const algebra::Vector* lambda = nullptr;                  ///< X3, on points()
  const algebra::Vector* gap = nullptr;                     ///< K, on points()
  const algebra::Vector* residual[2] = {nullptr, nullptr};  ///< F - (-1)^alpha D lambda - S u_alpha, on map()
};

}  // namespace thixis::bound
