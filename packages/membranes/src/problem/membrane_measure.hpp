#pragma once
#include <functional>

#include "problem/membrane_operator.hpp"
#include "thixis/contact/weights.hpp"

namespace thixis::membranes {

/// Membranes at rest: what moves them from there is what acts.
struct Rest {
  const algebra::MultiVector* u = nullptr;  ///< u°_alpha, unknowns; null: zero
  std::array<double, 2> height = {0, 0};    ///< of each membrane
  std::array<double, 2> size = {0, 0};      ///< of each membrane: the largest height at which it is held, that of the start
  double reach = 0;                         ///< over an obstacle: the membrane comes no lower, whatever the obstacle does
  /// |forces on a membrane|, boundary data not among them; asked for where these hide what drives the gap. Empty: they cannot.
  std::function<double(int alpha)> force;
};

/// By what residuals of membranes are measured: derived in docs/methods/membranes.md, 3. Every scale comes from what acts or can touch,
/// none from the largest number in the data, so that
///
///     |R|² = sum_alpha (w_alpha |R_alpha|)² + sum_l (w_C kappa_l C_l)²,     1/kappa_l = sum_alpha 1/S_alpha,ll,
///
/// is a force, changes neither with the origin of heights nor, but for the unit of force, with any other unit, and looks at each membrane
/// as closely as the forces on it deserve.
class MembraneMeasure {
 public:
  /// The diagonals of the operator's matrices. Collective.
  explicit MembraneMeasure(const MembraneOperator& membranes);

  /// The weights and the reference, from the operator's loads and, if given, from the forces `body` on each membrane, which count even
  /// where tension balances them. Collective.
  void set(const MembraneOperator& membranes, const Rest& rest, const Teuchos::RCP<algebra::Vector>* body = nullptr);

  const contact::Weights& weights() const { return weights_; }
  double weight(int alpha) const { return weights_.field[alpha]; }  ///< w_alpha
  double contact_weight() const { return weights_.contact; }        ///< w_C = max w_alpha
  double reference() const { return reference_; }                   ///< the size of what acts, as a residual
  double on_gap() const { return on_gap_; }                         ///< what would act on a gap that is closed everywhere
  const algebra::Vector& stiffness() const { return *stiffness_; }  ///< kappa, on points()
  const algebra::Vector& diagonal(int alpha) const { return *diagonal_[alpha]; }

  /// What rounding of S u leaves in |R|. Collective.
  double round_off(const algebra::MultiVector& u) const;
  /// What it leaves in a row of one membrane, at worst, and what it leaves of the heights in the data. Collective.
  double round_off(int alpha, const algebra::MultiVector& u) const;
  /// As forces, for each membrane; and in z = u_1 - u_2, the gap. Collective.
  std::array<double, 2> rounded_forces(const algebra::MultiVector& u) const;
  double on_gap(const std::array<double, 2>& forces) const;
  /// The largest height of a membrane, of u and of the data. Collective.
  std::array<double, 2> heights(const algebra::MultiVector& u) const;
  /// max_l |u_alpha,l - height_alpha| at the contact points: how far a membrane is moved. Collective.
  double displacement(int alpha, const algebra::MultiVector& u) const;
  double displacement(const algebra::MultiVector& u) const;  ///< … of all
  /// What rounding leaves in the heights of a membrane, at worst: of u, and of the heights in the data. Collective.
  double round_off_of_height(int alpha, const algebra::MultiVector& u) const;

  static constexpr double smallest_digit = 1e-6;  ///< that is judged: what acts is at least round-off by this

 private:
  void bound_by_gap(const Rest& rest, std::array<double, 2>& force) const;
  double yields(int alpha) const { return count_ == 1 ? 1 : theta_[1 - alpha]; }  ///< z gains so much of what acts on u_alpha
  algebra::Vector force_on_closed_gap(const MembraneOperator& membranes, double reach) const;
  double carried(int alpha, const std::array<double, 2>& heights) const;

  int count_;
  contact::Weights weights_;
  std::array<double, 2> height_ = {0, 0}, size_ = {0, 0};
  std::array<double, 2> theta_ = {1, 0};  ///< that of the operator; m = 1: (1, 0)
  double reference_ = 0, on_gap_ = 0;
  Teuchos::RCP<algebra::Vector> diagonal_[2];
  Teuchos::RCP<const algebra::Vector> stiffness_;
};

}  // namespace thixis::membranes
