/// The full, the reduced and the condensed linear system of a Newton step have the same solution, for any C-function's derivatives.
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
      double phi = random() % 5 == 0 ? 1.5707963267948966 : angle(random);  // 90 degrees: gap 0, multiplier > 0: contact
      if (std::sin(phi) > 1 - 1e-6) phi = 1.5707963267948966;               // nearly so: the systems are ill-conditioned
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

struct Kind {
  int membranes;
  int degree;
};
constexpr Kind all_kinds[] = {{2, 1}, {1, 1}, {2, 2}, {1, 2}, {2, 3}, {1, 3}, {2, 4}};

class Systems : public ::testing::TestWithParam<Kind> {
 protected:
  Systems() {
    mesh::MeshParams params;
    params.refinements = GetParam().degree == 1 ? 2 : 1;
    params.cells_per_rank = 50;
    levels_ = mesh::build(params, core::Comm(), ".");
    const mesh::Mesh& mesh = levels_.finest();
    std::vector<bool> held(mesh.tags.size(), true);
    held[1] = false;  // an edge without Dirichlet data
    method_.degree = GetParam().degree;
    method_.condensation = true;
    space_ = fem::make_lagrange_space(mesh, {held, nullptr, method_});
  }

  /// Condensed where there is anything inside the cells.
  MembraneOperator membranes(const Tensions& tensions) const {
    scene::MembraneScene scene;
    scene.count = GetParam().membranes;
    scene.obstacle = scene.count == 1 ? scene::formula([](double x, double y) { return x * y; }) : nullptr;
    const std::vector<FieldPtr> nothing(levels_.finest().tags.size());
    method::Coefficients lift[2];
    Teuchos::RCP<Vector> body[2];
    for (int alpha = 0; alpha < scene.count; ++alpha) {
      scene.tension[alpha] = tensions.mu[alpha];
      lift[alpha] = space_->lift({nothing, nothing}, 0);
      body[alpha] = Teuchos::rcp(new Vector(space_->map()));
    }
    MembraneOperator result = membrane_operator(scene, *space_, method_, lift, body);
    if (!result.shared()) result.theta = {0.43, 0.57};  // any with sum 1
    return result;
  }

  method::MethodParams method_;
  mesh::Hierarchy levels_;
  std::unique_ptr<method::Space> space_;
};

MembraneOperator uncondensed(MembraneOperator membranes) {
  membranes.condensed.reset();
  return membranes;
}

/// |A dX + R| with A applied block by block: [ S1 0 -D ; 0 S2 D ; a -a b ].
double defect(const MembraneOperator& membranes, const Vector& a, const Vector& b, const Vector& dX, const Vector& R) {
  const Fields d(membranes, dX);
  Fields r(membranes, R);
  MultiVector pressure(membranes.map(), 1);
  {
    const auto out = pressure.getLocalViewHost(Tpetra::Access::OverwriteAll);
    const auto D = algebra::host_view(*membranes.pairing), lambda = algebra::host_view(d.lambda);
    for (std::size_t l = 0; l < D.extent(0); ++l) out(l, 0) = D(l) * lambda(l);
  }
  double sum = 0;
  for (int alpha = 0; alpha < membranes.count; ++alpha) {
    const auto row = r.u.getVectorNonConst(alpha);
    membranes.matrix[alpha]->apply(*d.u.getVector(alpha), *row, Teuchos::NO_TRANS, membranes.factor[alpha], 1);
    row->update(alpha == 0 ? -1 : 1, *pressure.getVector(0), 1);
    sum += std::pow(row->norm2(), 2);
  }
  {
    const auto u = d.u.getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto lambda = algebra::host_view(d.lambda), a_l = algebra::host_view(a), b_l = algebra::host_view(b);
    const auto C = algebra::host_view(r.lambda);
    for (std::size_t l = 0; l < lambda.extent(0); ++l)
      C(l) += a_l(l) * (membranes.count == 2 ? u(l, 0) - u(l, 1) : u(l, 0)) + b_l(l) * lambda(l);
  }
  return std::sqrt(sum + std::pow(r.lambda.norm2(), 2));
}

algebra::LinearParams by(algebra::SystemForm form, algebra::SolverKind solver, algebra::PreconditionerKind preconditioner) {
  algebra::LinearParams params;
  params.form = form;
  params.solver = solver;
  params.preconditioner = preconditioner;
  return params;
}

}  // namespace

