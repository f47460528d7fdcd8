#pragma once
#include <memory>

#include "reference_cell.hpp"
#include "thixis/method/form.hpp"
#include "thixis/method/quadrature.hpp"

namespace thixis::hho {

/// a_K(u, v) = (mu G_K u, G_K v)_K + sum_F kappa mu_K/h (Π_F u_K - u_F, Π_F v_K - v_F)_F on the cells of `quadrature`, mu_K the mean of mu.
/// Exact for constant tensions, by the quadrature for others. Unknowns: those of ReferenceCell, but face functions run from the lower to
/// the higher vertex id. Collective; throws InputError where the tension is not positive.
std::shared_ptr<const method::ElementForm> cell_form(const mesh::Mesh& mesh, const method::CellQuadrature& quadrature,
                                                     const ReferenceCell& reference, const method::MethodParams& params,
                                                     const scene::Field& tension);

}  // namespace thixis::hho
