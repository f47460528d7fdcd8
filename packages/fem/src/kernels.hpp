#pragma once
#include <Kokkos_Core.hpp>

#include "thixis/mesh/mesh.hpp"
#include "thixis/method/quadrature.hpp"

/// Local kernels of continuous P1 on triangles. Each works on a block of cells: entry e belongs to cell `cells(first + e)`.
namespace thixis::fem {

using Block1 = Kokkos::View<double*, Kokkos::LayoutRight>;
using Block2 = Kokkos::View<double**, Kokkos::LayoutRight>;
using Block3 = Kokkos::View<double***, Kokkos::LayoutRight>;
using Cells = Kokkos::View<const LocalIndex*>;

/// A_K(i,j) = mu_K |K| grad(psi_i)·grad(psi_j); mu(e) is the mean of the tension over the cell.
void stiffness(const mesh::Mesh& mesh, const Cells& cells, LocalIndex first, const Block1& mu, const Block3& A);

/// y_K(i) = mu_K |K| grad(u_h)·grad(psi_i) from the vertex values of u_h; also the energy mu_K |K| |grad(u_h)|² of each cell.
void forces(const mesh::Mesh& mesh, const Cells& cells, LocalIndex first, const Block1& mu, const Kokkos::View<const double*>& u,
            const Block2& y, const Block1& energy);

/// F_K(i) = (f, psi_i)_K for the cells of a block of quadrature points; f(q) are the values at them.
void loads(const method::QuadratureBlock& block, const Kokkos::View<const double*>& f, const Block2& F);

/// Mean of f over each cell of a block.
void means(const method::QuadratureBlock& block, const Kokkos::View<const double*>& f, const Block1& mean);

/// Values at the points of a block: tension and gradient of a known function.
struct KnownGradient {
  Kokkos::View<const double*> mu, x, y;
};
/// Sum over the first `cells` cells of the block of ∫_K mu |grad u - grad u_h|², u_h by its vertex values.
double gradient_error(const mesh::Mesh& mesh, const method::QuadratureBlock& block, LocalIndex cells, const KnownGradient& exact,
                      const Kokkos::View<const double*>& u);

/// d_K(i) = (psi_i, 1)_K = |K| / 3.
void mean_values(const mesh::Mesh& mesh, const Cells& cells, LocalIndex first, const Block2& d);

}  // namespace thixis::fem
