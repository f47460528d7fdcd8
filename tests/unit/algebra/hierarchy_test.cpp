#include <gtest/gtest.h>

#include <map>

#include "systems.hpp"
#include "thixis/algebra/structure.hpp"

namespace thixis::algebra::testing {

namespace {

/// Bilinear functions on the grid of (n - 1)/2 in those of the grid of n.
MatrixPtr bilinear(int n, Distribution distribution) {
  const int half = (n - 1) / 2;
  const MapPtr fine = node_map(GlobalIndex(n) * n, 1, distribution), coarse = node_map(GlobalIndex(half) * half, 1, distribution);
  std::vector<std::map<GlobalIndex, double>> rows(local_size(*fine));
  std::vector<GlobalIndex> columns, others;
  for (LocalIndex l = 0; l < local_size(*coarse); ++l) columns.push_back(coarse->getGlobalElement(l));
  for (LocalIndex r = 0; r < local_size(*fine); ++r) {
    const int i = static_cast<int>(fine->getGlobalElement(r) % n) + 1, j = static_cast<int>(fine->getGlobalElement(r) / n) + 1;
    for (const int I : {i / 2, (i + 1) / 2})
      for (const int J : {j / 2, (j + 1) / 2}) {
        if (I < 1 || I > half || J < 1 || J > half) continue;
        const GlobalIndex id = GlobalIndex(J - 1) * half + I - 1;
        rows[r][id] += 0.25;
        if (!coarse->isNodeGlobalElement(id)) others.push_back(id);
      }
  }
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  columns.insert(columns.end(), others.begin(), others.end());
  const MapPtr column_map = map_of(columns, core::Comm());
  const MatrixPtr P = Teuchos::rcp(new Matrix(fine, column_map, 4));
  for (LocalIndex r = 0; r < local_size(*fine); ++r)
    for (const auto& [id, weight] : rows[r]) {
      const LocalIndex column = column_map->getLocalElement(id);
      P->insertLocalValues(r, 1, &weight, &column);
    }
  P->fillComplete(coarse, fine);
  return P;
}

Nodes grids(int n, Distribution distribution = Distribution::even) {
  Nodes nodes;
  for (; n > 3; n = (n - 1) / 2) nodes.below.push_back(bilinear(n, distribution));
  return nodes;
}

/// The Laplacian, 1 on the diagonal of rows that are held and nothing in their columns; each of `fields` unknowns of a node.
Row held(int n, const std::function<bool(double x, double y)>& hold, int fields = 1, double scale = 1) {
  const auto is_held = [=](GlobalIndex node) { return hold((node % n + 1.) / (n + 1), (node / n + 1.) / (n + 1)); };
  return [=, row = poisson(n)](GlobalIndex id, auto& columns, auto& values) {
    std::vector<GlobalIndex> all;
    std::vector<double> numbers;
    row(id / fields, all, numbers);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const bool diagonal = all[k] == id / fields, here = is_held(id / fields);
      columns.push_back(fields * all[k] + id % fields);
      values.push_back(diagonal ? (here ? scale : numbers[k]) : here || is_held(all[k]) ? 0 : numbers[k]);
    }
  };
}

bool nowhere(double, double) { return false; }
bool disk(double x, double y) { return std::hypot(x - 0.4, y - 0.5) < 0.3; }
bool speckled(double x, double y) { return std::sin(61 * x + 3) * std::sin(83 * y) > 0.3; }
bool all_but_a_line(double x, double) { return std::abs(x - 0.5) > 0.02; }
bool everywhere(double, double) { return true; }

LinearParams cycles() {
  LinearParams params;
  params.solver = SolverKind::cg;
  params.preconditioner = PreconditionerKind::multigrid;
  return params;
}

int iterations(const Solver& solver, const Matrix& A) {
  const Vector b = right_hand_side(A.getRowMap());
  Vector x(A.getDomainMap());
  LinearStop stop;
  stop.tolerance = 1e-10 * norm2(b);
  const LinearReport report = solver.solve(b, x, stop);
  EXPECT_TRUE(report.converged) << report.reason;
  EXPECT_LE(true_residual(A, b, x), 1.01 * stop.tolerance);
  return report.iterations;
}

int iterations(const Row& row, int n, int fields = 1, Distribution distribution = Distribution::even) {
  const MatrixPtr A = matrix(node_map(GlobalIndex(n) * n, fields, distribution), row);
  Solver solver(cycles());
  solver.set_matrix(A, fields, grids(n, distribution));
  return iterations(solver, *A);
}

}  // namespace

