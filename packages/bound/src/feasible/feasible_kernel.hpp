#pragma once
#include "deviation/deviation_of_cells.hpp"
#include "feasible/negative_part.hpp"
#include "lift/continuous_nodes.hpp"
#include "lift/lift_of_cells.hpp"
#include "thixis/method/cell_functions.hpp"

namespace thixis::bound {

/// The parts of the bound that the feasible pair gives, cell by cell
/// (docs/methods/estimates.md, 4).
struct FeasibleParts {
  int count;  ///< membranes; 1: over an obstacle
  View<double* [2]> x;
  View<LocalIndex* [3]> vertices;
  method::CellFunctions functions;
  CellEnergy energy;
  NegativePart negative_part;
  Matrix to_modal;  ///< of Bernstein polynomials
  LiftOfCells lift;
  Deviation deviation;
  View<const double*> majorant;  ///< coefficients of what s is to be above where it is more than
                                 ///< psi_I; of length 0: psi_I
  Excess excess;

  CellEntries of_cells;                ///< of s_c and psi_I
  Kokkos::View<const double*> s_c[2];  ///< [1] over an obstacle: psi_I
  View<const double*> theta;           ///< mu_2/(mu_1 + mu_2) at the nodes; of length 0: apart[0]
  double apart[2];                     ///< how the pointwise move is split; they sum to 1
  View<const double*> move_tension;    ///< the largest of sum_alpha mu_alpha apart_alpha² in the
                                       ///< cell; of length 0: its constant value
  double constant_move_tension;
  int first_vertex;              ///< functions of vertices: first_vertex + i
  View<const double*> closed;    ///< by vertex: gaps up to that are closed there;
                                 ///< of length 0: none
  View<const double*> followed;  ///< by vertex: the part of D that is taken
                                 ///< away there; of length 0: nothing
  double noise;                  ///< gaps below are round-off: bounded without being cut up
  double small;                  ///< what need not be bounded closely in a cell: of the square
                                 ///< of the move, and of twice the contact term

  CellEntries of_cells_u;  ///< of u; of length 0: u = s_c
  Kokkos::View<const double*> u[2];

  ConstCellTable lambda;
  DensityValues density;
  View<double*> whole, at_nodes, rest, contact;  ///< out, overwritten
  View<bool> at_points;                          ///< out: set where integrals are what a quadrature
                                                 ///< makes of them; may be null

  KOKKOS_FUNCTION void operator()(int K) const;
  /// What `contact` is of s_c alone.
  KOKKOS_FUNCTION double contact_alone(int K) const;
  /// Whether the gap, in Bernstein coefficients, has a negative part that the
  /// pointwise move takes away.
  KOKKOS_FUNCTION bool moves(int K, const double* gap) const;

  KOKKOS_FUNCTION double stiffness(int K) const { return move_tension.extent(0) > 0 ? move_tension(K) : constant_move_tension; }

 private:
  static constexpr int most = reference::max_functions;

  /// The way from s_c at the nodes of a cell, and the gap behind it.
  struct AtNodes {
    double change[2][most], further[2][most], gap[most];
    bool ordered = false;  ///< some gap was below zero
    bool goes_on = false;  ///< something is left to be done behind s_N
  };
  KOKKOS_FUNCTION void go_to_nodes(int K, AtNodes& at) const;
  struct Squares {
    double nodes = 0, further = 0, averages = 0, lift = 0, polynomial = 0;
  };
  KOKKOS_FUNCTION Squares squares(int K, const mesh::CellGeometry& geometry, AtNodes& at) const;

  /// Of the gap g in a cell: the square of what it is moved by, pointwise, and
  /// the integral of the density times what it is then.
  struct Move {
    double square = 0, contact = 0;
  };
  KOKKOS_FUNCTION bool pressed(int K) const {
    for (int k = 0; k < lambda.extent_int(1); ++k)
      if (lambda(K, k) != 0) return true;
    return false;
  }
  KOKKOS_FUNCTION Move move_polynomial(int K, const mesh::CellGeometry& geometry, const double* gap, bool counts) const;
  KOKKOS_FUNCTION Move move_pointwise(int K, LocalIndex place, const mesh::CellGeometry& geometry, const double* gap, bool counts) const;
  /// What is taken of a gap: all of it up to `most`, less and less up to twice
  /// as much, and nothing of larger ones.
  KOKKOS_FUNCTION static double part_closed(double gap, double most) {
    const double rest = 2 * most - gap, part = gap < rest ? gap : rest;
    return part > 0 ? part : 0;
  }
  /// Whether D is followed in some corner of a cell.
  KOKKOS_FUNCTION bool follows(int K) const {
    for (int i = 0; i < 3 && followed.extent(0) > 0; ++i)
      if (followed(vertices(K, i)) > 0) return true;
    return false;
  }
  /// What s is to be above at a node.
  KOKKOS_FUNCTION double floor(LocalIndex e) const { return majorant.extent(0) > 0 ? majorant(e) : s_c[1](e); }
  /// The integral of the density times what the majorant is above the obstacle.
  KOKKOS_FUNCTION double contact_of_excess(int K) const {
    const LocalIndex at = excess.place.extent(0) > 0 ? excess.place(K) : -1;
    const int n = functions.size(), m = n < lambda.extent_int(1) ? n : lambda.extent_int(1);
    double sum = 0;
    for (int k = 0; k < m && at >= 0; ++k) sum += lambda(K, k) * excess.moments(at, k);
    return sum > 0 ? sum : 0;
  }
  KOKKOS_FUNCTION double contact_of(int K, const double* gap) const {
    const int n = functions.size(), m = n < lambda.extent_int(1) ? n : lambda.extent_int(1);
    double sum = 0;
    for (int k = 0; k < m; ++k) {
      double modal = 0;
      for (int l = 0; l < n; ++l) modal += to_modal(k, l) * gap[l];
      sum += lambda(K, k) * modal;
    }
    return sum;
  }
};

}  // namespace thixis::bound
