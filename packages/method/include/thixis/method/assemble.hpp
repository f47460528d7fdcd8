#pragma once
#include "thixis/core/comm.hpp"
#include "thixis/method/graph.hpp"
#include "thixis/method/space.hpp"

namespace thixis::method {

/// A_lm = sum_e a_e(psi_m, psi_l) over the elements, l and m unknowns of theirs: in blocks, so that local matrices stay in cache.
/// Collective; an error of the form on one rank is thrown on all.
algebra::MatrixPtr assemble(const core::Comm& comm, const algebra::GraphPtr& graph, const ElementUnknowns& elements, const CellForm& form);

}  // namespace thixis::method