TEST(Hierarchy, needs_the_same_iterations_on_all_meshes) {
  for (const int n : {15, 31, 63, 127}) EXPECT_LE(iterations(poisson(n), n), 13) << n;
}
TEST(Hierarchy, needs_about_as_many_whatever_is_in_contact) {
  for (const int n : {31, 63, 127})
    for (const auto& [hold, most] :
         {std::pair(&disk, 15), std::pair(&speckled, 20), std::pair(&all_but_a_line, 12), std::pair(&nowhere, 13)})
      for (const double scale : {1., 1e6}) EXPECT_LE(iterations(held(n, hold, 1, scale), n), most) << n;
  EXPECT_EQ(iterations(held(31, everywhere), 31), 1);
}
TEST(Hierarchy, takes_several_unknowns_of_a_node) {
  EXPECT_NEAR(iterations(held(63, disk, 3), 63, 3), iterations(held(63, disk), 63), 1);  // right-hand sides differ
}
TEST(Hierarchy, copes_with_a_rank_without_rows) { EXPECT_LE(iterations(held(63, disk), 63, 1, Distribution::last_rank_empty), 16); }

/// A cycle is one and the same whatever the matrix was before, and its patterns are found once.
TEST(Hierarchy, follows_the_contact_set_without_symbolic_work) {
  const int n = 63;
  const Nodes nodes = grids(n);
  const MapPtr map = node_map(GlobalIndex(n) * n, 1);
  const MatrixPtr A = matrix(map, held(n, nowhere));
  Solver solver(cycles());
  for (const auto hold : {&nowhere, &disk, &speckled, &everywhere, &disk}) {
    const MatrixPtr now = matrix(map, held(n, hold));
    Kokkos::deep_copy(A->getLocalMatrixDevice().values, now->getLocalMatrixDevice().values);
    solver.set_matrix(A, 1, nodes);
    Solver fresh(cycles());
    fresh.set_matrix(now, 1, nodes);
    EXPECT_EQ(iterations(solver, *A), iterations(fresh, *now));
  }
  EXPECT_EQ(solver.symbolic_setups(), 1);
}

TEST(Hierarchy, is_symmetric_so_that_cg_is_as_good_as_gmres) {
  const int n = 63;
  LinearParams by_gmres = cycles();
  by_gmres.solver = SolverKind::gmres;
  const MatrixPtr A = matrix(node_map(GlobalIndex(n) * n, 1), held(n, disk));
  Solver cg(cycles()), gmres(by_gmres);
  cg.set_matrix(A, 1, grids(n));
  gmres.set_matrix(A, 1, grids(n));
  EXPECT_LE(std::abs(iterations(cg, *A) - iterations(gmres, *A)), 2);
}

TEST(Hierarchy, is_the_matrix_of_muelu_where_nothing_is_below) {
  const int n = 64;
  LinearParams muelu = cycles();
  muelu.preconditioner = PreconditionerKind::muelu;
  const MatrixPtr A = matrix(node_map(GlobalIndex(n) * n, 1), poisson(n));
  Solver alone(cycles()), by_muelu(muelu);
  alone.set_matrix(A, 1, {coordinates(n), {}});
  by_muelu.set_matrix(A, 1, {coordinates(n), {}});
  EXPECT_EQ(iterations(alone, *A), iterations(by_muelu, *A));
}

TEST(Structure, interlaces_and_selects) {
  const MatrixPtr P = bilinear(15, Distribution::even);
  const auto three = interlaced(Teuchos::rcp_implicit_cast<const Matrix>(P), 3);
  Vector x(P->getDomainMap()), y(P->getRangeMap()), X(three->getDomainMap()), Y(three->getRangeMap());
  {
    const auto one = host_overwrite(x), all = host_overwrite(X);
    for (std::size_t l = 0; l < one.extent(0); ++l) {
      one(l) = std::sin(static_cast<double>(P->getDomainMap()->getGlobalElement(static_cast<LocalIndex>(l))));
      for (int f = 0; f < 3; ++f) all(3 * l + f) = (1 << f) * one(l);
    }
  }
  P->apply(x, y);
  three->apply(X, Y);
  const auto one = host_view(std::as_const(y)), all = host_view(std::as_const(Y));
  for (std::size_t l = 0; l < one.extent(0); ++l)
    for (int f = 0; f < 3; ++f) EXPECT_EQ(all(3 * l + f), (1 << f) * one(l));

  const LocalIndex half = local_rows(*P) / 2;
  const Kokkos::View<LocalIndex*> odd("odd", half);
  for (LocalIndex k = 0; k < half; ++k) odd(k) = 2 * k + 1;
  const MatrixPtr part = select_rows(*P, contiguous_map(half, core::Comm()), odd);
  Vector z(part->getRangeMap());
  part->apply(x, z);
  const auto selected = host_view(std::as_const(z));
  for (LocalIndex k = 0; k < half; ++k) EXPECT_EQ(selected(k), one(2 * k + 1));
}

}  // namespace thixis::algebra::testing
