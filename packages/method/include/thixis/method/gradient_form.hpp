#pragma once
#include <memory>

#include "thixis/method/quadrature.hpp"
#include "thixis/method/space.hpp"
#include "thixis/reference/cell_basis.hpp"

namespace thixis::method {

/// (mu grad u, grad v)_K on the cells of `quadrature`, for their polynomials: exact for constant tensions (three reference matrices), by
/// the quadrature for others. Collective; throws InputError where the tension is not positive.
std::shared_ptr<const CellForm> gradient_form(const mesh::Mesh& mesh, const CellQuadrature& quadrature, const reference::CellBasis& basis,
                                              const scene::Field& tension);

/// Values of a tension at all points of the quadrature, in their numbering. Collective; throws InputError where one is not positive.
View<double*> tension_at_points(const mesh::Mesh& mesh, const CellQuadrature& quadrature, const scene::Field& tension);

/// So many cells fit the cache with their local matrices of this width.
LocalIndex cells_per_block(int width);

}  // namespace thixis::method
