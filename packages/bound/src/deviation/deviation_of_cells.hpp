#pragma once
#include "thixis/bound/cell_fields.hpp"
#include "thixis/method/quadrature.hpp"

namespace thixis::bound {

/// What makes the gap of s more than a polynomial in some cells: D = L_1 - L_2,
/// over an obstacle D = L_1 + psi_I - psi.
struct Deviation {
  View<const LocalIndex*> place;      ///< of each owned cell, -1: D = 0 there; of length 0: everywhere
  method::CellQuadrature quadrature;  ///< on the places
  View<const double*> bound;          ///< of |D| in the cell
  View<const double* [3]> at_points;  ///< D and its derivatives
  View<const bool* [3]> on_held;      ///< (place, i): whether D is more than
                                      ///< round-off on face i, which is held
  bool of_obstacle = false;           ///< psi is more than psi_I in some cell of some rank
  KOKKOS_FUNCTION LocalIndex operator()(LocalIndex K) const { return place.extent(0) == 0 ? -1 : place(K); }
};

/// Where the majorant of an obstacle is above it: moments of the difference
/// against the modal polynomials of degree p, on the reference triangle.
struct Excess {
  View<LocalIndex*> place;  ///< of a cell in `moments`, -1: none; of length 0: no cell has one
  CellTable moments;
};

}  // namespace thixis::bound
