#pragma once
#include <array>
#include <memory>

#include "thixis/bound/cell_fields.hpp"
#include "thixis/method/space.hpp"
#include "thixis/scene/field.hpp"

namespace thixis::bound {

/// The feasible pair s of the bound (docs/methods/estimates.md, 4): s_1 >= s_2 in Omega (s >= psi for one membrane over an obstacle),
/// s_alpha = g_alpha exactly on the held boundary, made from u_h in steps
///
///     u_h  ->  s_c: continuous (nodal averages, Dirichlet nodes from g; u_h itself for conforming spaces)
///          ->  s_N: gaps below zero at the nodes are closed, each membrane giving way by theta_alpha (mu_2, mu_1 over mu_1 + mu_2)
///          ->  over an obstacle that jumps inside cells: raised to a continuous majorant of it there
///          ->  s:   + lift of g - g_h, then moved apart by what is left of the negative part of the gap, pointwise, in constant shares
///                   (of the mean tensions where they vary); over an obstacle up to psi itself.
///
/// Polynomial pieces are integrated exactly (varying tensions: by the quadrature of the space). The pointwise move is bounded from above by
/// subdivision where the gap is a polynomial; where lift or obstacle make it more than that, it is integrated at the points of a
/// quadrature.
///
/// Energies are those of the broken gradient, |||v|||_K² = sum_alpha ∫_K mu_alpha |grad v_alpha|².
class FeasiblePair {
 public:
  struct Problem {
    int count = 2;  ///< membranes; 1: over the obstacle
    std::array<scene::FieldPtr, 2> tension;
    std::array<method::BoundaryValues, 2> boundary;
    scene::FieldPtr obstacle;  ///< count = 1
    double time = 0;           ///< at which the boundary data are taken
  };
  /// Set up once per mesh: the lift of g - g_h, its energy being nearly least (nothing where g is a polynomial of degree p on every face).
  /// Collective; the space must outlive it. Throws InputError where a function is not finite or a tension not positive.
  FeasiblePair(const method::Space& space, const Problem& problem);
  ~FeasiblePair();
  FeasiblePair(const FeasiblePair&) = delete;
  FeasiblePair& operator=(const FeasiblePair&) = delete;

  /// Of the owned cells.
  struct Parts {
    View<double*> whole;     ///< |||s - u_h|||_K; where a pointwise move overlaps other pieces a bound, by the triangle inequality
    View<double*> at_nodes;  ///< |||s_N - s_c|||_K: what further Newton steps take away
    View<double*> rest;      ///< a bound on what remains: |||s - s_N|||_K + |||s_c - u_h|||_K
    View<double*> contact;   ///< (lambda, s_1 - s_2)_K
    bool at_points = false;  ///< whether in some cell of this rank a pointwise move or the contact term is what a quadrature makes of it
  };
  /// What becomes of gaps that s_N leaves open where lambda presses: `pressed` closes them as far as that makes |||s - u_h|||² +
  /// 2 (lambda, s_1 - s_2) less (docs/methods/estimates.md, 4.2b). In time s is to be `kept` as it is at either end of a step.
  enum class Gaps { kept, pressed };
  /// u: coefficients of each membrane; those of a conforming space take Space::lift of the data on the held boundary (Bernstein: brought in
  /// order, docs/methods/membranes.md, 5). Over an obstacle only u[0] is read. `lambda`: the non-negative multiplier, densities of degree
  /// `degree` <= 6 in modal coefficients (owned cell, dim P_degree). Overwrites `parts`, which may be empty at first. Gaps that count less
  /// than `small` in a cell, as a part of |||s - u_h|||²_K and of 2 (lambda, s_1 - s_2)_K, are bounded more coarsely. Collective.
  void evaluate(const method::Coefficients (&u)[2], const ConstCellTable& lambda, int degree, Parts& parts, double small = 0,
                Gaps gaps = Gaps::kept) const;

  // -- in time (docs/methods/parabolic_estimates.md) ------------------------------------------------------------------------------
  /// The pair for the boundary data at another time; what does not depend on them is shared. Collective.
  std::unique_ptr<FeasiblePair> at(double time) const;
  double time() const;

  /// Coefficients of s_c: of u itself in conforming spaces, else on nodes of the pair's own. [1] over an obstacle: psi_I.
  using Continuous = std::array<View<const double*>, 2>;
  Continuous continuous(const method::Coefficients (&u)[2]) const;

  /// The polynomial part of the way from u_h to s_N, on the owned cells: functions (not densities) in modal coefficients of degree p.
  struct Way {
    CellTable averages[2];  ///< u_h - s_c; of length 0 for conforming spaces
    CellTable closing[2];   ///< s_c - s_N; of length 0 where no gap is negative at a node, on any rank
    CellTable gap;          ///< Bernstein coefficients of s_N,1 - s_N,2
  };
  /// Collective.
  Way way(const method::Coefficients (&u)[2], const Continuous& s_c) const;

  /// contact(K) = (lambda, s_1 - s_2)_K alone, as `evaluate` has it; cells without a multiplier cost nothing.
  void contact(const Continuous& s_c, const ConstCellTable& lambda, int degree, const View<double*>& contact, double small = 0) const;

  /// A bound on |v|, v of the space with the values of g - g_h at nodes of the held boundary, here or on a finer mesh, and 0 at others:
  /// twice the largest |g - g_h| and the cells that touch the boundary. Collective.
  double change_by_interpolation() const;

  /// Shares of the membranes in the pointwise move.
  std::array<double, 2> apart() const;
  /// |L_alpha - L_alpha of `before`|_K, of L_alpha itself where `before` is null; of length 0: zero. Collective.
  View<double* [2]> change_of_lift(const FeasiblePair* before) const;
  /// Bounds on |max(-gap, 0)|_K and, against the pair and the gap at an earlier time, on |max(-gap, 0) - max(-gap_before, 0)|_K. Overwrites
  /// `size`. `before` null: the former.
  void change_of_move(const CellTable& gap, const View<double* [2]>& change_of_lift, const FeasiblePair* before,
                      const CellTable& gap_before, const View<double*>& size) const;

  /// Boundary data that are not affine in time bulge by d = g(t) - (g_before + g_after)/2 in the middle t of a step: the function that has
  /// the coefficients of d at the nodes of the boundary and is 0 at others.
  struct Bulge {
    View<double*> energy;    ///< (owned cell) |||d|||_K; of length 0: d = 0 up to round-off
    View<double* [2]> size;  ///< (owned cell, alpha) |d_alpha|_K
    CellTable gap;           ///< (owned cell, dim P_p): modal coefficients of d_1 - d_2
  };
  /// Collective.
  Bulge bulge(const FeasiblePair& before, const FeasiblePair& after) const;

  /// Whether psi is its interpolant at all quadrature points, up to round-off.
  bool obstacle_is_interpolated() const;
  /// By patch cell, whether the obstacle jumps inside it; of length 0: nowhere on this rank.
  View<const bool*> jumps() const;
  /// |||lift of g - g_h||| over all cells.
  double boundary_energy() const;
  std::size_t bytes() const;  ///< held for the mesh

 private:
  struct Impl;
  explicit FeasiblePair(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::bound
