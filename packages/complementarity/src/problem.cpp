#include "thixis/complementarity/problem.hpp"

#include "views.hpp"

namespace thixis::complementarity {

double Problem::rhs_norm(const algebra::Vector&, const algebra::Vector& R) const {
  const double reference = reference_norm();
  return reference > 0 ? reference : R.norm2();
}

void Problem::relax(algebra::Vector&, int) const {}

}  // namespace thixis::complementarity
