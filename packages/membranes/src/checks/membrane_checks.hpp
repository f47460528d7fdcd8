#pragma once
#include <array>
#include <string>
#include <vector>

#include "scene/boundary.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/mesh/locate.hpp"
#include "thixis/method/params.hpp"
#include "thixis/models/model.hpp"

/// What is wrong with a membrane scene on a mesh, found before anything is computed or written. All throw InputError on all ranks.
namespace thixis::membranes {

/// Throws where no part of the boundary is held. In time nothing needs to be: the membranes move, and have a place at every time.
void check_held(const MembraneScene& scene, const Boundary& boundary);

/// Throws where no solution exists at time t: g1 < g2 (g < psi) on a held face, data that jump between two held parts; and where boundary
/// data are not finite. Collective.
void check_boundary(const MembraneScene& scene, const Boundary& boundary, const method::MethodParams& method, const mesh::Mesh& mesh,
                    double t);

/// The same at several times, without the mesh: at points of the boundary of a domain that a generator makes. Those of a file are not
/// looked at.
void check_boundary(const MembraneScene& scene, const mesh::MeshParams& params, const std::vector<double>& times);

/// Throws where u_1 < u_2 at time 0. Collective.
void check_order(const scene::FieldPtr (&initial)[2], const method::MethodParams& method, const mesh::Mesh& mesh);

/// Throws where g1 < g2 (g < psi) on a held face, where a tension is not positive, and where a function is not finite at a point where the
/// run will ask for it. The functions of catalogued cases are known to be sound and not asked. Collective.
void check_functions(const MembraneScene& scene, const std::array<scene::FieldPtr, 3>& initial, const method::MethodParams& method,
                     const mesh::Mesh& mesh);

/// Where points lie; throws for one outside of the mesh. Collective.
std::vector<mesh::Place> place(const std::vector<models::Probe>& probes, const mesh::Mesh& mesh);

/// Throws for names of fields that this model does not have.
void check_field_names(const MembraneScene& scene, const std::vector<std::string>& names);

}  // namespace thixis::membranes
