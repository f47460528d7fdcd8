#pragma once
#include "thixis/method/sums.hpp"

namespace thixis::bound {

using method::sum_over_cells;
using method::Sums;

}  // namespace thixis::bound
