/// The verifier of the contact conditions, on the real models and methods: it takes the solution and nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "methods.hpp"
#include "problem/membrane_operator.hpp"
#include "thixis/complementarity/newton.hpp"
#include "thixis/fem/lagrange_space.hpp"
#include "thixis/membranes/membranes.hpp"
#include "thixis/mesh/build.hpp"

namespace thixis::membranes {
namespace {

using algebra::Vector;
using complementarity::Kkt;

struct Kind {
  const char* problem;
  std::string method;
  int degree;
};
const Kind all_kinds[] = {{"discontinuous multiplier", "fem", 1}, {"disk", "fem", 1},
                          {"discontinuous multiplier", "fem", 2}, {"discontinuous multiplier", "fem", 3},
                          {"discontinuous multiplier", "dg", 2},  {"discontinuous multiplier", "hho", 1},
                          {"discontinuous multiplier", "hho", 3}, {"radial obstacle", "fem", 1},
                          {"radial obstacle", "fem", 2},          {"radial obstacle", "dg", 1},
                          {"radial obstacle", "hho", 2}};

enum Field { u1, u2, lambda };

/// A solved problem with contact in a part of the domain.
class Verdict : public ::testing::TestWithParam<Kind> {
 protected:
  void SetUp() override {
    SKIP_UNLESS_BUILT(GetParam().method);
    const std::string problem = GetParam().problem;
    mesh::MeshParams mesh_params;
    mesh_params.refinements = GetParam().degree == 1 ? 2 : 1;
    mesh_params.cells_per_rank = 50;
    if (problem != "discontinuous multiplier") mesh_params.generator = mesh::Generator::disk;
    levels_ = mesh::build(mesh_params, core::Comm(), ".");
    models::SceneParams scene;
    scene.model = problem == "radial obstacle" ? model::obstacle : model::two;
    scene.case_name = problem;
    membranes_ = problem == "radial obstacle" ? 1 : 2;
    method::MethodParams method;
    method.name = GetParam().method;
    method.degree = GetParam().degree;
    algebra::LinearParams linear;
    linear.solver = algebra::SolverKind::direct;
    model_ = membranes(membrane_scene(scene), tests::method_of(method.name), method, linear, {});
    discretization_ = model_->discretize(levels_, static_cast<int>(levels_.levels.size()) - 1);
    X_ = discretization_->cold_start();
    report_ = complementarity::newton(discretization_->problem(), *X_, {}, {}, 10);
  }

  Kkt verdict(const Vector& X) const { return complementarity::verify(discretization_->kkt_data(X)); }

  /// X with f(value, in contact) in place of one field.
  template <class F>
  Kkt after(Field field, F f) const {
    Vector X(*X_, Teuchos::Copy);
    {
      const auto values = algebra::host_view(X);
      const auto& active = report_.active_set.flags();
      const auto points = static_cast<LocalIndex>(active.size());
      const LocalIndex first = (field == lambda ? membranes_ : field) * nodes();
      for (LocalIndex l = 0; l < points; ++l) {
        double& value = values(first + l);
        value = f(value, active[l] != 0);
      }
    }
    return verdict(X);
  }

  /// Rows of each membrane on this rank: X is in columns.
  LocalIndex nodes() const {
    return (algebra::local_size(*X_->getMap()) - static_cast<LocalIndex>(report_.active_set.flags().size())) / membranes_;
  }

  int membranes_ = 2;
  mesh::Hierarchy levels_;
  std::unique_ptr<models::StationaryModel> model_;
  std::unique_ptr<models::Discretization> discretization_;
  Teuchos::RCP<Vector> X_;
  complementarity::NewtonReport report_;
  static constexpr double tolerance = 1e-6;
};

}  // namespace

TEST_P(Verdict, accepts_the_solution) {
  ASSERT_TRUE(report_.converged) << report_.why;
  ASSERT_GT(report_.active, 0);
  EXPECT_LT(verdict(*X_).worst(), 1e-9);
  EXPECT_TRUE(verdict(*X_).holds(tolerance));
}

TEST_P(Verdict, rejects_a_multiplier_of_the_wrong_sign) {
  const Kkt kkt = after(lambda, [](double value, bool) { return -value; });
  EXPECT_GT(kkt.negative, 0.1);
  EXPECT_GT(kkt.equilibrium, 0.1);
  EXPECT_LT(kkt.infeasible, tolerance);
  EXPECT_FALSE(kkt.holds(tolerance));
}

TEST_P(Verdict, rejects_a_multiplier_that_is_not_that_of_the_forces) {
  const Kkt kkt = after(lambda, [](double value, bool) { return 0.99 * value; });
  EXPECT_GT(kkt.equilibrium, 1e-3);
  EXPECT_LT(std::max(kkt.infeasible, kkt.negative), tolerance);
  EXPECT_FALSE(kkt.holds(tolerance));
}

TEST_P(Verdict, rejects_a_pull_where_the_membranes_do_not_touch) {
  const double largest = X_->normInf();
  const Kkt kkt = after(lambda, [largest](double value, bool contact) { return contact ? value : value + 0.1 * largest; });
  EXPECT_GT(kkt.complementary, 1e-6);
  EXPECT_GT(kkt.equilibrium, 1e-2);
  EXPECT_FALSE(kkt.holds(tolerance));
}

TEST_P(Verdict, rejects_membranes_that_cross) {
  const Kkt kkt = after(u1, [](double value, bool contact) { return contact ? value - 1e-3 : value; });
  EXPECT_GT(kkt.infeasible, 1e-4);
  EXPECT_FALSE(kkt.holds(tolerance));
}

TEST_P(Verdict, rejects_a_solution_that_is_slightly_out_of_equilibrium) {
  for (const Field field : {u1, u2}) {
    if (field == u2 && membranes_ == 1) continue;
    const double sign = field == u1 ? 1 : -1;  // apart from each other: the gap stays non-negative
    const Kkt kkt = after(field, [sign](double value, bool) { return value + sign * 1e-4; });
    EXPECT_GT(kkt.equilibrium, 1e-4) << field;
    EXPECT_EQ(kkt.infeasible, 0) << field;
    EXPECT_FALSE(kkt.holds(tolerance)) << field;
  }
}

TEST_P(Verdict, rejects_what_is_no_number) {
  const Kkt kkt = after(membranes_ == 2 ? u2 : u1, [](double value, bool contact) { return contact ? std::nan("") : value; });
  EXPECT_FALSE(kkt.holds(1e300));
}

TEST_P(Verdict, rejects_the_start) { EXPECT_FALSE(verdict(*discretization_->cold_start()).holds(tolerance)); }

TEST_P(Verdict, rejects_unknowns_without_a_contact_point_that_are_not_in_balance) {
  Vector X(*X_, Teuchos::Copy);
  const auto points = static_cast<LocalIndex>(report_.active_set.flags().size());
  {
    const auto values = algebra::host_view(X);
    for (LocalIndex l = points; l < nodes(); ++l) values(l) += 1e-3;
  }
  EXPECT_EQ(verdict(X).holds(tolerance), GetParam().method != "hho");
  EXPECT_EQ(core::Comm().any(nodes() > points), GetParam().method == "hho");
}

INSTANTIATE_TEST_SUITE_P(Membranes, Verdict, ::testing::ValuesIn(all_kinds), [](const auto& kind) {
  return std::string(kind.param.problem).substr(0, 4) + "_" + kind.param.method + "_P" + std::to_string(kind.param.degree);
});

}  // namespace thixis::membranes
