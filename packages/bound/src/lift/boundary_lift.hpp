#pragma once
#include <array>
#include <memory>
#include <vector>

#include "lift/held_faces.hpp"
#include "lift/lift_equations.hpp"
#include "lift/lift_of_cells.hpp"

namespace thixis::bound {

/// The lift L = l + v of delta = g - g_h, what Dirichlet data have beyond their interpolant (docs/methods/estimates.md, 4): on the face i
/// with ends j, k of a boundary cell, in barycentric coordinates lambda of the cell,
///
///     l(x) = lambda_j lambda_k q(lambda_k + lambda_i/2),     delta(s) = s (1 - s) q(s),  s from j to k,
///
/// which is delta on the face and vanishes on the others; q a polynomial of degree LiftInCell::resolution. v is continuous, of degree 4, in
/// the layer of three rows of cells along the held boundary (those that touch it, those that touch these, …), 0 on it and on the layer's
/// rim, and makes the energy of L least. Bubbles alone, v = 0, cost twice the least energy; one row leaves up to 25 % over the least energy
/// of all liftings (degree 1), three rows 2 %.
class BoundaryLift {
 public:
  /// Of the data at `time`. `held`: coefficients of g_h on `nodes`. `other`: a lift of these data at another time, whose equations are
  /// taken over. Collective.
  BoundaryLift(const method::Space& space, const ContinuousNodes& nodes, const std::array<scene::FieldPtr, 2>& tension,
               const std::array<method::BoundaryValues, 2>& boundary, const std::vector<double> (&held)[2], int count, double time = 0,
               const BoundaryLift* other = nullptr);
  ~BoundaryLift();

  /// The data are polynomials of degree p on the faces, up to round-off: there is no lift, and nothing is allocated for it.
  bool empty() const { return empty_; }
  const View<const LocalIndex*>& cells() const { return owned_; }  ///< owned cells of the layer
  const LiftOfCells& of_cells() const { return of_cells_; }
  double energy() const { return energy_; }    ///< |||L||| over all cells of all ranks
  double largest() const { return largest_; }  ///< of |g - g_h| seen on this rank

  /// Adds what q leaves of delta, rho = delta - s (1 - s) q: |||E|||_K of its extension E = (1 - r) rho(s), r = 0 on the face and 1 at the
  /// opposite vertex, over all held faces of the owned cell,
  ///
  ///     ∫_K |grad E|² = |K| ∫_0^1 (rho'/|F|)² + (rho' (s - a) - rho)²/H² ds,   a the foot of the height H on the face, by 64 pieces.
  void add_remainder(const View<double*>& of_cells) const;

  struct Value {
    double value = 0, gradient[2] = {0, 0};
  };
  /// L_alpha in the owned layer cell cells()(place).
  Value operator()(int alpha, LocalIndex place, double xi, double eta) const;
  /// L_1 - L_2 there (over an obstacle L_1), to be tabulated at many points.
  LiftInCell difference(LocalIndex place) const;
  /// (owned cell, alpha): |L_alpha - L_alpha of `before`|_K; `before` null: |L_alpha|_K. Of length 0 where both are empty.
  View<double* [2]> change(const BoundaryLift* before) const;
  LiftTable table(const View<const double* [2]>& xi) const { return LiftTable(basis_.bernstein(), xi); }
  /// Of |L_1 - L_2| in that cell.
  double bound_of_difference(LocalIndex place) const;

 private:
  void set_layer(const std::vector<LocalIndex>& positions, const std::vector<HeldFaces::Cell>& faces);
  void integrate(const std::array<scene::FieldPtr, 2>& tension);

  const method::Space& space_;
  mesh::HostMesh host_;
  int count_;
  std::shared_ptr<const LiftEquations> equations_;  ///< of v
  bool empty_ = true;
  std::vector<HeldFaces::Remainder> remainder_;
  View<const LocalIndex*> layer_, owned_;  ///< layer cells of this rank: the owned ones first
  reference::CellBasis basis_;             ///< of v
  std::vector<LiftInCell> lift_[2];        ///< in the layer cells; v is known in the owned ones
  LiftOfCells of_cells_;
  double energy_ = 0, largest_ = 0;
};

}  // namespace thixis::bound
