/// The full and the reduced linear system of a Newton step have the same solution, for any C-function's derivatives.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "membrane_problem.hpp"
#include "thixis/fem/lagrange_space.hpp"
#include "thixis/mesh/build.hpp"

namespace thixis::models {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using scene::FieldPtr;

struct Tensions {
  const char* name;
  FieldPtr mu[2];
};
std::vector<Tensions> all_tensions() {
  return {
      {"equal", {scene::constant(2), scene::constant(2)}},
      {"different", {scene::constant(1), scene::constant(5)}},
      {"varying",
       {scene::formula([](double x, double) { return 1 + x; }), scene::formula([](double x, double y) { return 2 - std::sin(x * y); })}}};
}

enum class Rows { contact, free, min, fischer_burmeister, same_sign };
constexpr std::pair<Rows, const char*> all_rows[] = {{Rows::contact, "contact everywhere"},
                                                     {Rows::free, "no contact"},
                                                     {Rows::min, "Newton-min"},
                                                     {Rows::fischer_burmeister, "Fischer-Burmeister"},
                                                     {Rows::same_sign, "both derivatives positive"}};

/// a, b as the C-functions give them, from random gaps and multipliers with a few exact zeros.
void derivatives(Rows rows, const Vector& s, std::mt19937& random, Vector& a, Vector& b) {
  std::uniform_real_distribution<double> angle(0, 2 * 3.14159265358979), positive(0.1, 2);
  const auto scale = algebra::host_view(s);
  const auto a_l = algebra::host_overwrite(a), b_l = algebra::host_overwrite(b);
  for (std::size_t l = 0; l < a_l.extent(0); ++l) {
    const bool contact = rows == Rows::contact || (rows == Rows::min && random() % 3 == 0);
    if (rows == Rows::fischer_burmeister) {
      const double phi = random() % 5 == 0 ? 1.5707963267948966 : angle(random);  // 90 degrees: gap 0, multiplier > 0: contact
      a_l(l) = random() % 7 == 0 ? 0 : std::cos(phi) - 1;
      b_l(l) = a_l(l) == 0 ? -scale(l) : phi == 1.5707963267948966 ? 0 : scale(l) * (std::sin(phi) - 1);
    } else if (rows == Rows::same_sign) {
      a_l(l) = positive(random);
      b_l(l) = scale(l) * positive(random);
    } else {
      a_l(l) = contact ? 1 : 0;
      b_l(l) = contact ? 0 : scale(l);
    }
  }
}

class Systems : public ::testing::Test {
 protected:
  Systems() {
    mesh::MeshParams params;
    params.refinements = 2;
    params.cells_per_rank = 50;
    levels_ = mesh::build(params, core::Comm(), ".");
    const mesh::Mesh& mesh = levels_.finest();
    std::vector<bool> held(mesh.tags.size(), true);
    held[1] = false;  // an edge without Dirichlet data
    space_ = fem::make_lagrange_space(mesh, {held, nullptr, {}});
  }

  MembraneOperator membranes(const Tensions& tensions) const {
    MembraneOperator result;
    result.pairing = Teuchos::rcpFromRef(space_->pairing());
    const double* constant[2] = {tensions.mu[0]->constant(), tensions.mu[1]->constant()};
    for (int alpha = 0; alpha < 2; ++alpha) {
      if (constant[alpha]) {
        if (alpha == 0) result.matrix[0] = space_->stiffness(*scene::constant(1));
        else result.matrix[1] = result.matrix[0];
        result.factor[alpha] = *constant[alpha];
      } else {
        result.matrix[alpha] = space_->stiffness(*tensions.mu[alpha]);
      }
      result.load[alpha] = Teuchos::rcp(new Vector(space_->map()));
    }
    if (constant[0]) result.theta = {*constant[0] / (*constant[0] + *constant[1]), *constant[1] / (*constant[0] + *constant[1])};
    else result.theta = {0.43, 0.57};  // any with sum 1
    return result;
  }

