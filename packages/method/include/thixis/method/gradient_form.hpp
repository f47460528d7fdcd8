#pragma once
#include <memory>

#include "thixis/method/form.hpp"
#include "thixis/reference/cell_basis.hpp"

namespace thixis::method {

/// (mu grad u, grad v)_K on the cells of `quadrature`, for their polynomials: exact for constant tensions (three reference matrices), by
/// the quadrature for others. Collective; throws InputError where the tension is not positive.
std::shared_ptr<const ElementForm> gradient_form(const mesh::Mesh& mesh, const CellQuadrature& quadrature,
                                                 const reference::CellBasis& basis, const scene::Field& tension);

/// Values of a tension at all points of the quadrature, in their numbering. Collective; throws InputError where one is not positive.
View<double*> tension_at_points(const mesh::Mesh& mesh, const CellQuadrature& quadrature, const scene::Field& tension);

/// Values of any coefficient, likewise; throws where one is not finite.
View<double*> values_at_points(const mesh::Mesh& mesh, const CellQuadrature& quadrature, const scene::Field& field);

/// Form::energy of diffusion: ∫ mu |grad u - grad u_h|², of scalar spaces.
double gradient_energy(const Space& space, const scene::Field& tension, const QuadratureBlock& block, LocalIndex cells,
                       const Coefficients& uh, const std::vector<Known>& u, double t);

/// So many cells fit the cache with their local matrices of this width.
LocalIndex cells_per_block(int width);

}  // namespace thixis::method
