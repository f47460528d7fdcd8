#pragma once
#include <vector>

#include "thixis/core/types.hpp"

namespace thixis::bound {

/// Appends (A^T A)^{-1} A^T, flat (n × rows), to `fit`, A being (rows × n), n <= most_coefficients; appends nothing and returns false where
/// A does not determine all n.
bool append_fit(const std::vector<double>& A, LocalIndex rows, int n, std::vector<double>& fit);

}  // namespace thixis::bound
