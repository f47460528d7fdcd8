#pragma once
/// Points that fall on a floor: x' = f_l(t) + lambda, x >= 0, lambda >= 0, x lambda = 0. What is tested is what the time loop does with a
/// scene; its linear systems are 2 x 2.
#include <memory>
#include <vector>

#include "thixis/models/evolution.hpp"

namespace thixis::drive::test {

struct Falling {
  GlobalIndex points = 7;
  double longest_step = 1e300;  ///< longer steps are refused by the solver
  bool misleading = false;      ///< predicts a start that is not finite
  double error_in_time = 0;     ///< of a step of unit length; that in space is 1: error_in_time · length
  double alike = 1e300;         ///< of shorter steps both errors are in the ratio that a step of this length has
  double wrong_from = 1e300;    ///< data of steps that end behind this time are a mistake
};

/// f_l(t) = (1 + l) cos(3 t) - 1/2 for point l, x_l(0) = 1/10.
std::unique_ptr<models::Evolution> falling(const Falling& params, const core::Comm& comm);

}  // namespace thixis::drive::test
