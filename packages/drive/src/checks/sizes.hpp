#pragma once
#include "thixis/core/comm.hpp"
#include "thixis/drive/params.hpp"

namespace thixis::drive {

/// Cells of the finest mesh that the generator makes; nothing where a file says it.
std::optional<double> planned_cells(const mesh::MeshParams& params);

/// What a run needs at least on a mesh of so many cells, in MB: half of what the most frugal settings of the method were measured to take.
double least_memory_mb(const RunParams& params, double cells);

/// Throws InputError where a run on so many cells can not fit: "mesh/refinements: the run needs 530 GB of memory or more, ...". Collective.
void require_memory(const RunParams& params, double cells, const core::Comm& comm);
/// The same before there is a mesh, where the deck says how large it becomes.
void require_memory(const RunParams& params, const core::Comm& comm);

}  // namespace thixis::drive
