#pragma once
#include "thixis/bound/cell_fields.hpp"

namespace thixis::bound {

/// out(K, ·) = det (a_factor a + b_factor b)(K, ·): the density of functions in modal coefficients. Tables of length 0 are 0; where both
/// are, `out` is left and false returned.
bool density_of(const Metrics& metric, double a_factor, const ConstCellTable& a, double b_factor, const ConstCellTable& b,
                const CellTable& out);

/// to(K, i) += factor from(K, i) for the cells of `to` and the columns that both have.
void add(double factor, const ConstCellTable& from, const CellTable& to);

}  // namespace thixis::bound
