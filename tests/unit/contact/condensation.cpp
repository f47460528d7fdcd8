#include "thixis/contact/condensation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <set>
#include <vector>

#include "thixis/algebra/solver.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"

namespace thixis::contact {
namespace {

using method::make_graph;
using method::scatter;
using Block = Kokkos::View<double***, Kokkos::LayoutRight>;

/// In [-1, 1], the same on every number of ranks.
double random(std::uint64_t seed) {
  seed += 0x9e3779b97f4a7c15;
  seed = (seed ^ (seed >> 30)) * 0xbf58476d1ce4e5b9;
  seed = (seed ^ (seed >> 27)) * 0x94d049bb133111eb;
  seed ^= seed >> 31;
  return 2 * static_cast<double>(seed >> 11) / 9007199254740992.0 - 1;
}

/// A strip of elements: element e has `interior` unknowns of its own and shares those of the nodes e, e+1 and e+2, with some fields each.
/// Each rank owns a run of nodes and the elements that begin there, and sees every element that touches a row of it. Interior and nodal
/// unknowns are numbered alternately.
struct Strip {
  const core::Comm comm;
  int fields, inside, width;
  std::vector<GlobalIndex> elements;  ///< on this rank
  algebra::MapPtr rows, columns;
  Kokkos::View<LocalIndex**, Kokkos::LayoutRight> unknowns;

  /// `fixed`: ids of unknowns that are none.
  Strip(GlobalIndex nodes, int fields_per_node, int interior_per_field, const std::set<GlobalIndex>& fixed)
      : fields(fields_per_node), inside(fields * interior_per_field), width(inside + 3 * fields) {
    const GlobalIndex first = nodes * comm.rank() / comm.size(), last = nodes * (comm.rank() + 1) / comm.size();
    std::set<GlobalIndex> seen;
    for (GlobalIndex e = 0; e + 2 < nodes; ++e) {
      if (e + 2 < first || e >= last) continue;
      elements.push_back(e);
      for (int i = 0; i < width; ++i) seen.insert(id(e, i));
    }
    std::vector<GlobalIndex> own, ghosts;
    for (const GlobalIndex unknown : seen) {
      const GlobalIndex node = unknown / (fields + inside);
      if (fixed.count(unknown) == 0) (node >= first && node < last ? own : ghosts).push_back(unknown);
    }
    rows = algebra::map_of(own, comm);
    own.insert(own.end(), ghosts.begin(), ghosts.end());
    columns = algebra::map_of(own, comm);
    unknowns = Kokkos::View<LocalIndex**, Kokkos::LayoutRight>("unknowns", elements.size(), width);
    const auto host = Kokkos::create_mirror_view(unknowns);
    for (std::size_t k = 0; k < elements.size(); ++k)
      for (int i = 0; i < width; ++i) host(k, i) = fixed.count(id(elements[k], i)) > 0 ? -1 : columns->getLocalElement(id(elements[k], i));
    Kokkos::deep_copy(unknowns, host);
  }

  /// Of the i-th unknown of element e; fields are interlaced.
  GlobalIndex id(GlobalIndex e, int i) const {
    const GlobalIndex stride = fields + inside;
    return i < inside ? e * stride + fields + i : (e + (i - inside) / fields) * stride + (i - inside) % fields;
  }

  Condensation condensation(LocalForm form) const { return Condensation(rows, columns, unknowns, inside, form); }

  /// One local matrix after the other.
  template <class Entry>
  FillLocalMatrices local(Entry entry) const {
    return [this, entry](LocalIndex first, const Block& A) {
      const auto host = Kokkos::create_mirror_view(A);
      for (int k = 0; k < host.extent_int(0); ++k)
        for (int i = 0; i < width; ++i)
          for (int j = 0; j < width; ++j) host(k, i, j) = entry(elements[first + k], i, j);
      Kokkos::deep_copy(A, host);
    };
  }

  algebra::MatrixPtr assemble(const FillLocalMatrices& local) const {
    const auto A = Teuchos::rcp(new algebra::Matrix(make_graph(rows, columns, unknowns)));
    A->fillComplete();
    const Block all("local", elements.size(), width, width);
    local(0, all);
    scatter(unknowns, 0, all, *A);
    return A;
  }

