#pragma once
#include <memory>

#include "method.hpp"

namespace thixis::algebra {

/// Incomplete LU of the rows of each rank (with `overlap` layers of rows of other ranks): by level of fill (`ilu`) or by fill (`ilut`).
/// In a saddle system the unknowns with a zero diagonal must come after those that they are coupled with, or a pivot is zero.
/// For cg the contributions of overlapping ranks are added, which keeps the preconditioner symmetric; else each rank keeps its own rows.
std::unique_ptr<Preconditioner> make_ilu(const LinearParams& params);

}  // namespace thixis::algebra
