/// A look at an iterate of the reduced system: it allocates nothing after the first, and costs one product with each matrix of the
/// operator, with the residual at that iterate.
#include <gtest/gtest.h>

#include <cmath>

#include "setting.hpp"
#include "thixis/complementarity/newton.hpp"

namespace thixis::contact {
namespace {

/// Counts what is done with it.
class CountedMatrix : public algebra::Matrix {
 public:
  explicit CountedMatrix(const algebra::Matrix& S) : algebra::Matrix(S, Teuchos::Copy) {}
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, double alpha, double beta) const override {
    ++products;
    algebra::Matrix::apply(x, y, mode, alpha, beta);
  }
  static int products;
};
int CountedMatrix::products = 0;

/// Memory that Kokkos gave out. Flags and single numbers, which every handle of a vector and every norm brings along, do not count.
struct Memory {
  static constexpr std::uint64_t number = 64;  ///< bytes
  static long long given;
  static void count(Kokkos_Profiling_SpaceHandle, const char*, const void*, std::uint64_t bytes) { given += bytes > number; }

  Memory() {
    given = 0;
    Kokkos::Tools::Experimental::set_allocate_data_callback(count);
  }
  ~Memory() { Kokkos::Tools::Experimental::set_allocate_data_callback(nullptr); }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
};
long long Memory::given = 0;

System counted(System system) {
  for (auto& matrix : system.S.matrix) matrix = Teuchos::rcp(new CountedMatrix(*matrix));
  system.load->randomize();
  return system;
}

System membranes(const method::Space& space, bool condensed) {
  return counted({operators(space, {scene::constant(1), scene::constant(5)}, condensed),
                  constraint(space, 1, Frames({make_frame(2, 1, of_rows({{1}, {-1}}), {1, 5})})), zero_load(space, 2)});
}
System stack(const method::Space& space, bool condensed) {
  const auto tension = scene::formula([](double x, double y) { return 1 + x * (2 - y); });
  return counted({operators(space, {tension, scene::constant(2), scene::constant(7)}, condensed),
                  constraint(space, 2, Frames({make_frame(3, 2, of_rows({{1, 0}, {-1, 1}, {0, -1}}), {1.5, 2, 7})}), 1, 2),
                  zero_load(space, 3)});
}

struct Case {
  const char* name;
  System (*make)(const method::Space& space, bool condensed);
  bool condensed;
  algebra::SolverKind solver;
};
const Case all_cases[] = {{"membranes_gmres", membranes, false, algebra::SolverKind::gmres},
                          {"membranes_cg", membranes, false, algebra::SolverKind::cg},
                          {"membranes_condensed_gmres", membranes, true, algebra::SolverKind::gmres},
                          {"membranes_condensed_cg", membranes, true, algebra::SolverKind::cg},
                          {"stack_gmres", stack, false, algebra::SolverKind::gmres},
                          {"stack_condensed_gmres", stack, true, algebra::SolverKind::gmres}};

struct Cost {
  int looks = 0, iterations = 0, products = 0;
  long long memory = 0;
};

/// On one rank: on several, Tpetra makes its buffers of an exchange anew whenever the number of columns is another one.
void expect_no_more_memory(const Cost& first, const Cost& many, const Cost& few) {
  if (core::Comm().size() > 1) return;
  EXPECT_GT(first.memory, many.memory);
  EXPECT_EQ(many.memory, few.memory);
}

class Looks : public ::testing::TestWithParam<Case> {
 protected:
  Looks() {
    params_.form = algebra::SystemForm::reduced;
    params_.solver = GetParam().solver;
    params_.restart = 20;
  }
  std::shared_ptr<const System> make() const { return std::make_shared<System>(GetParam().make(square_.space(), GetParam().condensed)); }
  /// Every third point in contact.
  void linearize(Problem& problem, const Vector& X) const {
    Vector a(problem.points()), b(problem.points());
    problem.scaling(b);
    {
      const auto a_p = algebra::host_overwrite(a), b_p = algebra::host_view(b);
      for (std::size_t p = 0; p < a_p.extent(0); ++p) {
        a_p(p) = p % 3 == 0 ? 1 : 0;
        if (p % 3 == 0) b_p(p) = 0;
      }
    }
    problem.linearize(X, a, b);
  }
  Square square_{3, 2};
  algebra::LinearParams params_;
};

}  // namespace