  algebra::Vector right_side() const {
    algebra::Vector b(rows);
    const auto values = algebra::host_overwrite(b);
    for (std::size_t row = 0; row < values.extent(0); ++row)
      values(row) = random(777 + rows->getGlobalElement(static_cast<LocalIndex>(row)));
    return b;
  }
};

/// Symmetric, with a dominant diagonal.
struct Definite {
  int seed = 1;
  double operator()(GlobalIndex e, int i, int j) const {
    const auto low = std::min(i, j), high = std::max(i, j);
    return random(((e * 64 + low) * 64 + high) * 64 + seed) + (i == j ? 40 : 0);
  }
};

/// Dominant entries beside the diagonal in the interior block, whose diagonal is 0: no elimination without row exchanges.
struct Exchanged {
  int inside;
  double operator()(GlobalIndex e, int i, int j) const {
    if (i < inside && i == j) return 0;
    const bool dominant = i < inside ? j == (i + 1) % inside : i == j;
    return random((e * 64 + i) * 64 + j) + (dominant ? 40 : 0);
  }
};

algebra::Vector solve(const algebra::MatrixPtr& A, const algebra::Vector& b) {
  algebra::LinearParams params;
  params.solver = algebra::SolverKind::direct;
  algebra::Solver solver(params);
  solver.set_matrix(A, 1);
  algebra::Vector x(b.getMap());
  EXPECT_TRUE(solver.solve(b, x, {}).converged);
  return x;
}

algebra::Vector solve_condensed(const Condensation& condensation, const algebra::Vector& b) {
  algebra::Vector b_condensed(condensation.rows()), x(b.getMap());
  condensation.reduce(b, b_condensed);
  x.putScalar(std::nan(""));
  condensation.recover(b, solve(condensation.matrix(), b_condensed), x);
  return x;
}

double distance(const algebra::Vector& x, const algebra::Vector& y) {
  algebra::Vector difference(x, Teuchos::Copy);
  difference.update(-1, y, 1);
  return difference.normInf();
}

template <class Entry>
void expect_same_solution(const Strip& strip, LocalForm form, Entry entry) {
  const auto local = strip.local(entry);
  Condensation condensation = strip.condensation(form);
  condensation.set_matrix(local);
  const algebra::Vector b = strip.right_side(), x = solve(strip.assemble(local), b);
  EXPECT_LE(distance(solve_condensed(condensation, b), x), 1e-12 * x.normInf());
}

int allocations = 0;
int count_allocations(const std::function<void()>& action) {
  allocations = 0;
  Kokkos::Tools::Experimental::set_allocate_data_callback(
      [](Kokkos::Profiling::SpaceHandle, const char*, const void*, std::uint64_t) { ++allocations; });
  action();
  Kokkos::Tools::Experimental::set_allocate_data_callback(nullptr);
  return allocations;
}

}  // namespace

TEST(Condensation, solves_a_definite_problem_as_without) {
  for (const int interior : {1, 3, 6, 15}) {
    expect_same_solution(Strip(40, 1, interior, {}), LocalForm::positive_definite, Definite{});
    expect_same_solution(Strip(40, 1, interior, {}), LocalForm::general, Definite{});
  }
}

TEST(Condensation, solves_a_nonsymmetric_problem_that_needs_pivoting_as_without) {
  for (const int interior : {2, 3, 6, 15}) expect_same_solution(Strip(40, 1, interior, {}), LocalForm::general, Exchanged{interior});
}

TEST(Condensation, solves_for_two_interlaced_fields) {
  expect_same_solution(Strip(40, 2, 3, {}), LocalForm::positive_definite, Definite{});
  expect_same_solution(Strip(40, 2, 3, {}), LocalForm::general, Exchanged{6});
}

TEST(Condensation, keeps_fixed_unknowns_out_wherever_they_are) {
  const Strip whole(40, 2, 2, {});
  std::set<GlobalIndex> fixed;
  for (const GlobalIndex e : {0, 13, 14, 26, 37})
    for (const int i : {0, 3, 4, 5, 7}) fixed.insert(whole.id(e, i));
  for (int i = 0; i < 4; ++i) fixed.insert(whole.id(20, i));
  const Strip strip(40, 2, 2, fixed);
  expect_same_solution(strip, LocalForm::positive_definite, Definite{});
  expect_same_solution(strip, LocalForm::general, Definite{});
}

TEST(Condensation, does_nothing_to_elements_without_interior_unknowns) {
  const Strip strip(20, 2, 0, {});
  expect_same_solution(strip, LocalForm::general, Definite{});
  EXPECT_EQ(strip.condensation(LocalForm::general).rows()->getGlobalNumElements(), strip.rows->getGlobalNumElements());
}

TEST(Condensation, numbers_what_remains_in_the_order_of_the_rows) {
  const Strip strip(40, 2, 3, {});
  const Condensation condensation = strip.condensation(LocalForm::general);
  EXPECT_EQ(condensation.rows()->getGlobalNumElements(), 80u);
  const auto original = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), condensation.original_row());
  const auto condensed = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), condensation.condensed_column());
  const auto column_map = condensation.graph()->getColMap();
  ASSERT_EQ(condensed.extent_int(0), algebra::local_size(*strip.columns));
  for (int column = 0; column < condensed.extent_int(0); ++column) {
    const GlobalIndex id = strip.columns->getGlobalElement(column);
    if (id % 8 >= 2) {
      EXPECT_EQ(condensed(column), -1);
    } else {
      EXPECT_EQ(column_map->getGlobalElement(condensed(column)), 2 * (id / 8) + id % 8);
    }
  }
  for (int row = 0; row < original.extent_int(0); ++row) EXPECT_EQ(condensed(original(row)), row);
}

