#pragma once
#include <cstdint>

#include "thixis/mesh/mesh.hpp"
#include "thixis/output/fields.hpp"

namespace thixis::output {

/// The cells of a mesh as they are.
Grid grid_of(const mesh::Mesh& mesh);

/// The cells of a grid, of whatever kind.
Cells cells_of(const Grid& grid);

/// "segment", "triangle" or "quadrilateral".
const char* cell_name(int corners);

/// Sum over all owned entities of a hash of their numbers and coordinates, the same on all ranks: equal for equal grids, whoever owns what.
/// Collective.
std::uint64_t fingerprint(const Grid& grid, const Cells& cells, const core::Comm& comm);

/// Throws an Error on all ranks if the arrays of the grid have different lengths, its cells are not of one kind, the fields have
/// bad names, too few values or are not the same on all ranks. Collective.
void check(const Grid& grid, const Cells& cells, const std::vector<FieldData>& fields, const core::Comm& comm);

}  // namespace thixis::output
