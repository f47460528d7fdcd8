#pragma once
#include "thixis/algebra/fwd.hpp"
#include "thixis/algebra/solver.hpp"

namespace thixis::complementarity {

/// A scene after discretization: find X with
///
///     E(X) = F,   K(X) >= 0,   G(X) >= 0,   K(X)·G(X) = 0.
///
/// It has as many rows as unknowns: the equation rows of E and one row for each contact point l. E may be nonlinear.
/// The nonlinear solver sees no matrix: full, reduced and condensed forms differ only inside `linearize` and `solve`.
class Problem {
 public:
  virtual ~Problem() = default;

  virtual algebra::MapPtr map() const = 0;  ///< of X and of the residual
  virtual algebra::MapPtr points()
      const = 0;  ///< of the contact points l: K, G, a, b, c, s; ids independent of the number of ranks are not required

  /// R <- E(X) - F in the equation rows, 0 in the rows of contact points.
  virtual void equations(const algebra::Vector& X, algebra::Vector& R) const = 0;
  /// K_l(X), G_l(X).
  virtual void arguments(const algebra::Vector& X, algebra::Vector& K, algebra::Vector& G) const = 0;
  /// s_l > 0 such that K_l and s_l G_l have the same dimension and the active set is invariant under a change of units.
  virtual void scaling(algebra::Vector& s) const = 0;
  /// Puts one value per contact point into its row of R.
  virtual void insert(const algebra::Vector& C, algebra::Vector& R) const = 0;

  /// Sets up A = [E'(X); a_l K_l' + b_l G_l'].
  virtual void linearize(const algebra::Vector& X, const algebra::Vector& a, const algebra::Vector& b) = 0;
  /// Solves A dX = -R, R = [E(X) - F; C]: dX is overwritten (the loop starts from zero, that is, from X). `stop.tolerance` bounds the
  /// residual of that system in the norm |·| below, `stop.criterion` sees the full recovered dX^i. A problem that knows how far its
  /// linearization reaches may shorten dX, row by row, and says so in the report.
  virtual algebra::LinearReport solve(const algebra::Vector& R, algebra::Vector& dX, const algebra::LinearStop& stop) = 0;

  /// Residuals are measured as |R| = (sum over the rows of (w R)²)^½. Rows of different dimension or of different size need weights w that
  /// make them comparable: fills w, on map(), or returns false where every w is 1. Asked once per run of `newton`.
  virtual bool weights(algebra::Vector&) const { return false; }
  /// |(F, 0)|: what residuals are compared with, the size of what acts.
  virtual double reference_norm() const = 0;
  /// What |R(X)| may be for no other reason than the rounding of its terms: nobody is asked for less.
  virtual double noise(const algebra::Vector&) const { return 0; }
  /// The size of the gaps by which ties are told (see ActiveSet); the largest argument at any point by default. Collective.
  virtual double gap_size(const algebra::Vector& X, const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s) const;

  /// |B| of the Newton system A X^k = B = A X^{k-1} - R in terms of X, with the A of the last `linearize` at X and R the residual there:
  /// what linear residuals are compared with. Default: |(F, 0)|, which is |B| wherever E, K and G are linear and K, G homogeneous (both
  /// C-functions are then homogeneous, too: a K + b G = C); 0 stands for |R|. Override it where that is far off.
  virtual double rhs_norm(const algebra::Vector& X, const algebra::Vector& R) const;

  /// Inside the criterion of `solve`: X_i = X + dX is going to be looked at, and R is what `solve` was given. Until `look_away`, a problem
  /// that has computed the residual at X_i on the way to dX answers `equations` for that object without computing it again. Default:
  /// nothing.
  virtual void look_at(const algebra::Vector& Xi, const algebra::Vector& R) const;
  virtual void look_away() const;

  /// Nonlinear smoothing: `sweeps` cheap local corrections of X towards the solution, which they leave as it is. They settle the edge of
  /// the contact set by many layers of points where a Newton-min step moves it by one. Default: nothing.
  virtual void relax(algebra::Vector& X, int sweeps) const;
};

}  // namespace thixis::complementarity
