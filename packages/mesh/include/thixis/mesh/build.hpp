#pragma once
#include <string>
#include <vector>

#include "thixis/core/comm.hpp"
#include "thixis/core/schema.hpp"

namespace thixis::mesh {

struct Hierarchy;

enum class Generator { criss_cross, rectangle, disk, file };

/// Block `mesh` of the deck.
struct MeshParams {
  Generator generator = Generator::criss_cross;
  int cells_per_side = 4;
  std::vector<double> lower = {0, 0}, upper = {1, 1};
  int rings = 4;
  int refinements = 0;
  std::string file;
  int cells_per_rank = 1000;  ///< the coarsest level with that many cells per rank is partitioned
  static const core::Schema<MeshParams>& schema();
};

/// Builds the mesh and its uniform refinements, partitioned over the ranks. Throws InputError (parameters), FileError (mesh file).
/// `folder`: that of the deck; relative mesh files start there.
Hierarchy build(const MeshParams& params, const core::Comm& comm, const std::string& folder);

}  // namespace thixis::mesh
