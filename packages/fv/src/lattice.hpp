#pragma once
#include <array>

#include "thixis/core/types.hpp"
#include "thixis/mesh/build.hpp"

namespace thixis::fv {

/// n_a x n_b equal cells of a rectangle, numbered along the axis a first, which is the one with fewer cells; or an interval, whose cells
/// lie along b, with n_a = 1 and no faces across a. Layer b = 0, 1, … of the cells holds
///   cells (a, b):         id = b n_a + a;
///   vertices (a, b):      id = b (n_a + 1) + a, of an interval b;
///   faces below (a, b):   id = b (2 n_a + 1) + a, orthogonal to the axis b, of an interval b;
///   faces beside (a, b):  id = b (2 n_a + 1) + n_a + a, orthogonal to the axis a, between the cells (a - 1, b) and (a, b).
/// So faces point from the cell of lower id to that of higher id along their axis.
struct Lattice {
  int dimension = 2;
  int axis_a = 1, axis_b = 0;  ///< 0: x, 1: y
  GlobalIndex n_a = 1, n_b = 1;
  std::array<double, 2> lower = {0, 0}, upper = {0, 0};  ///< x, y; y = 0 for an interval

  GlobalIndex row_of_vertices() const { return dimension == 1 ? 1 : n_a + 1; }
  GlobalIndex row_of_faces() const { return dimension == 1 ? 1 : 2 * n_a + 1; }

  GlobalIndex cells() const { return n_a * n_b; }
  GlobalIndex vertices() const { return row_of_vertices() * (n_b + 1); }
  GlobalIndex faces() const { return row_of_faces() * n_b + n_a; }

  GlobalIndex cell(GlobalIndex a, GlobalIndex b) const { return b * n_a + a; }
  GlobalIndex vertex(GlobalIndex a, GlobalIndex b) const { return b * row_of_vertices() + a; }
  GlobalIndex face_below(GlobalIndex a, GlobalIndex b) const { return b * row_of_faces() + a; }
  GlobalIndex face_beside(GlobalIndex a, GlobalIndex b) const { return b * row_of_faces() + n_a + a; }

  /// Lengths of a cell along the axes; step_a = 1, the section, for an interval.
  double step_a() const { return dimension == 1 ? 1 : (upper[axis_a] - lower[axis_a]) / static_cast<double>(n_a); }
  double step_b() const { return (upper[axis_b] - lower[axis_b]) / static_cast<double>(n_b); }
  /// The point (a, b) in units of cells, exact at the corners of the rectangle.
  std::array<double, 2> point(double a, double b) const;
};

/// The lattice of the generators `interval` and `tensor`, refined.
Lattice lattice(const mesh::MeshParams& params);

/// Ranks side by side: rank = k_b * parts_a + k_a holds the cells a with begin(n_a, parts_a, k_a) <= a < begin(n_a, parts_a, k_a + 1), and
/// b likewise.
struct Split {
  int parts_a = 1, parts_b = 1;
};

/// The split of a number of ranks that leaves the fewest ranks without cells and, of these, cuts the fewest faces.
Split split(const Lattice& lattice, int ranks);

/// The first of n entities that belongs to part k of n shared evenly.
GlobalIndex begin(GlobalIndex n, int parts, int k);
/// The part to which entity i of n belongs.
int part_of(GlobalIndex n, int parts, GlobalIndex i);

}  // namespace thixis::fv
