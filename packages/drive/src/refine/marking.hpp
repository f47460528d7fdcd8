#pragma once
#include <vector>

#include "thixis/drive/params.hpp"
#include "thixis/mesh/mesh.hpp"

namespace thixis::drive {

/// The cells to be refined: their global ids, rising, on all ranks. eta[K]: error of the owned cell K, all >= 0.
///
/// `dorfler`: the fewest cells with Σ eta_K² >= theta² Σ_all eta_K² (Dörfler 1996, doi:10.1137/0733054), the largest first. So that they
/// are the same cells on any number of ranks, eta is read in steps of 1e-6 of the largest one, and equal cells are taken in the order of
/// their ids. `uniform`: all cells. Nothing where all eta are 0. Collective; throws core::Error (internal) where an eta is not a finite
/// number.
std::vector<GlobalIndex> mark(const mesh::Mesh& mesh, const AdaptParams& params, const std::vector<double>& eta);

/// Those of the cells `ids` (rising, the same on all ranks) whose longest face is at least 1e-8 of the mesh's width, the largest extent of
/// its bounding box: the children of smaller ones degenerate. The same on all ranks. Collective.
std::vector<GlobalIndex> refinable(const mesh::Mesh& mesh, const std::vector<GlobalIndex>& ids);

/// The owned cells (local numbers) of this rank with these ids, which are rising.
std::vector<LocalIndex> owned(const mesh::Mesh& mesh, const std::vector<GlobalIndex>& ids);

}  // namespace thixis::drive
