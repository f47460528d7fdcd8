#pragma once
#include <vector>

#include "thixis/method/quadrature.hpp"
#include "thixis/reference/cell_basis.hpp"

namespace thixis::method {

/// Cells inside which a function jumps, and between which values.
struct Jumps {
  struct Range {
    bool jumps = false;
    double low = 0, high = 0;  ///< where it jumps: of the values seen in the cell
  };
  std::vector<Range> of_cells;  ///< by position in the quadrature; empty: it jumps in none
  bool any() const { return !of_cells.empty(); }
  bool at(LocalIndex k) const { return any() && of_cells[k].jumps; }
};

/// Halves the way between the highest and the lowest place of v - (the linear interpolant of v) among many points of the cell, always
/// towards the greater difference, twelve times: that of a function without jumps has then become small (2^-12 of it where it has a slope,
/// 2^-6 where it grows like a root), and one that keeps a sixteenth of it is taken to jump. A function is seen at points only: what is
/// narrower than their distance can be missed, and a rise within some 2^-8 of a cell counts as a jump. Throws InputError on this rank only.
Jumps jumps_in_cells(const CellQuadrature& quadrature, const scene::Field& v, double t);

/// The coefficients of a function that may jump, as an obstacle is seen by the contact points of a discrete problem: the interpolant in
/// cells in which it does not jump; and in the others no more than the lowest value, so that points inside of them do not press against
/// the wrong side of an edge. Coefficients stay in the range of the function's values there, where an interpolant would not.
///
///   shared  - continuous functions: those that a cell without a jump knows too are its own, and vertices have the value at their place;
///   lowest  - every coefficient of a cell with a jump.
enum class AtJumps { shared, lowest };

/// `value`: of the function at the places of the entries, in; coefficients, out. `of_cells`: (k, l) -> entry, k as in `jumps`.
void interpolate_with_jumps(const reference::CellBasis& basis, const Kokkos::View<const LocalIndex**, Kokkos::LayoutRight>& of_cells,
                            const Jumps& jumps, AtJumps rule, std::vector<double>& value);

}  // namespace thixis::method
