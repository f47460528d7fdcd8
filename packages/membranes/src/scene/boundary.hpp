#pragma once
#include <string>
#include <vector>

#include "thixis/membranes/scene.hpp"
#include "thixis/mesh/mesh.hpp"
#include "thixis/method/data.hpp"

namespace thixis::membranes {

/// The scene's conditions in the order of the mesh's tags.
struct Boundary {
  std::vector<std::string> named;  ///< by which group the deck speaks of each part; empty: by none
  std::vector<bool> dirichlet;
  method::BoundaryValues values[2];
};

/// Throws for tags that the mesh does not have, and tags without data.
Boundary boundary_of(const MembraneScene& scene, const mesh::Mesh& mesh);

/// Whether functions, and values on held parts of the boundary, are known not to depend on time; null: nothing is there.
bool steady(const std::vector<scene::FieldPtr>& fields);
bool steady_boundary(const MembraneScene& scene);

}  // namespace thixis::membranes
