#pragma once
#include <vector>

#include "constrained_solver.hpp"

namespace thixis::contact {

/// Coordinates that act on each other, directly or through others: parts that are solved one after the other. Blocks that are nothing but
/// rounding do not count.
std::vector<Part> independent_parts(const System& system);

/// One of them, with its solver and its vectors. A coordinate that stands alone has its column for a vector; several are interlaced.
class Piece {
 public:
  Piece(const System& system, const Part& part, std::unique_ptr<ConstrainedSolver> solver, algebra::MultiVector& rhs,
        algebra::MultiVector& dy);

  Part part;
  std::unique_ptr<ConstrainedSolver> solver;
  Teuchos::RCP<algebra::Vector> rhs, y;
  bool has_gaps;
  bool ready = false;   ///< the matrix is that of the operator
  double weight = 1;    ///< of a residual of this system
  double residual = 0;  ///< the last known one, weighted

  /// Unknowns out of columns of coordinates: right-hand sides are multiplied by the stretch, unknowns divided.
  void take(const algebra::MultiVector& all_rhs, const algebra::MultiVector& dy) const;
  /// Its columns of dy <- of_piece, a vector like y.
  void put(const algebra::Vector& of_piece, algebra::MultiVector& dy) const;

 private:
  void take(const algebra::MultiVector& columns, algebra::Vector& out, bool right_side) const;
};

}  // namespace thixis::contact
