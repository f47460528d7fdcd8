#pragma once
#include <memory>

#include "thixis/algebra/solver.hpp"
#include "transformed.hpp"

namespace thixis::contact {

/// (Tᵀ S T + diag(penalty)) y = rhs for the unknowns of a part, rows and columns of gaps in contact cleared but for the diagonal. Vectors
/// are on algebra::interlaced(map, part.size).
class ConstrainedSolver {
 public:
  virtual ~ConstrainedSolver() = default;
  /// contact: 1 or 0; penalty: 0 at contact, of gaps that are not stretched. On the map of the fields, a column for each gap. `part`: with
  /// the coordinates of the part that the solver was made for. Collective.
  virtual void set_matrix(const Part& part, const algebra::MultiVector& contact, const algebra::MultiVector& penalty) = 0;
  /// Starts from y. `stop.criterion` sees all of y.
  virtual algebra::LinearReport solve(const algebra::Vector& rhs, algebra::Vector& y, const algebra::LinearStop& stop) const = 0;
  /// The residual that `solve` starts from; puts into y what is eliminated.
  virtual double residual(const algebra::Vector& rhs, algebra::Vector& y) const = 0;
  virtual GlobalIndex nonzeros() const = 0;
};

/// The assembled matrix, or its Schur complement where cells are to be condensed. The system must outlive it. Collective.
std::unique_ptr<ConstrainedSolver> make_constrained_solver(const System& system, const Part& part, const algebra::LinearParams& params,
                                                           const algebra::Nodes& nodes);
std::unique_ptr<ConstrainedSolver> make_condensed_solver(const System& system, const Part& part, const algebra::LinearParams& params,
                                                         const algebra::Nodes& nodes);

/// Values at the rows and ghosts of the matrices. Collective.
void to_columns(const System& system, const algebra::MultiVector& at_rows, algebra::MultiVector& at_columns);
algebra::MultiVector at_columns(const System& system, const algebra::MultiVector& at_rows);

}  // namespace thixis::contact
