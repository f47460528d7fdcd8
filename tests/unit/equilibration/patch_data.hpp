#pragma once
#include <string>
#include <vector>

#include "thixis/equilibration/patch_flux.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/mesh/host.hpp"

/// Meshes, boundary parts and data for fluxes on patches. On a host that Views live on.
namespace thixis::equilibration {

/// "criss-cross", "rectangle", "disk", "file", refined once or not; "wheel": 70 cells around a vertex.
mesh::Hierarchy hierarchy(const std::string& name, int refinements, const core::Comm& comm = core::Comm());

enum class Held { all, none, some };  ///< some: the first half of the tags; left and right, so that all corners are mixed
std::vector<bool> held_tags(const mesh::Mesh& mesh, Held held);

struct PatchData {
  CellTable density, target, traction;
  PatchFlux::Data data() const { return {density, target, traction}; }
};

/// Numbers in [-1, 1] that depend on ids and not on the number of ranks; densities sum to what leaves by given fluxes where no face is
/// free.
PatchData random_data(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, const std::vector<bool>& held, int q);

}  // namespace thixis::equilibration
