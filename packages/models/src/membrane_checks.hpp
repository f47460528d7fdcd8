#pragma once
#include <array>
#include <string>
#include <vector>

#include "thixis/mesh/locate.hpp"
#include "thixis/method/space.hpp"
#include "thixis/models/model.hpp"
#include "thixis/scene/membranes.hpp"

/// What is wrong with a membrane scene on a mesh, found before anything is computed or written. All throw InputError on all ranks.
namespace thixis::models {

/// The scene's conditions in the order of the mesh's tags.
struct Boundary {
  std::vector<bool> dirichlet;
  method::BoundaryValues values[2];
};

/// Throws for tags that the mesh does not have, tags without data, and where no part of the boundary is held.
Boundary boundary_of(const scene::MembraneScene& scene, const mesh::Mesh& mesh);

/// Throws where g1 < g2 (g < psi) on a held face at time t, since no solution exists then, and where boundary data are not finite.
/// Collective.
void check_boundary(const scene::MembraneScene& scene, const Boundary& boundary, const method::MethodParams& method, const mesh::Mesh& mesh,
                    double t);

/// Throws where u_1 < u_2 at time 0. Collective.
void check_order(const scene::FieldPtr (&initial)[2], const method::MethodParams& method, const mesh::Mesh& mesh);

/// Throws where g1 < g2 (g < psi) on a held face, where a tension is not positive, and where a function is not finite at a point where the
/// run will ask for it. The functions of catalogued cases are known to be sound and not asked. Collective.
void check_functions(const scene::MembraneScene& scene, const std::array<scene::FieldPtr, 3>& initial, const method::MethodParams& method,
                     const mesh::Mesh& mesh);

/// Where points lie; throws for one outside of the mesh. Collective.
std::vector<mesh::Place> place(const std::vector<Probe>& probes, const mesh::Mesh& mesh);

/// Throws for names of fields that this model does not have.
void check_field_names(const scene::MembraneScene& scene, const std::vector<std::string>& names);

}  // namespace thixis::models