  mesh::Hierarchy levels_;
  std::unique_ptr<method::Space> space_;
};

/// |A dX + R| with A applied block by block: [ S1 0 -D ; 0 S2 D ; a -a b ].
double defect(const MembraneOperator& membranes, const Vector& a, const Vector& b, const Vector& dX, const Vector& R) {
  MultiVector d(membranes.map(), 3), r(membranes.map(), 3);
  split(dX, d);
  split(R, r);
  double sum = 0;
  for (int alpha = 0; alpha < 2; ++alpha) {
    Vector row(membranes.map());
    membranes.matrix[alpha]->apply(*d.getVector(alpha), row, Teuchos::NO_TRANS, membranes.factor[alpha], 0);
    row.elementWiseMultiply(alpha == 0 ? -1 : 1, *membranes.pairing, *d.getVector(2), 1);
    row.update(1, *r.getVector(alpha), 1);
    sum += std::pow(row.norm2(), 2);
  }
  Vector gap(membranes.map()), row(membranes.map());
  gap.update(1, *d.getVector(0), -1, *d.getVector(1), 0);
  row.elementWiseMultiply(1, a, gap, 0);
  row.elementWiseMultiply(1, b, *d.getVector(2), 1);
  row.update(1, *r.getVector(2), 1);
  return std::sqrt(sum + std::pow(row.norm2(), 2));
}

algebra::LinearParams by(algebra::SystemForm form, algebra::SolverKind solver, algebra::PreconditionerKind preconditioner) {
  algebra::LinearParams params;
  params.form = form;
  params.solver = solver;
  params.preconditioner = preconditioner;
  return params;
}

}  // namespace

TEST_F(Systems, full_and_reduced_give_the_same_increment) {
  using algebra::PreconditionerKind;
  using algebra::SolverKind;
  using algebra::SystemForm;
  std::mt19937 random(17 + core::Comm().rank());
  for (const Tensions& tensions : all_tensions())
    for (const auto& [rows, rows_name] : all_rows) {
      SCOPED_TRACE(std::string(tensions.name) + " tensions, " + rows_name);
      const MembraneOperator operators = membranes(tensions);
      MembraneProblem full(operators, by(SystemForm::full, SolverKind::direct, PreconditionerKind::none), space_->coordinates());
      MembraneProblem reduced(operators, by(SystemForm::reduced, SolverKind::direct, PreconditionerKind::none), space_->coordinates());
      MembraneProblem multigrid(operators, by(SystemForm::reduced, SolverKind::cg, PreconditionerKind::muelu), space_->coordinates());
      Vector s(space_->map()), a(space_->map()), b(space_->map()), X(full.map()), R(full.map());
      full.scaling(s);
      for (int step = 0; step < 2; ++step) {  // the second with other contact rows in the same system
        derivatives(rows, s, random, a, b);
        R.randomize();
        Vector reference(full.map());
        full.linearize(X, a, b);
        ASSERT_TRUE(full.solve(R, reference, {1e-9, 0, nullptr}).converged);
        EXPECT_LT(defect(operators, a, b, reference, R), 1e-9);
        const double size = reference.norm2();
        for (MembraneProblem* problem : {&reduced, &multigrid}) {
          Vector dX(full.map());
          problem->linearize(X, a, b);
          const auto report = problem->solve(R, dX, {1e-12, 0, nullptr});
          ASSERT_TRUE(report.converged || report.residual < 1e-10) << report.reason;
          dX.update(-1, reference, 1);
          EXPECT_LT(dX.norm2(), 1e-9 * size) << (problem == &reduced ? "direct" : "multigrid");
        }
      }
    }
}

TEST_F(Systems, the_scaling_makes_the_active_set_independent_of_units) {
  const MembraneOperator soft = membranes({"", {scene::constant(1), scene::constant(3)}});
  const MembraneOperator stiff = membranes({"", {scene::constant(1000), scene::constant(3000)}});
  const algebra::LinearParams params;
  MembraneProblem a(soft, params, space_->coordinates()), b(stiff, params, space_->coordinates());
  Vector s(space_->map()), t(space_->map());
  a.scaling(s);
  b.scaling(t);
  t.update(-1e-3, s, 1);  // forces and multipliers are 1000 times larger at the same gap
  EXPECT_LT(t.normInf(), 1e-12 * s.normInf());
  EXPECT_GT(s.meanValue(), 0);
}

TEST_F(Systems, the_number_of_rows_is_known_before_any_is_assembled) {
  const MembraneOperator operators = membranes(all_tensions()[0]);
  algebra::LinearParams params;
  MembraneProblem full(operators, params, space_->coordinates());
  params.form = algebra::SystemForm::reduced;
  MembraneProblem reduced(operators, params, space_->coordinates());
  const auto unknowns = static_cast<GlobalIndex>(space_->map()->getGlobalNumElements());
  EXPECT_EQ(full.rows(), 3 * unknowns);
  EXPECT_EQ(reduced.rows(), 2 * unknowns);
  EXPECT_EQ(full.nonzeros(), 0);
}

}  // namespace thixis::models
