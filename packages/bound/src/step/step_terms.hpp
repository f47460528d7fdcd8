#pragma once
#include "estimate/sums.hpp"
#include "thixis/bound/feasible.hpp"
#include "thixis/bound/guaranteed_bound.hpp"

namespace thixis::bound {

/// b(theta) = 4 theta (1 - theta), which is what data that are not affine in time add: ∫ b, ∫ b², ∫ b'² over ]0, 1[.
constexpr double bulge_mean = 2.0 / 3, bulge_square = 8.0 / 15, bulge_rate = 16.0 / 3;

/// What the feasible pair adds to the square of the bound of a step, per unit of time.
struct OfStep {
  enum {
    pair,               ///< ∫_0^1 |||s - u_h|||²
    rest,               ///< the same without what closing gaps at the nodes takes away
    rest_at_end,        ///< FeasiblePair::Parts::rest² at the end
    at_nodes,           ///< ∫ |||s_N - s_c|||²
    contact,            ///< (lambda^, s_1 - s_2) with the pair at the end,
    contact_then,       ///< at the begin
    contact_at_points,  ///< sum_l M_l max(K_l, 0)
    contact_of_bulge,   ///< (lambda^, d_1 - d_2)
    moved,              ///< square of what is moved apart between both ends
    lift_1,
    lift_2,  ///< |L_alpha(end) - L_alpha(begin)|²
    bulge_1,
    bulge_2,  ///< |d_alpha|²
    count
  };
};

/// The terms of each cell; makes its parts from the squares of its fluxes.
struct StepTerms {
  View<const double*> whole, rest, at_nodes, contact;  ///< at the end
  View<const double*> whole_then, contact_then;        ///< at the begin
  View<const double*> contact_lin, move_change;
  View<const double* [2]> lift_change;  ///< of length 0: the lift does not change
  FeasiblePair::Bulge bulge;            ///< of length 0: data are affine in time
  ConstCellTable lambda;                ///< lambda^
  int count;                            ///< membranes
  double tau;
  double of_move;                    ///< C² sum_alpha apart_alpha²/mu_alpha, with Friedrichs' constant C; else 0
  GuaranteedBound::CellParts cells;  ///< in: squares of the flux terms; out: the roots of all, over the step

  KOKKOS_FUNCTION void operator()(int K, Sums<OfStep>& sum) const;

 private:
  KOKKOS_FUNCTION double add_bulge(int K, Sums<OfStep>& sum) const;
};

}  // namespace thixis::bound