TEST_P(Systems, full_reduced_and_condensed_give_the_same_increment) {
  using algebra::PreconditionerKind;
  using algebra::SolverKind;
  using algebra::SystemForm;
  std::mt19937 random(17 + core::Comm().rank());
  for (const Tensions& tensions : all_tensions())
    for (const auto& [rows, rows_name] : all_rows) {
      SCOPED_TRACE(std::string(tensions.name) + " tensions, " + rows_name);
      const MembraneOperator operators = membranes(tensions), plain = uncondensed(operators);
      ASSERT_EQ(operators.condensed.has_value(), GetParam().degree >= 3);
      const auto full_params = by(SystemForm::full, SolverKind::direct, PreconditionerKind::none);
      const auto direct = by(SystemForm::reduced, SolverKind::direct, PreconditionerKind::none);
      const auto cycles = by(SystemForm::reduced, SolverKind::cg, PreconditionerKind::muelu);
      const auto coordinates = space_->coordinates();
      MembraneProblem full(plain, full_params, coordinates), reduced(plain, direct, coordinates), multigrid(plain, cycles, coordinates),
          condensed(operators, direct, coordinates), condensed_multigrid(operators, cycles, coordinates);
      Vector s(full.points()), a(full.points()), b(full.points()), X(full.map()), R(full.map());
      full.scaling(s);
      for (int step = 0; step < 2; ++step) {  // the second with other contact rows in the same system
        derivatives(rows, s, random, a, b);
        R.randomize();
        Vector reference(full.map());
        full.linearize(X, a, b);
        ASSERT_TRUE(full.solve(R, reference, {1e-12, 0, nullptr}).converged);
        EXPECT_LT(defect(operators, a, b, reference, R), 1e-9);
        const double size = reference.norm2();
        for (const auto& [name, problem] :
             {std::pair("direct", &reduced), std::pair("multigrid", &multigrid), std::pair("condensed, direct", &condensed),
              std::pair("condensed, multigrid", &condensed_multigrid)}) {
          Vector dX(full.map());
          problem->linearize(X, a, b);
          const auto report = problem->solve(R, dX, {1e-12, 0, nullptr});
          // large penalties make large right-hand sides, and round-off of that size
          ASSERT_TRUE(report.converged || report.residual < 1e-10 || report.reason.find("stagnates") != std::string::npos)
              << name << ": " << report.reason;
          dX.update(-1, reference, 1);
          EXPECT_LT(dX.norm2(), 1e-9 * size) << name;
        }
      }
    }
}

TEST_P(Systems, a_criterion_sees_the_increment_of_all_fields) {
  using algebra::PreconditionerKind;
  using algebra::SolverKind;
  using algebra::SystemForm;
  std::mt19937 random(5 + core::Comm().rank());
  for (const Tensions& tensions : all_tensions()) {
    const MembraneOperator operators = membranes(tensions), plain = uncondensed(operators);
    for (const MembraneOperator* form : {&plain, &operators}) {
      MembraneProblem problem(*form, by(SystemForm::reduced, SolverKind::gmres, PreconditionerKind::ilu), space_->coordinates());
      Vector s(problem.points()), a(problem.points()), b(problem.points()), X(problem.map()), R(problem.map()), dX(problem.map());
      problem.scaling(s);
      derivatives(Rows::min, s, random, a, b);
      R.randomize();
      problem.linearize(X, a, b);
      Vector last(problem.map());
      int looks = 0;
      algebra::LinearStop stop;
      stop.tolerance = 1e-10;
      stop.check_every = 1;
      stop.criterion = [&](const Vector& d, int, double residual) {
        ++looks;
        EXPECT_LE(defect(operators, a, b, d, R), 3 * residual + 1e-12);  // |r| <= √5 of its parts
        last.assign(d);
        return residual < 1e-3;
      };
      const auto report = problem.solve(R, dX, stop);
      EXPECT_TRUE(report.by_criterion);
      EXPECT_GT(looks, 2);
      dX.update(-1, last, 1);
      EXPECT_LT(dX.norm2(), 1e-12 * last.norm2());
    }
  }
}

TEST_P(Systems, the_scaling_makes_the_active_set_independent_of_units) {
  const MembraneOperator soft = membranes({"", {scene::constant(1), scene::constant(3)}});
  const MembraneOperator stiff = membranes({"", {scene::constant(1000), scene::constant(3000)}});
  const algebra::LinearParams params;
  MembraneProblem a(soft, params, space_->coordinates()), b(stiff, params, space_->coordinates());
  Vector s(a.points()), t(b.points());
  a.scaling(s);
  b.scaling(t);
  t.update(-1e-3, s, 1);  // forces and multipliers are 1000 times larger at the same gap
  EXPECT_LT(t.normInf(), 1e-12 * s.normInf());
  EXPECT_GT(s.meanValue(), 0);
}

TEST_P(Systems, the_number_of_rows_is_known_before_any_is_assembled) {
  const MembraneOperator operators = membranes(all_tensions()[0]), plain = uncondensed(operators);
  const int m = GetParam().membranes, p = GetParam().degree;
  algebra::LinearParams params;
  const MembraneProblem full(plain, params, space_->coordinates());
  params.form = algebra::SystemForm::reduced;
  const MembraneProblem reduced(plain, params, space_->coordinates()), condensed(operators, params, space_->coordinates());
  const auto unknowns = static_cast<GlobalIndex>(space_->map()->getGlobalNumElements());
  EXPECT_EQ(full.unknowns(), (m + 1) * unknowns);
  EXPECT_EQ(full.rows(), (m + 1) * unknowns);
  EXPECT_EQ(reduced.rows(), m * unknowns);
  EXPECT_EQ(condensed.rows(), m * (unknowns - (p - 1) * (p - 2) / 2 * levels_.finest().global_cells));
  EXPECT_EQ(full.nonzeros(), 0);
}

INSTANTIATE_TEST_SUITE_P(Fem, Systems, ::testing::ValuesIn(all_kinds), [](const auto& kind) {
  return (kind.param.membranes == 2 ? "two_membranes_P" : "obstacle_P") + std::to_string(kind.param.degree);
});

}  // namespace thixis::models
