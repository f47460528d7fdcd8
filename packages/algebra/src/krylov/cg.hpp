#pragma once
#include <memory>

#include "method.hpp"

namespace thixis::algebra {

/// Conjugate gradients for a symmetric positive definite A, preconditioned. It notices when p·Ap or r·M^{-1}r is not positive.
std::unique_ptr<Method> make_cg(int max_iterations);

}  // namespace thixis::algebra
