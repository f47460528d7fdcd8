#pragma once
#include "transformed.hpp"

namespace thixis::contact {

/// The gaps in the linear system of a Newton step, in the coordinates of the frames:
///
///     (Tᵀ S T dy + Tᵀ R)_z - D dlambda = 0,     a dz + b dlambda = -C.
///
/// Where |D a| is far larger than |b S_zz|, dz = -C/a is known, and the first row says what dlambda is; elsewhere the second one does, and
/// D a/b is added to the diagonal.
class GapRows {
 public:
  explicit GapRows(const System& system);

  /// The diagonal of Tᵀ S T in these rows is new.
  void set_diagonal(const TransformedOperator& S) { S.diagonal(means_, diagonal_); }
  /// a, b: the derivatives of the C-function at each gap.
  void decide(const algebra::Vector& a, const algebra::Vector& b);
  const algebra::MultiVector& contact() const { return contact_; }  ///< 1 or 0, on the map of the fields
  const algebra::MultiVector& penalty() const { return penalty_; }  ///< D a/b of free gaps, else 0

  /// dy <- the known gaps, else 0.
  void set_known(const algebra::MultiVector& C, algebra::MultiVector& dy) const;
  /// rhs = Tᵀ S T dy <- -Tᵀ R - that, and - D C/b in the rows of free gaps; S_zz dz in those of known ones.
  void set_right_sides(const algebra::MultiVector& R, const algebra::MultiVector& C, const algebra::MultiVector& dy,
                       algebra::MultiVector& rhs) const;
  /// pushed: Tᵀ S T dy.
  void recover(const algebra::MultiVector& R, const algebra::MultiVector& C, const algebra::MultiVector& dy,
               const algebra::MultiVector& pushed, algebra::MultiVector& dlambda) const;

 private:
  const System& system_;
  int means_;
  algebra::MultiVector diagonal_, contact_, penalty_;
  algebra::MultiVector a_, b_;  ///< on the contact points
};

}  // namespace thixis::contact
