#pragma once
#include <memory>

#include "membrane_operator.hpp"
#include "thixis/algebra/solver.hpp"

namespace thixis::models {

/// B: blocks of one or two interlaced fields, block (i, j) = sum over alpha of c[i][j][alpha] matrix_alpha.
struct Blocks {
  int fields;
  double c[2][2][2];
  /// B is matrix_1 itself.
  bool plain() const { return fields == 1 && c[0][0][0] == 1 && c[0][0][1] == 0; }
};

/// (B + diag(penalty)) x = rhs, rows and columns of contact points cleared but for the diagonal; both concern the last field. Vectors are
/// on algebra::interlaced(map, fields).
class ConstrainedSolver {
 public:
  virtual ~ConstrainedSolver() = default;
  /// contact: 1 or 0; penalty: 0 at contact. On the operator's map(). Collective.
  virtual void set_matrix(const algebra::Vector& contact, const algebra::Vector& penalty) = 0;
  /// B itself. Collective.
  virtual void set_matrix() = 0;
  /// Starts from x. `stop.criterion` sees all of x.
  virtual algebra::LinearReport solve(const algebra::Vector& rhs, algebra::Vector& x, const algebra::LinearStop& stop) const = 0;
  /// The residual that `solve` starts from; puts into x what is eliminated.
  virtual double residual(const algebra::Vector& rhs, algebra::Vector& x) const = 0;
  virtual GlobalIndex nonzeros() const = 0;
};

/// The assembled matrix, or its Schur complement where the operator is to be condensed. The operator must outlive it. Collective.
std::unique_ptr<ConstrainedSolver> make_constrained_solver(const MembraneOperator& membranes, const Blocks& blocks,
                                                           const algebra::LinearParams& params,
                                                           const Teuchos::RCP<const algebra::MultiVector>& coordinates);

/// Values at the rows and ghosts of the operator's matrices. Collective.
algebra::Vector at_columns(const MembraneOperator& membranes, const algebra::Vector& at_rows);

}  // namespace thixis::models
