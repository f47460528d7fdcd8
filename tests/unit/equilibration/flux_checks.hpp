#pragma once
#include "thixis/equilibration/cell_fields.hpp"
#include "thixis/method/quadrature.hpp"

/// What a flux given cell by cell is, over all ranks.
namespace thixis::equilibration {

/// Largest difference between the density of div sigma and r, relative to the largest |r|. Collective.
double divergence_error(const mesh::Mesh& mesh, int q, const ConstCellTable& sigma, const ConstCellTable& r);

/// Largest difference of the Legendre moments of the normal flux from both cells of an inner face, relative to the largest moment; on
/// tags that are not `held`, where given, the largest moment itself. Collective.
double jump_of_normal_flux(const mesh::Mesh& mesh, int q, const ConstCellTable& sigma, const std::vector<bool>& held = {});

/// |sigma|². Collective.
double energy(const mesh::Mesh& mesh, const ConstCellTable& sigma);

}  // namespace thixis::equilibration
