#include <gtest/gtest.h>

#include "systems.hpp"

namespace thixis::algebra::testing {

namespace {

int iterations(const Row& row, int n, int fields, const Teuchos::RCP<const MultiVector>& xy, Distribution distribution,
               SolverKind kind = SolverKind::cg) {
  LinearParams p;
  p.solver = kind;
  p.preconditioner = PreconditionerKind::muelu;
  const MatrixPtr A = matrix(node_map(GlobalIndex(n) * n, fields, distribution), row);
  Solver solver(p);
  solver.set_matrix(A, fields, {xy, {}});
  const Vector b = right_hand_side(A->getRowMap());
  Vector x(A->getDomainMap());
  LinearStop stop;
  stop.tolerance = 1e-10 * norm2(b);
  const LinearReport report = solver.solve(b, x, stop);

  EXPECT_TRUE(report.converged) << report.reason;
  EXPECT_LE(true_residual(*A, b, x), stop.tolerance);
  ::testing::Test::RecordProperty("iterations_" + std::to_string(n), report.iterations);
  return report.iterations;
}

}  // namespace

TEST(Multigrid, needs_about_the_same_number_of_iterations_on_all_meshes) {
  for (const int n : {64, 128, 256}) EXPECT_LE(iterations(poisson(n), n, 1, coordinates(n), Distribution::even), 15) << n;
}
TEST(Multigrid, copes_with_decoupled_rows_of_any_size_on_a_contact_patch) {
  for (const double scale : {1., 1e-4, 1e4})
    for (const int n : {64, 128, 256})
      EXPECT_LE(iterations(reduced_membranes(n, scale), n, 2, coordinates(n), Distribution::even), 16) << n << " " << scale;
}
TEST(Multigrid, needs_no_coordinates) { EXPECT_LE(iterations(reduced_membranes(128, 1), 128, 2, Teuchos::null, Distribution::even), 16); }
TEST(Multigrid, copes_with_a_rank_without_rows) {
  const auto empty = Distribution::last_rank_empty;
  EXPECT_LE(iterations(reduced_membranes(128, 1), 128, 2, coordinates(128, empty), empty), 16);
  EXPECT_LE(iterations(reduced_membranes(128, 1), 128, 2, Teuchos::null, empty), 16);
}
TEST(Multigrid, solves_small_systems_at_once) {
  EXPECT_LE(iterations(reduced_membranes(2, 1), 2, 2, coordinates(2), Distribution::even), 1);
  EXPECT_LE(iterations(reduced_membranes(10, 1), 10, 2, coordinates(10), Distribution::even, SolverKind::gmres), 1);
}
TEST(Multigrid, solves_a_large_diagonal_matrix_at_once) {
  const Row diagonal = [](GlobalIndex i, auto& columns, auto& values) { columns = {i}, values = {1. + static_cast<double>(i % 5)}; };
  EXPECT_LE(iterations(diagonal, 64, 1, coordinates(64), Distribution::even), 1);
}
TEST(Multigrid, takes_zeros_in_the_pattern_for_no_coupling) {
  const int n = 64;
  const Row row = reduced_membranes(n, 100);
  const Row with_zeros = [&](GlobalIndex i, auto& columns, auto& values) {
    row(i, columns, values);
    if (columns.size() > 1) return;
    for (GlobalIndex j = std::max<GlobalIndex>(0, i - 2); j <= std::min<GlobalIndex>(2 * n * n - 1, i + 2); ++j)
      if (j != i) columns.push_back(j), values.push_back(0);
  };
  EXPECT_EQ(iterations(with_zeros, n, 2, coordinates(n), Distribution::even), iterations(row, n, 2, coordinates(n), Distribution::even));
}

}  // namespace thixis::algebra::testing
