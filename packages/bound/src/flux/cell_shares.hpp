#pragma once
#include "thixis/algebra/fwd.hpp"
#include "thixis/bound/cell_fields.hpp"
#include "thixis/method/space.hpp"

namespace thixis::bound {

bool vanishes(const algebra::Vector& v);

/// Functionals R on the space, shared out to the patch cells (Space::share), and the polynomial r in every cell that has these
/// moments, (r, psi_l)_K = moments(k, l), projected on P_q.
class CellShares {
 public:
  /// The space must outlive it.
  CellShares(const method::Space& space, int q);
  /// (patch cell, l): what the cells get of R, valid until the next call. Collective.
  const CellTable& operator()(const algebra::Vector& R) const;
  /// Densities r(k, ·) of the moments that operator() gave, with what has been done to them since; overwritten.
  void represent(const CellTable& r) const;
  /// Of the same size as the moments: (patch cell, dim P_q).
  CellTable make_density(const char* label) const { return CellTable(std::string(label), moments_.extent(0), n_); }
  std::size_t bytes() const { return sizeof(double) * moments_.size(); }

 private:
  const method::Space& space_;
  int n_;  ///< dim P_q
  CellTable moments_;
  Matrix from_moments_;  ///< (mode, l)
};

}  // namespace thixis::bound
