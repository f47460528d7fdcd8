#pragma once
#include <Kokkos_Core.hpp>

#include "thixis/mesh/mesh.hpp"

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

/// d_K(i) = (psi_i, 1)_K = |K| / 3.
void mean_values(const mesh::Mesh& mesh, const Cells& cells, LocalIndex first, const Block2& d);

}  // namespace thixis::fem