TEST(Condensation, takes_new_values_as_a_fresh_object_does) {
  const Strip strip(40, 2, 3, {});
  Condensation used = strip.condensation(LocalForm::positive_definite), fresh = strip.condensation(LocalForm::positive_definite);
  const auto matrix = used.matrix();
  used.set_matrix(strip.local(Definite{1}));
  used.set_matrix(strip.local(Definite{2}));
  fresh.set_matrix(strip.local(Definite{2}));
  EXPECT_EQ(used.matrix().get(), matrix.get());
  const algebra::Vector b = strip.right_side();
  EXPECT_EQ(distance(solve_condensed(used, b), solve_condensed(fresh, b)), 0);
}

TEST(Condensation, reads_only_one_triangle_of_a_definite_matrix) {
  const Strip strip(40, 1, 6, {});
  Condensation whole = strip.condensation(LocalForm::positive_definite), half = strip.condensation(LocalForm::positive_definite);
  whole.set_matrix(strip.local(Definite{}));
  half.set_matrix(strip.local([](GlobalIndex e, int i, int j) { return i <= j ? Definite{}(e, i, j) : std::nan(""); }));
  const algebra::Vector b = strip.right_side();
  EXPECT_EQ(distance(solve_condensed(whole, b), solve_condensed(half, b)), 0);
}

TEST(Condensation, refuses_interior_blocks_without_inverse_on_all_ranks) {
  const Strip strip(40, 1, 3, {});
  // the sums of the rows vanish but for rounding
  static constexpr double laplacian[3][3] = {{0.1 + 0.2, -0.1, -0.2}, {-0.1, 0.1 + 0.7, -0.7}, {-0.2, -0.7, 0.2 + 0.7}};
  const auto singular = [](GlobalIndex e, int i, int j) { return e == 7 && i < 3 && j < 3 ? laplacian[i][j] : Definite{}(e, i, j); };
  const auto indefinite = [](GlobalIndex e, int i, int j) { return Definite{}(e, i, j) - (e == 7 && i == 1 && j == 1 ? 80 : 0); };
  const auto nothing = [](GlobalIndex e, int i, int j) { return e == 7 ? 0 : Definite{}(e, i, j); };
  const auto undefined = [](GlobalIndex e, int i, int j) { return e == 7 ? std::nan("") : Definite{}(e, i, j); };
  for (const LocalForm form : {LocalForm::general, LocalForm::positive_definite}) {
    Condensation condensation = strip.condensation(form);
    EXPECT_THROW(condensation.set_matrix(strip.local(singular)), core::Error);
    EXPECT_THROW(condensation.set_matrix(strip.local(nothing)), core::Error);
    EXPECT_THROW(condensation.set_matrix(strip.local(undefined)), core::Error);
  }
  Condensation general = strip.condensation(LocalForm::general), definite = strip.condensation(LocalForm::positive_definite);
  EXPECT_NO_THROW(general.set_matrix(strip.local(indefinite)));
  EXPECT_THROW(definite.set_matrix(strip.local(indefinite)), core::Error);
}

TEST(Condensation, takes_any_units) {
  const Strip strip(40, 1, 3, {});
  for (const double unit : {1e-30, 1e30}) {
    // the first interior unknown of each element and its equation
    const auto scaled = [unit](GlobalIndex e, int i, int j) { return Definite{}(e, i, j) * (i == 0 ? unit : 1) * (j == 0 ? unit : 1); };
    const auto row_scaled = [unit](GlobalIndex e, int i, int j) { return Definite{}(e, i, j) * (i == 0 ? unit : 1); };
    Condensation definite = strip.condensation(LocalForm::positive_definite), general = strip.condensation(LocalForm::general);
    EXPECT_NO_THROW(definite.set_matrix(strip.local(scaled)));
    EXPECT_NO_THROW(general.set_matrix(strip.local(scaled)));
    EXPECT_NO_THROW(general.set_matrix(strip.local(row_scaled)));
  }
}

TEST(Condensation, allocates_nothing_per_element) {
  int counted[2];
  for (const int refined : {0, 1}) {
    const Strip strip(refined ? 8000 : 1000, 2, 6, {});
    Condensation condensation = strip.condensation(LocalForm::positive_definite);
    const FillLocalMatrices local = [](LocalIndex, const Block& A) {
      for (int e = 0; e < A.extent_int(0); ++e)
        for (int i = 0; i < A.extent_int(1); ++i)
          for (int j = 0; j < A.extent_int(2); ++j) A(e, i, j) = i == j ? 2 : 0;
    };
    condensation.set_matrix(local);
    counted[refined] = count_allocations([&] { condensation.set_matrix(local); });
  }
  EXPECT_EQ(counted[0], counted[1]);
}

}  // namespace thixis::contact
