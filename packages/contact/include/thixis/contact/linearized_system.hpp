#pragma once
#include <memory>

#include "thixis/algebra/solver.hpp"
#include "thixis/contact/system.hpp"
#include "thixis/contact/weights.hpp"

namespace thixis::contact {

/// One form of the linear system of a Newton step,
///
///     [ S  -B D ] [ du      ]       [ R ]
///     [ a Bᵀ  b ] [ dlambda ]  =  - [ C ],
///
/// a, b, C one number for each gap of each contact point. X and R in columns.
class LinearizedSystem {
 public:
  virtual ~LinearizedSystem() = default;
  virtual void linearize(const algebra::Vector& a, const algebra::Vector& b) = 0;
  virtual algebra::LinearReport solve(const algebra::Vector& R, algebra::Vector& dX, const algebra::LinearStop& stop) = 0;
  /// R_shown <- E(X + dX) - F in the rows of the fields, 0 else, for the dX that the criterion of `solve` is being shown; R: what `solve`
  /// was given. Costs no product with a matrix. False: this form does not know it.
  virtual bool residual_of_shown(const algebra::Vector& /*R*/, algebra::Vector& /*R_shown*/) const { return false; }
  /// The values of the operator's matrices have changed; its loads may change at any time.
  virtual void renew() {}
  virtual GlobalIndex nonzeros() const = 0;
};

/// All fields and multipliers, interlaced with the multipliers last in the node: that order lets incomplete factorizations pass the zero
/// diagonal of the contact rows. The rows have the weights, so that the solver sees the norm that it is judged by. The system and the
/// weights must outlive it. Collective.
std::unique_ptr<LinearizedSystem> make_full_system(const System& system, const Weights& weights, const algebra::LinearParams& params,
                                                   const algebra::Nodes& nodes);

/// In the coordinates of the frames: gaps in contact are known, multipliers of free ones are eliminated, and coordinates that do not act on
/// each other are solved for one after the other; condensed where the operator is to be. `room`: a column for each field, whose values are
/// lost in every call. Collective.
std::unique_ptr<LinearizedSystem> make_reduced_system(const System& system, const Weights& weights, const algebra::LinearParams& params,
                                                      const algebra::Nodes& nodes, const Teuchos::RCP<algebra::MultiVector>& room);

}  // namespace thixis::contact
