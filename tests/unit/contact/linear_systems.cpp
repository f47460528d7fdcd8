/// The full, the reduced and the condensed linear system of a Newton step have the same solution, for any C-function's derivatives, any
/// number of fields and gaps, and wherever the contact points are.
#include <gtest/gtest.h>

#include <random>

#include "setting.hpp"

namespace thixis::contact {
namespace {

using scene::FieldPtr;

enum class Rows { contact, free, min, fischer_burmeister, same_sign };
constexpr std::pair<Rows, const char*> all_rows[] = {{Rows::contact, "contact everywhere"},
                                                     {Rows::free, "no contact"},
                                                     {Rows::min, "Newton-min"},
                                                     {Rows::fischer_burmeister, "Fischer-Burmeister"},
                                                     {Rows::same_sign, "both derivatives positive"}};

/// a, b as the C-functions give them, from random gaps and multipliers with a few exact zeros.
void derivatives(Rows rows, const Vector& s, std::mt19937& random, Vector& a, Vector& b) {
  const double right_angle = 2 * std::atan(1.0);  // gap 0, multiplier > 0: contact
  std::uniform_real_distribution<double> angle(0, 4 * right_angle), positive(0.1, 2);
  const auto scale = algebra::host_view(s);
  const auto a_l = algebra::host_overwrite(a), b_l = algebra::host_overwrite(b);
  for (std::size_t l = 0; l < a_l.extent(0); ++l) {
    const bool contact = rows == Rows::contact || (rows == Rows::min && random() % 3 == 0);
    if (rows == Rows::fischer_burmeister) {
      double phi = random() % 5 == 0 ? right_angle : angle(random);
      if (std::sin(phi) > 1 - 1e-6) phi = right_angle;  // nearly so: the systems are ill-conditioned
      a_l(l) = random() % 7 == 0 ? 0 : std::cos(phi) - 1;
      b_l(l) = a_l(l) == 0 ? -scale(l) : phi == right_angle ? 0 : scale(l) * (std::sin(phi) - 1);
    } else if (rows == Rows::same_sign) {
      a_l(l) = positive(random);
      b_l(l) = scale(l) * positive(random);
    } else {
      a_l(l) = contact ? 1 : 0;
      b_l(l) = contact ? 0 : scale(l);
    }
  }
}

FieldPtr varying(double slope) {
  return scene::formula([slope](double x, double y) { return 1 + slope * x * (2 - y); });
}

Frames uniform(int fields, int gaps, const std::vector<std::vector<double>>& B, const std::vector<double>& weight) {
  return Frames({make_frame(fields, gaps, of_rows(B), weight)});
}

/// Normals that turn from node to node, ghosts included: by the place of the node, so that all ranks agree.
Frames turning(const method::Space& space) {
  const auto S = method::assemble(*fem::diffusion(space, scene::constant(1)));
  const auto places = space.coordinates();
  MultiVector at_columns(S->getColMap(), 2);
  if (S->getGraph()->getImporter().is_null()) at_columns.assign(*places);
  else at_columns.doImport(*places, *S->getGraph()->getImporter(), Tpetra::INSERT);
  constexpr int kinds = 5;
  std::vector<Frame> frames;
  for (int kind = 0; kind < kinds; ++kind)
    frames.push_back(make_frame(2, 1, of_rows({{std::cos(0.3 + 1.1 * kind)}, {std::sin(0.3 + 1.1 * kind)}}), {1, 1}));
  const auto x = at_columns.getLocalViewHost(Tpetra::Access::ReadOnly);
  const Kokkos::View<int*> kind("kind", x.extent(0));
  const auto host = Kokkos::create_mirror_view(kind);
  for (std::size_t l = 0; l < x.extent(0); ++l) host(l) = static_cast<int>(std::lround(64 * x(l, 0) + 320 * x(l, 1))) % kinds;
  Kokkos::deep_copy(kind, host);
  return Frames(frames, kind);
}

struct Kind {
  const char* name;
  int degree;
  System (*make)(const method::Space& space, bool condensed);
};

System system(const method::Space& space, BlockOperator S, Constraint constraint) {
  const int fields = S.fields;
  return {std::move(S), std::move(constraint), zero_load(space, fields)};
}

System membranes(const method::Space& space, bool condensed) {
  return system(space, operators(space, {scene::constant(1), scene::constant(5)}, condensed),
                constraint(space, 1, uniform(2, 1, {{1}, {-1}}, {1, 5})));
}
System varying_membranes(const method::Space& space, bool condensed) {
  return system(space, operators(space, {varying(1), varying(0.3)}, condensed),
                constraint(space, 1, uniform(2, 1, {{1}, {-1}}, {0.43, 0.57})));
}
System obstacle(const method::Space& space, bool condensed) {
  return system(space, operators(space, {scene::constant(2)}, condensed), constraint(space, 1, uniform(1, 1, {{1}}, {1})));
}
System stack(const method::Space& space, bool condensed) {
  return system(space, operators(space, {scene::constant(1), scene::constant(2), scene::constant(7)}, condensed),
                constraint(space, 2, uniform(3, 2, {{1, 0}, {-1, 1}, {0, -1}}, {1, 2, 7})));
}
System varying_stack(const method::Space& space, bool condensed) {
  return system(space, operators(space, {varying(1), varying(0.3), scene::constant(2)}, condensed),
                constraint(space, 2, uniform(3, 2, {{1, 0}, {-1, 1}, {0, -1}}, {1.5, 1.2, 2})));
}
/// Contact at every third node from the second on.
System scattered(const method::Space& space, bool condensed) {
  return system(space, operators(space, {scene::constant(1), scene::constant(5)}, condensed),
                constraint(space, 1, uniform(2, 1, {{1}, {-1}}, {1, 5}), 1, 3));
}
/// Two components that act on each other, and normals that differ from node to node.
System normals(const method::Space& space, bool condensed) {
  BlockOperator S = operators(space, {varying(1), scene::constant(2)}, condensed);
  S.weight[0] = of_rows({{2, 0.5}, {0.5, 1}});
  S.weight[1] = of_rows({{1, -0.25}, {-0.25, 1}});
  return system(space, std::move(S), constraint(space, 1, turning(space), 1, 2));
}

const Kind all_kinds[] = {{"membranes", 1, membranes},
                          {"membranes", 3, membranes},
                          {"varying_membranes", 2, varying_membranes},
                          {"varying_membranes", 4, varying_membranes},
                          {"obstacle", 3, obstacle},
                          {"stack", 1, stack},
                          {"stack", 3, stack},
                          {"varying_stack", 1, varying_stack},
                          {"varying_stack", 3, varying_stack},
                          {"scattered", 1, scattered},
                          {"scattered", 3, scattered},
                          {"normals", 1, normals},
                          {"normals", 3, normals}};

/// |A dX + R|, row by row and by nothing that the systems use but matrices: [ S -B D; a Bᵀ b ].
double defect(const System& of, const Vector& a, const Vector& b, const Vector& dX, const Vector& R) {
  const int m = of.fields(), q = of.gaps(), means = m - q;
  const MultiVector du = fields(of, dX), dlambda = multipliers(of, dX), r = fields(of, R), C = multipliers(of, R);
  MultiVector rows(r, Teuchos::Copy);
  Vector product(of.map());
  for (std::size_t k = 0; k < of.S.matrix.size(); ++k)
    for (int j = 0; j < m; ++j) {
      of.S.matrix[k]->apply(*du.getVector(j), product);
      for (int i = 0; i < m; ++i) rows.getVectorNonConst(i)->update(of.S.weight[k](i, j), product, 1);
    }
  const auto Q = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), of.constraint.frames.inverse);
  const auto kind = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), of.constraint.frames.kind);
  const auto node = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), of.constraint.node);
  double sum = 0;
  {
    const auto out = rows.getLocalViewHost(Tpetra::Access::ReadWrite);
    const auto u = du.getLocalViewHost(Tpetra::Access::ReadOnly), lambda = dlambda.getLocalViewHost(Tpetra::Access::ReadOnly),
               c = C.getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto a_l = algebra::host_view(a), b_l = algebra::host_view(b), D = algebra::host_view(*of.constraint.pairing);
    const std::size_t points = node.extent(0);
    for (std::size_t p = 0; p < points; ++p) {
      const LocalIndex l = node(p);
      const Small& back = Q(kind.extent(0) == 0 ? 0 : kind(l));
      for (int g = 0; g < q; ++g) {
        double gap = 0;
        for (int i = 0; i < m; ++i) {
          gap += back(means + g, i) * u(l, i);
          out(l, i) -= back(means + g, i) * D(p) * lambda(p, g);
        }
        sum += std::pow(a_l(g * points + p) * gap + b_l(g * points + p) * lambda(p, g) + c(p, g), 2);
      }
    }
  }
  sum = core::Comm().sum(sum);
  for (int i = 0; i < m; ++i) sum += std::pow(rows.getVector(i)->norm2(), 2);
  return std::sqrt(sum);
}

