#pragma once
#include <cstdint>

#include "thixis/mesh/mesh.hpp"
#include "thixis/output/fields.hpp"

namespace thixis::output {

/// The cells of a mesh as they are.
Grid grid_of(const mesh::Mesh& mesh);

/// Sum over all owned entities of a hash of their numbers and coordinates, the same on all ranks: equal for equal grids, whoever owns what.
/// Collective.
std::uint64_t fingerprint(const Grid& grid, const core::Comm& comm);

/// Throws an Error on all ranks if the arrays of the grid have different lengths, the fields have bad names, too few values or
/// are not the same on all ranks. Collective.
void check(const Grid& grid, const std::vector<FieldData>& fields, const core::Comm& comm);

}  // namespace thixis::output
