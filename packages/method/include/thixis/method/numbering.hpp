#pragma once
#include <array>
#include <vector>

#include "thixis/algebra/fwd.hpp"
#include "thixis/core/comm.hpp"
#include "thixis/mesh/mesh.hpp"

namespace thixis::method {

/// The coefficients of a space on this rank, one entry each, in the numbering of Coefficients: those of its own and of the patch cells.
struct Entries {
  std::vector<GlobalIndex> id;               ///< identity over all ranks (Space::unknown_ids)
  std::vector<int> owner;                    ///< rank
  std::vector<LocalIndex> held;              ///< tag of the Dirichlet data that fix it, -1 for an unknown; what the owner says counts
  std::vector<std::array<double, 2>> point;  ///< its place
  LocalIndex size() const { return static_cast<LocalIndex>(id.size()); }
  void reserve(std::size_t count);
  void add(GlobalIndex id, int owner, LocalIndex held, std::array<double, 2> point);
};

/// Unknowns of this rank are its own entries that nothing holds, in the order of the entries, numbered contiguously over the ranks;
/// the columns are these and then the ghosts, by owner and identity.
struct Numbering {
  algebra::MapPtr rows, columns;
  mesh::View<LocalIndex*> entry_of_column;
  mesh::View<LocalIndex*> column_of_entry;  ///< -1: held
  std::vector<LocalIndex> held;             ///< per entry, as its owner says
};

/// Collective.
Numbering number(const Entries& entries, const core::Comm& comm);

}  // namespace thixis::method