TEST_P(Looks, at_increments_allocate_nothing_after_the_first_and_take_one_product) {
  const auto system = make();
  Problem problem(system, params_, square_.nodes());
  Vector X(problem.map()), R(problem.map()), dX(problem.map());
  X.randomize();
  R.randomize();
  linearize(problem, X);
  const auto solve = [&](int check_every) {
    Cost cost;
    algebra::LinearStop stop;
    stop.tolerance = 1e-6;
    stop.check_every = check_every;
    stop.criterion = [&](const Vector&, int, double) {
      ++cost.looks;
      return false;
    };
    CountedMatrix::products = 0;
    const Memory memory;
    const auto report = problem.solve(R, dX, stop);
    EXPECT_TRUE(report.converged) << report.reason;
    cost.iterations = report.iterations;
    cost.products = CountedMatrix::products;
    cost.memory = Memory::given;
    return cost;
  };
  const Cost first = solve(1), many = solve(1), few = solve(4);
  expect_no_more_memory(first, many, few);
  ASSERT_EQ(many.iterations, few.iterations);
  ASSERT_GT(many.looks, 2 * few.looks);
  EXPECT_EQ(many.products - few.products, (many.looks - few.looks) * static_cast<int>(system->S.matrix.size()));
}

TEST_P(Looks, know_the_residual_without_another_product) {
  Problem problem(make(), params_, square_.nodes());
  Vector X(problem.map()), R(problem.map()), dX(problem.map()), Xi(problem.map()), known(problem.map()), computed(problem.map());
  X.randomize();
  problem.equations(X, R);
  multipliers_nonconst(problem.system(), R).randomize();
  linearize(problem, X);
  int looks = 0;
  algebra::LinearStop stop;
  stop.tolerance = 1e-6;
  stop.check_every = 3;
  stop.criterion = [&](const Vector& dXi, int, double) {
    Xi.update(1, X, 1, dXi, 0);
    problem.look_at(Xi, R);
    CountedMatrix::products = 0;
    problem.equations(Xi, known);
    EXPECT_EQ(CountedMatrix::products, 0);
    problem.look_away();
    problem.equations(Xi, computed);
    EXPECT_GT(CountedMatrix::products, 0);
    known.update(-1, computed, 1);
    EXPECT_LT(known.norm2(), 1e-12 * R.norm2());
    ++looks;
    return false;
  };
  EXPECT_TRUE(problem.solve(R, dX, stop).converged);
  EXPECT_GT(looks, 2);
}

TEST_P(Looks, of_the_inexact_rule_allocate_nothing_after_the_first_and_take_one_product) {
  const auto system = make();
  Problem problem(system, params_, square_.nodes());
  complementarity::NewtonParams newton;
  newton.max_iterations = 2;
  complementarity::StoppingParams stopping;
  stopping.rule = complementarity::StoppingRule::inexact;
  stopping.linear_tolerance = 1e-8;
  stopping.inexact_factor = 1e-30;  // no look is content
  const auto run = [&](int check_every) {
    Cost cost;
    complementarity::NewtonObserver observer;
    observer.linear = [&](const complementarity::LinearRecord&) { ++cost.looks; };
    Vector X(problem.map());
    CountedMatrix::products = 0;
    const Memory memory;
    cost.iterations = complementarity::newton(problem, X, newton, stopping, check_every, observer).linear_iterations;
    cost.products = CountedMatrix::products;
    cost.memory = Memory::given;
    return cost;
  };
  const Cost first = run(1), many = run(1), few = run(4);
  expect_no_more_memory(first, many, few);
  ASSERT_EQ(many.iterations, few.iterations);
  ASSERT_GT(many.looks, 2 * few.looks);
  EXPECT_EQ(many.products - few.products, (many.looks - few.looks) * static_cast<int>(system->S.matrix.size()));
}

INSTANTIATE_TEST_SUITE_P(Contact, Looks, ::testing::ValuesIn(all_cases), [](const auto& test) { return std::string(test.param.name); });

}  // namespace thixis::contact
