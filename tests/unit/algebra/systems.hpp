#pragma once
#include <functional>
#include <vector>

#include "thixis/algebra/solver.hpp"
#include "thixis/algebra/tpetra.hpp"

/// Linear systems on the n x n interior nodes of a square, node by node, for the tests of this package.
namespace thixis::algebra::testing {

/// Appends the entries of a row.
using Row = std::function<void(GlobalIndex row, std::vector<GlobalIndex>& columns, std::vector<double>& values)>;

enum class Distribution { even, last_rank_empty };
/// Whole nodes with so many unknowns each, on the ranks of MPI_COMM_WORLD.
MapPtr node_map(GlobalIndex nodes, int fields, Distribution distribution = Distribution::even);
MatrixPtr matrix(const MapPtr& map, const Row& row);

/// Five-point Laplacian, 4 on the diagonal.
Row poisson(int n);
/// The same with natural boundary conditions: singular, constants are its kernel.
Row neumann(int n);
/// Two membranes, unknowns u1, u2, lambda: L u1 - lambda, L u2 + lambda, and u1 - u2 in contact (a zero on the diagonal), lambda elsewhere.
Row membranes(int n);
/// The same after elimination, unknowns u1, u2: without contact both rows are L; in contact the first row is the sum of both operators,
/// the second only `scale` on the diagonal.
Row reduced_membranes(int n, double scale);

/// x and y of the nodes.
Teuchos::RCP<const MultiVector> coordinates(int n, Distribution distribution = Distribution::even);
/// Smooth and rough parts, nothing symmetric.
Vector right_hand_side(const MapPtr& map);
double true_residual(const Matrix& A, const Vector& b, const Vector& x);
/// |x - y| / |y|
double difference(const Vector& x, const Vector& y);

}  // namespace thixis::algebra::testing
