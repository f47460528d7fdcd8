#pragma once
#include <Kokkos_Core.hpp>
#include <algorithm>

#include "thixis/core/types.hpp"
#include "thixis/mesh/mesh.hpp"
#include "thixis/scene/field.hpp"

namespace thixis::method {

using mesh::View;

/// Quadrature over a set of triangles: one reference rule for most of them, rules of their own for those that the zero set of a level
/// set cuts (across it data jump: a rule that ignores it loses all orders but the first).
///
/// In reference coordinates xi on {(0,0),(1,0),(0,1)}, vertices 0, 1, 2 of the cell; weights sum to 1/2 and are positive. For a cell K,
/// integral over K of f ≈ 2|K| sum_q weight_q f(x(xi_q)). Memory grows with cut cells only, but for an offset and an index per cell.
struct CellQuadrature {
  int order = 0;                    ///< exactness of the reference rule
  View<const LocalIndex*> cell;     ///< the mesh cell at position k
  View<const double* [2]> rule_xi;  ///< reference rule; row by row, as own_xi
  View<const double*> rule_weight;
  View<const LocalIndex*> own_rule;     ///< of position k: -1 for the reference rule, else c
  View<const GlobalIndex*> own_offset;  ///< points of rule c: own_offset(c) <= i < own_offset(c+1)
  View<const double* [2]> own_xi;
  View<const double*> own_weight;
  View<const GlobalIndex*> offset;      ///< points of position k in the numbering of all points: offset(k) … offset(k+1)-1
  View<const double* [2]> coordinates;  ///< of the mesh
  View<const LocalIndex* [3]> cell_vertices;
  LocalIndex block_cells = 0;  ///< positions that for_each_block takes at a time
  int largest_block = 0;       ///< most points of a block: the length of buffers

  LocalIndex cells() const { return static_cast<LocalIndex>(cell.extent(0)); }
  LocalIndex cut_cells() const { return static_cast<LocalIndex>(own_offset.extent(0)) - 1; }
  GlobalIndex points() const;  ///< of all cells on this rank
};

/// The rules for these cells of the mesh, exact for polynomials of degree `order` (0…30) where the level set (may be null) does not cut.
/// In cut cells the curve is followed to about 1e-12 of the cell. `t`: the time at which the level set is taken.
/// Collective; throws InputError on all ranks where the level set is not finite or the order is out of range.
CellQuadrature make_quadrature(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, int order, const scene::FieldPtr& level_set,
                               double t = 0, LocalIndex block_cells = 2048);

/// 0, 1, …, owned_cells-1.
View<const LocalIndex*> owned_cells(const mesh::Mesh& mesh);
/// The owned cells and ghost_patch_cells: all cells that touch an owned vertex.
View<const LocalIndex*> patch_cells(const mesh::Mesh& mesh);

/// The points of some consecutive cells. Overwritten by the next block: keep no Views of it.
struct QuadratureBlock {
  LocalIndex first = 0;  ///< position of its first cell
  LocalIndex cells = 0;
  int points = 0;
  View<const LocalIndex*> cell;      ///< mesh cell of position first + k
  View<const LocalIndex*> own_rule;  ///< as in CellQuadrature: -1 where the points are those of the reference rule
  View<const int*> offset;           ///< points of cell k: offset(k) <= q < offset(k+1)
  View<const double* [2]> xi;        ///< reference coordinates
  View<const double*> weight;        ///< times 2|K|: integral over K of f ≈ sum_q weight(q) f(x(q), y(q))
  View<const double*> x, y;          ///< physical coordinates
};

/// values(q) = field(x(q), y(q), t) for the points of the block; `values` has at least so many entries. Throws InputError where the field
/// is not finite, on this rank only: run for_each_block inside Comm::together.
void evaluate(const scene::Field& field, double t, const QuadratureBlock& block, const View<double*>& values);

/// The buffers of for_each_block.
class QuadraturePoints {
 public:
  explicit QuadraturePoints(const CellQuadrature& quadrature);
  /// Fills in the points of `cells` positions from `first` on.
  const QuadratureBlock& fill(LocalIndex first, LocalIndex cells);

 private:
  const CellQuadrature& quadrature_;
  View<int*> offset_;
  View<double* [2]> xi_;
  View<double*> weight_, x_, y_;
  QuadratureBlock block_;
};

/// Calls f(const QuadratureBlock&) for all cells in turn, some thousand at a time, so that values at their points stay in the cache.
template <class F>
void for_each_block(const CellQuadrature& quadrature, F&& f) {
  QuadraturePoints points(quadrature);
  for (LocalIndex first = 0; first < quadrature.cells(); first += quadrature.block_cells)
    f(points.fill(first, std::min(quadrature.block_cells, quadrature.cells() - first)));
}

}  // namespace thixis::method
