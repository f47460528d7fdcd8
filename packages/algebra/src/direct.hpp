#pragma once
#include <memory>

#include "method.hpp"

namespace thixis::algebra {

/// LU on rank 0 with one step of iterative refinement where the residual asks for it. Converged means |b - A x| <= tolerance, or, since no
/// solver can do better than rounding, |b - A x| <= 1e-13 |A| |x| (Frobenius norm). The criterion is not asked.
std::unique_ptr<Method> make_direct();

}  // namespace thixis::algebra
