#pragma once
#include <vector>

#include "thixis/mesh/ancestry.hpp"
#include "thixis/reference/modal.hpp"

namespace thixis::equilibration {

/// What a cell and its children do to densities and fluxes of degree q, in modal coefficients; n = dim P_q, m = dim P_{q+1}, c children.
struct Cut {
  int children = 0;
  std::vector<double> sum;       ///< (n × c n): densities of the children -> their projection in the cell
  std::vector<double> share;     ///< (c n × n): density of the cell -> the same in its children
  std::vector<double> lift;      ///< (c 2m × c n): densities of the children that sum to no density of the cell -> fluxes within the cell
  std::vector<double> restrict;  ///< (c 2m × 2m): flux of the cell -> the same in its children
};

/// For a cell cut into children of these shapes, which fill it; made once and kept.
const Cut& cut(const std::vector<mesh::ChildShape>& shapes, int q);

}  // namespace thixis::equilibration
