#include "thixis/complementarity/problem.hpp"

#include "thixis/complementarity/active_set.hpp"

namespace thixis::complementarity {

double Problem::gap_size(const algebra::Vector&, const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s) const {
  return largest_argument(K, G, s);
}

double Problem::rhs_norm(const algebra::Vector&, const algebra::Vector&) const { return reference_norm(); }

void Problem::relax(algebra::Vector&, int) const {}
void Problem::look_at(const algebra::Vector&, const algebra::Vector&) const {}
void Problem::look_away() const {}

}  // namespace thixis::complementarity
