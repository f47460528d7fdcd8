#pragma once
#include "thixis/method/cell_functions.hpp"
#include "thixis/method/form.hpp"
#include "thixis/method/quadrature.hpp"

/// Kernels on functions that are polynomials in every cell: u_h = sum_l u(entries(k, l)) psi_l in the patch cell k.
namespace thixis::method {

using Entry = ElementEntries;
using Block2 = Kokkos::View<double**, Kokkos::LayoutRight>;
using Values = Kokkos::View<const double*>;
using Table = Kokkos::View<const double**, Kokkos::LayoutRight>;

/// One of the components of a space: where its function psi_l comes in a cell.
struct Component {
  int count = 1, index = 0;
  KOKKOS_INLINE_FUNCTION int operator()(int l) const { return count * l + index; }
};

/// F(e, component(l)) = (f, psi_l)_K for the cells of the block; f(q) at its points. at_rule(q, l) = psi_l at the points of the reference
/// rule.
void moments(const CellFunctions& functions, const Table& at_rule, const QuadratureBlock& block, const Values& f,
             const Component& component, const Block2& F);

/// Values of mu and of a known gradient (Views of length 0: none) at the points of a block.
struct AtPoints {
  Values mu, x, y;
};
/// Sum over the first `cells` cells of a block of ∫_K mu |grad u - grad u_h|².
double gradient_error(const CellFunctions& functions, const mesh::Mesh& mesh, const QuadratureBlock& block, LocalIndex cells,
                      const AtPoints& known, const Entry& entries, const Coefficients& u);

/// Sum over the first `cells` cells of a block of ∫_K (u - u_h)², u_h a component; known(q) = u at its points.
double value_error(const CellFunctions& functions, const QuadratureBlock& block, LocalIndex cells, const Values& known,
                   const Entry& entries, const Component& component, const Coefficients& u);

/// y(e, i) = sum_j A(e, i, j) u(entries(first + e, j)), without entries -1.
void apply(const LocalMatrices& A, LocalIndex first, const Entry& entries, const Coefficients& u, const Block2& y);

/// out(entries(k, i)) = sum_j T(i, j) u(entries(k, j)) for each component in the first `cells` cells.
void transform(const Table& T, LocalIndex cells, int components, const Entry& entries, const Coefficients& u, const Coefficients& out);

/// lambda(entries(k, l)) = sum_m M^{-1}(l, m) X3(columns(k, m)) / (2|K|), without the moments whose column is -1, for the first `cells`
/// cells.
void invert_mass(const Table& M_inverse, const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, LocalIndex count,
                 const ElementUnknowns& columns, const Entry& entries, const Values& X3, const Coefficients& lambda);

/// count(row) = the cells among whose first `functions` unknowns it is; `count` begins with 0.
void count_cells(const ElementUnknowns& columns, int functions, const View<int*>& count);

/// The largest of obstacle(e, q) - u_h at lattice points lambda_q of the first `cells` cells from `first` on, at least 0; an obstacle of
/// length 0 is 0.
double deepest(const CellFunctions& functions, LocalIndex first, LocalIndex cells, const Table& lambda, const Block2& obstacle,
               const Entry& entries, const Coefficients& u);

}  // namespace thixis::method
