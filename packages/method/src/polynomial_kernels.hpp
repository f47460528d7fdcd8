#pragma once
#include "thixis/method/cell_functions.hpp"
#include "thixis/method/quadrature.hpp"
#include "thixis/method/space.hpp"

/// Kernels on functions that are polynomials in every cell: u_h = sum_l u(entries(k, l)) psi_l in the patch cell k.
namespace thixis::method {

using Entry = Kokkos::View<const LocalIndex**, Kokkos::LayoutRight>;
using Block2 = Kokkos::View<double**, Kokkos::LayoutRight>;
using Values = Kokkos::View<const double*>;
using Table = Kokkos::View<const double**, Kokkos::LayoutRight>;

/// F(e, l) = (f, psi_l)_K for the cells of the block; f(q) at its points.
void moments(const CellFunctions& functions, const QuadratureBlock& block, const Values& f, const Block2& F);

/// Values of mu and of a known gradient (Views of length 0: none) at the points of a block.
struct AtPoints {
  Values mu, x, y;
};
/// Sum over the first `cells` cells of a block of ∫_K mu |grad u - grad u_h|².
double gradient_error(const CellFunctions& functions, const mesh::Mesh& mesh, const QuadratureBlock& block, LocalIndex cells,
                      const AtPoints& known, const Entry& entries, const Coefficients& u);

/// Sum over the first `cells` cells of a block of ∫_K (u - u_h)²; known(q) = u at its points.
double value_error(const CellFunctions& functions, const QuadratureBlock& block, LocalIndex cells, const Values& known,
                   const Entry& entries, const Coefficients& u);

/// y(e, i) = sum_j A(e, i, j) u(entries(first + e, j)).
void apply(const LocalMatrices& A, LocalIndex first, const Entry& entries, const Coefficients& u, const Block2& y);

/// of_cells(k, l) = u(entries(k, l)), l < functions.
void gather(const Entry& entries, int functions, const Coefficients& u, const Block2& of_cells);

/// out(entries(k, i)) = sum_j T(i, j) u(entries(k, j)) for the first `cells` cells.
void transform(const Table& T, LocalIndex cells, const Entry& entries, const Coefficients& u, const Coefficients& out);

/// fine(k, i) = sum_j T(child(k), i, j) coarse(parent(k), j): a polynomial of the parent in its child.
struct Children {
  Kokkos::View<const double***, Kokkos::LayoutRight> T;  ///< (child, i, j)
  View<const LocalIndex*> child, parent;                 ///< of each cell
};
void restrict_to_children(const Children& children, const Block2& coarse, const Block2& fine);

/// F(e, l) = 2|K| sum_m M(l, m) u(first + e, m): moments of polynomials given cell by cell.
void moments_of(const Table& M, const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, LocalIndex first, const Block2& u,
                const Block2& F);

/// lambda(entries(k, l)) = sum_m M^{-1}(l, m) X3(columns(k, m)) / (2|K|), without the moments whose column is -1, for the first `cells`
/// cells.
void invert_mass(const Table& M_inverse, const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, LocalIndex count,
                 const ElementUnknowns& columns, const Entry& entries, const Values& X3, const Coefficients& lambda);

/// The largest of obstacle(e, q) - u_h at lattice points lambda_q of the first `cells` cells from `first` on, at least 0; an obstacle of
/// length 0 is 0.
double deepest(const CellFunctions& functions, LocalIndex first, LocalIndex cells, const Table& lambda, const Block2& obstacle,
               const Entry& entries, const Coefficients& u);

}  // namespace thixis::method