algebra::LinearParams by(algebra::SystemForm form, algebra::SolverKind solver, algebra::PreconditionerKind preconditioner) {
  algebra::LinearParams params;
  params.form = form;
  params.solver = solver;
  params.preconditioner = preconditioner;
  return params;
}

class Systems : public ::testing::TestWithParam<Kind> {
 protected:
  std::shared_ptr<const System> make(bool condensed) const { return std::make_shared<System>(GetParam().make(square_.space(), condensed)); }
  Square square_{GetParam().degree, GetParam().degree == 1 ? 2 : 1};
};

}  // namespace

TEST_P(Systems, full_reduced_and_condensed_give_the_same_increment) {
  using algebra::PreconditionerKind;
  using algebra::SolverKind;
  using algebra::SystemForm;
  std::mt19937 random(17 + core::Comm().rank());
  const auto plain = make(false), with_cells = make(true);
  const algebra::Nodes& nodes = square_.nodes();
  const auto direct = by(SystemForm::reduced, SolverKind::direct, PreconditionerKind::none);
  const auto aggregates = by(SystemForm::reduced, SolverKind::cg, PreconditionerKind::muelu);
  const auto levels = by(SystemForm::reduced, SolverKind::cg, PreconditionerKind::multigrid);
  Problem full(plain, by(SystemForm::full, SolverKind::direct, PreconditionerKind::none), nodes);
  Problem reduced(plain, direct, nodes), muelu(plain, aggregates, nodes), multigrid(plain, levels, nodes);
  Problem condensed(with_cells, direct, nodes), condensed_muelu(with_cells, aggregates, nodes),
      condensed_multigrid(with_cells, levels, nodes);
  Vector s(full.points()), a(full.points()), b(full.points()), X(full.map()), R(full.map());
  full.scaling(s);
  for (const auto& [rows, rows_name] : all_rows)
    for (int step = 0; step < 2; ++step) {  // the second with other contact rows in the same system
      SCOPED_TRACE(rows_name);
      derivatives(rows, s, random, a, b);
      R.randomize();
      Vector reference(full.map());
      full.linearize(X, a, b);
      ASSERT_TRUE(full.solve(R, reference, {1e-12, 0, nullptr}).converged);
      EXPECT_LT(defect(*plain, a, b, reference, R), 1e-9);
      const double size = reference.norm2();
      EXPECT_GT(size, 0);
      for (const auto& [name, problem] : {std::pair("direct", &reduced), std::pair("muelu", &muelu), std::pair("multigrid", &multigrid),
                                          std::pair("condensed, direct", &condensed), std::pair("condensed, muelu", &condensed_muelu),
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

TEST_P(Systems, a_criterion_sees_the_increment_of_all_fields) {
  std::mt19937 random(5 + core::Comm().rank());
  const auto plain = make(false);
  for (const bool condensed : {false, true})
    for (const auto form : {algebra::SystemForm::full, algebra::SystemForm::reduced}) {
      Problem problem(make(condensed), by(form, algebra::SolverKind::gmres, algebra::PreconditionerKind::ilu), square_.nodes());
      Vector s(problem.points()), a(problem.points()), b(problem.points()), X(problem.map()), R(problem.map()), dX(problem.map());
      problem.scaling(s);
      derivatives(Rows::min, s, random, a, b);
      R.randomize();
      problem.linearize(X, a, b);
      Vector last(problem.map());
      int looks = 0;
      algebra::LinearStop stop;
      stop.tolerance = 1e-9;
      stop.check_every = 1;
      stop.criterion = [&](const Vector& d, int, double residual) {
        ++looks;
        if (form == algebra::SystemForm::reduced || condensed) {
          EXPECT_LE(defect(*plain, a, b, d, R), 5 * residual + 1e-10);
        }
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

TEST_P(Systems, the_scaling_makes_the_active_set_independent_of_units) {
  System stiff = GetParam().make(square_.space(), false);
  for (Small& weight : stiff.S.weight)
    for (int i = 0; i < stiff.fields(); ++i)
      for (int j = 0; j < stiff.fields(); ++j) weight(i, j) *= 1000;
  const Problem a(make(false), {}, square_.nodes());
  const Problem b(std::make_shared<System>(stiff), {}, square_.nodes());
  Vector s(a.points()), t(b.points());
  a.scaling(s);
  b.scaling(t);
  t.update(-1e-3, s, 1);  // forces and multipliers are 1000 times larger at the same gap
  EXPECT_LT(t.normInf(), 1e-12 * s.normInf());
  EXPECT_GT(s.meanValue(), 0);
}

TEST_P(Systems, the_number_of_rows_is_known_before_any_is_assembled) {
  const auto plain = make(false);
  const int m = plain->fields(), p = GetParam().degree;
  const auto params = [](algebra::SystemForm form) { return by(form, algebra::SolverKind::gmres, algebra::PreconditionerKind::ilu); };
  const Problem full(plain, params(algebra::SystemForm::full), square_.nodes()),
      reduced(plain, params(algebra::SystemForm::reduced), square_.nodes()),
      condensed(make(true), params(algebra::SystemForm::reduced), square_.nodes());
  const auto nodes = static_cast<GlobalIndex>(plain->map()->getGlobalNumElements());
  const auto multipliers = plain->gaps() * static_cast<GlobalIndex>(plain->points()->getGlobalNumElements());
  EXPECT_EQ(full.unknowns(), m * nodes + multipliers);
  EXPECT_EQ(full.rows(), m * nodes + multipliers);
  EXPECT_EQ(reduced.rows(), m * nodes);
  EXPECT_EQ(condensed.rows(), m * (nodes - (p - 1) * (p - 2) / 2 * square_.space().mesh().global_cells));
  EXPECT_EQ(full.nonzeros(), 0);
}

INSTANTIATE_TEST_SUITE_P(Contact, Systems, ::testing::ValuesIn(all_kinds),
                         [](const auto& kind) { return std::string(kind.param.name) + "_P" + std::to_string(kind.param.degree); });

}  // namespace thixis::contact
