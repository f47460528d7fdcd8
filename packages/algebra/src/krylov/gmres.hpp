#pragma once
#include <memory>

#include "method.hpp"

namespace thixis::algebra {

/// GMRES with right preconditioning, A M^{-1} (M x) = b, so that the residual that it minimizes is b - A x; restarted.
/// Y. Saad and M. Schultz (1986), doi:10.1137/0907058.
std::unique_ptr<Method> make_gmres(int restart, int max_iterations);

}  // namespace thixis::algebra
