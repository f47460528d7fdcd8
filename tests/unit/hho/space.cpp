/// HHO of degree 1 to 4 on the meshes of all generators: everything that must hold exactly for polynomials of degree p, and orders.
#include "thixis/hho/space.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "problems.hpp"
#include "thixis/algebra/solver.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/contact/condensation.hpp"
#include "thixis/hho/params.hpp"
#include "thixis/mesh/adapt.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/method/transfer.hpp"

namespace thixis::hho {
namespace {

using algebra::Vector;
using mesh::Generator;
using method::BoundaryValues;
using method::Space;
using scene::FieldPtr;

/// The same condition on all of the boundary.
BoundaryValues everywhere(const mesh::Mesh& mesh, const FieldPtr& dirichlet, const FieldPtr& neumann = nullptr) {
  return {std::vector<FieldPtr>(mesh.tags.size(), dirichlet), std::vector<FieldPtr>(mesh.tags.size(), neumann)};
}

double distance(const Vector& v, const Vector& w) {
  Vector d(v, Teuchos::Copy);
  d.update(-1, w, 1);
  return d.normInf();
}

Vector interpolated(const Space& V, const FieldPtr& u) {
  Vector values(V.map());
  V.interpolate(*u, 0, values);
  return values;
}

Vector solved(const algebra::MatrixPtr& A, const Vector& b) {
  Vector u(b.getMap());
  algebra::LinearParams params;
  params.solver = algebra::SolverKind::direct;
  algebra::Solver solver(params);
  solver.set_matrix(A, 1);
  EXPECT_TRUE(solver.solve(b, u, {1e-13 * b.norm2(), 0, nullptr}).residual < 1e-10 * b.norm2());
  return u;
}

/// -mu Lap u = f.
struct Poisson {
  const Space& V;
  FieldPtr tension, force;
  BoundaryValues boundary;
  method::Coefficients lift = V.lift(boundary, 0);

  Vector right_side() const {
    Vector F(V.map()), held(V.map());
    method::load(*diffusion(V, tension), *force, boundary, 0, F);
    method::apply(*diffusion(V, tension), lift, held);
    F.update(-1, held, 1);
    return F;
  }
  Vector solution() const { return solved(method::assemble(*diffusion(V, tension)), right_side()); }
  Vector condensed_solution() const {
    const auto form = diffusion(V, tension)->cells();
    contact::Condensation condensation(V.map(), V.graph()->getColMap(), V.elements(), V.interior(), contact::LocalForm::positive_definite);
    condensation.set_matrix([&](LocalIndex first, const method::LocalMatrices& A) { form->matrices(first, A); });
    const Vector F = right_side();
    Vector reduced(condensation.rows()), u(V.map());
    condensation.reduce(F, reduced);
    condensation.recover(F, solved(condensation.matrix(), reduced), u);
    return u;
  }
  double error(const Vector& u, const method::Gradient& exact) const {
    return std::sqrt(method::energy_error(*diffusion(V, tension), V.complete(u, lift), {method::Known{exact}}, 0));
  }
};

/// Three adaptive levels, each around another corner of the first cell of the coarsest mesh, so that cells move to other ranks.
void adapt_around_a_cell(mesh::Hierarchy& levels) {
  const auto root = mesh::on_host(*levels.root);
  bool moved = false;
  for (int corner = 0; corner < 3; ++corner) {
    const LocalIndex v = root.cell_vertices(0, corner);
    const mesh::Mesh& mesh = levels.finest();
    const auto host = mesh::on_host(mesh);
    std::vector<LocalIndex> marked;
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
      for (int i = 0; i < 3; ++i)
        if (host.coordinates(host.cell_vertices(K, i), 0) == root.coordinates(v, 0) &&
            host.coordinates(host.cell_vertices(K, i), 1) == root.coordinates(v, 1))
          marked.push_back(K);
    mesh::adapt(levels, marked);
    const mesh::Mesh& fine = levels.finest();
    for (LocalIndex K = 0; K < fine.owned_cells; ++K) moved = moved || fine.cell_parent[K] < 0 || fine.cell_parent[K] >= mesh.owned_cells;
  }
  EXPECT_EQ(levels.finest().comm.any(moved), levels.finest().comm.size() > 1);
}

class Hybrid : public ::testing::TestWithParam<Setting> {
 protected:
  method::MethodParams method() const { return params(GetParam().degree, GetParam().nodes); }
  /// Polynomials of the physical domain are none of the refined mesh's parameter domain where refinement moves vertices.
  bool nested() const { return GetParam().generator != Generator::disk; }

  mesh::Hierarchy levels = hierarchy(GetParam().generator, 1);
  const mesh::Mesh& mesh = levels.finest();
  const Polynomial u{GetParam().degree};
};

}  // namespace

TEST_P(Hybrid, stiffness_is_symmetric_and_constants_are_its_kernel_where_nothing_is_held) {
  const auto V = space(mesh, method(), false);
  for (const FieldPtr& tension : {scene::constant(2), scene::formula([](double x, double y) { return 2 + x * x + y; })}) {
    const auto S = method::assemble(*diffusion(*V, tension));
    Vector y(V->map()), z(V->map()), Sy(V->map()), Sz(V->map());
    S->apply(interpolated(*V, scene::constant(1)), y);
    EXPECT_LT(y.normInf(), 1e-11);
    y.randomize();
    z.randomize();
    S->apply(y, Sy);
    S->apply(z, Sz);
    EXPECT_NEAR(z.dot(Sy), y.dot(Sz), 1e-10 * std::abs(y.dot(Sy)));
    EXPECT_GT(y.dot(Sy), 0);
  }
}

TEST_P(Hybrid, patch_test) {
  for (const auto length : {StabilizationLength::face, StabilizationLength::cell}) {
    auto params = method();
    params.own.get<Params>().stabilization_length = length;
    const auto V = space(mesh, params, true);
    const Poisson poisson{*V, scene::constant(3), scene::formula([this](double x, double y) { return 3 * u.minus_laplacian(x, y); }),
                          everywhere(mesh, u.value())};
    const Vector computed = poisson.solution();
    const Vector exact = interpolated(*V, u.value());
    EXPECT_LT(distance(computed, exact), 1e-11 * exact.normInf());
    EXPECT_LT(poisson.error(computed, u.gradient()),
              1e-11 * std::sqrt(method::energy(*diffusion(*V, poisson.tension), V->complete(exact, poisson.lift))));
  }
}

TEST_P(Hybrid, condensation_changes_nothing) {
  const auto V = space(mesh, method(), true);
  EXPECT_EQ(V->interior(), (u.p + 1) * (u.p + 2) / 2);
  for (const FieldPtr& tension : {scene::constant(2), scene::formula([](double x, double y) { return 2 + x * x + y * y; })}) {
    const Poisson poisson{*V, tension, scene::formula([](double x, double y) { return std::sin(3 * x) + y; }), everywhere(mesh, u.value())};
    const Vector expected = poisson.solution();
    EXPECT_LT(distance(poisson.condensed_solution(), expected), 1e-11 * expected.normInf());
  }
}

TEST_P(Hybrid, forces_cell_by_cell_are_the_action_of_the_matrix) {
  const auto tension = scene::formula([](double x, double y) { return 2 + x * y / 4; });
  for (const bool held : {false, true}) {
    const auto V = space(mesh, method(), held);
    Vector w(V->map()), y(V->map()), Sw(V->map());
    w.randomize();
    method::apply(*diffusion(*V, tension), V->complete(w, V->lift(everywhere(mesh, held ? scene::constant(0) : nullptr), 0)), y);
    method::assemble(*diffusion(*V, tension))->apply(w, Sw);
    EXPECT_LT(distance(y, Sw), 1e-12 * Sw.normInf());
  }
}

TEST_P(Hybrid, lift_is_the_part_of_the_interpolant_that_is_held) {
  // all faces of the boundary, in every function: what the interpolant exerts is what unknowns and lift exert
  const auto V = space(mesh, method(), true), free = space(mesh, method(), false);
  const auto tension = scene::constant(1);
  Vector y(V->map()), y_free(free->map());
  method::apply(*diffusion(*V, tension), V->complete(interpolated(*V, u.value()), V->lift(everywhere(mesh, u.value()), 0)), y);
  method::apply(*diffusion(*free, tension), free->complete(interpolated(*free, u.value()), free->lift(everywhere(mesh, nullptr), 0)),
                y_free);
  const auto ids = V->unknown_ids(), free_ids = free->unknown_ids();
  const auto held = algebra::host_view(std::as_const(y)), all = algebra::host_view(std::as_const(y_free));
  std::size_t k = 0;
  for (std::size_t row = 0; row < ids.size(); ++row) {
    while (free_ids[k] != ids[row]) ++k;
    EXPECT_NEAR(held(row), all(k), 1e-11);
  }
}

TEST_P(Hybrid, contact_points_are_the_cells_functions) {
  const auto V = space(mesh, method(), true);
  const int n = (u.p + 1) * (u.p + 2) / 2;
  EXPECT_EQ(static_cast<GlobalIndex>(V->points()->getGlobalNumElements()), n * mesh.global_cells);
  EXPECT_EQ(algebra::local_size(*V->points()), n * mesh.owned_cells);
  Vector one(V->points());
  one.putScalar(1);
  EXPECT_EQ(distance(V->pairing(), one), 0);
}

TEST_P(Hybrid, identities_are_different_and_those_of_the_display_complete) {
  const auto V = space(mesh, method(), true);
  std::vector<double> seen(15 * mesh.global_cells + 4 * mesh.global_faces, 0.0);
  for (const GlobalIndex id : V->unknown_ids()) seen.at(id) += 1;
  mesh.comm.sum(seen);
  EXPECT_EQ(*std::max_element(seen.begin(), seen.end()), 1);
  const auto grid = V->display();
  std::vector<int> shown(grid.global_points, 0);
  for (std::size_t a = 0; a < grid.points.size(); ++a)
    if (grid.point_owner[a] == mesh.comm.rank()) shown.at(grid.point_id[a]) += 1;
  mesh.comm.sum(shown);
  EXPECT_EQ(*std::min_element(shown.begin(), shown.end()), 1);
  EXPECT_EQ(*std::max_element(shown.begin(), shown.end()), 1);
}

TEST_P(Hybrid, prolongation_is_exact) {
  for (const bool held : {false, true}) {
    const auto coarse = space(levels.levels[0], method(), held), fine = space(mesh, method(), held);
    const FieldPtr w = nested() ? u.value() : scene::constant(2);
    const auto coarse_w = coarse->complete(interpolated(*coarse, w), coarse->lift(everywhere(levels.levels[0], held ? w : nullptr), 0));
    Vector values(fine->map());
    method::Transfer(*coarse, *fine).prolongate(coarse_w, values);
    EXPECT_LT(distance(values, interpolated(*fine, w)), 1e-12);
  }
}

TEST_P(Hybrid, prolongation_is_exact_on_adaptive_levels) {
  adapt_around_a_cell(levels);
  const FieldPtr w = nested() ? u.value() : scene::constant(2);
  for (std::size_t j = 1; j < levels.levels.size(); ++j) {
    const auto coarse = space(levels.levels[j - 1], method(), true), fine = space(levels.levels[j], method(), true);
    Vector values(fine->map()), X3(coarse->points()), finer(fine->points()), expected(fine->points());
    method::Transfer(*coarse, *fine)
        .prolongate(coarse->complete(interpolated(*coarse, w), coarse->lift(everywhere(levels.levels[j - 1], w), 0)), values);
    EXPECT_LT(distance(values, interpolated(*fine, w)), 1e-12);
    coarse->interpolate_multiplier(*w, 0, X3);
    method::Transfer(*coarse, *fine).multiplier(X3, finer);
    fine->interpolate_multiplier(*w, 0, expected);
    if (nested()) {
      EXPECT_LT(distance(finer, expected), 1e-11);
    }
  }
}

TEST_P(Hybrid, patch_test_on_an_adaptive_mesh) {
  adapt_around_a_cell(levels);
  const auto V = space(levels.finest(), method(), true);
  const Polynomial w = u;
  const Poisson problem{*V, scene::constant(1), scene::formula([w](double x, double y) { return w.minus_laplacian(x, y); }),
                        everywhere(levels.finest(), w.value())};
  EXPECT_LT(distance(problem.condensed_solution(), interpolated(*V, w.value())), 1e-10);
}

TEST_P(Hybrid, a_multiplier_is_known_from_its_moments_and_goes_to_the_finer_mesh) {
  const auto coarse = space(levels.levels[0], method(), true), fine = space(mesh, method(), true);
  const FieldPtr lambda = nested() ? u.value() : scene::constant(2);
  Vector X3(coarse->points()), finer(fine->points()), expected(fine->points());
  coarse->interpolate_multiplier(*lambda, 0, X3);
  method::Transfer(*coarse, *fine).multiplier(X3, finer);
  fine->interpolate_multiplier(*lambda, 0, expected);
  if (nested()) {
    EXPECT_LT(distance(finer, expected), 1e-11);
  }
  const auto shown = coarse->shown(coarse->multiplier(X3));
  const auto grid = coarse->display();
  const Polynomial w = u;
  for (std::size_t a = 0; a < grid.points.size(); ++a)
    if (grid.point_owner[a] == mesh.comm.rank()) {
      EXPECT_NEAR(shown[a], nested() ? w(grid.points[a][0], grid.points[a][1]) : 2, 1e-10);
    }
}

TEST_P(Hybrid, energy_does_not_depend_on_the_ranks) {
  const auto alone_levels = hierarchy(GetParam().generator, 1, core::Comm(MPI_COMM_SELF));
  const auto tension = scene::formula([](double x, double y) { return 2 + x * x + y * y; });
  double energy[2];
  for (const bool alone : {false, true}) {
    const mesh::Mesh& on = alone ? alone_levels.finest() : mesh;
    const auto V = space(on, method(), true);
    const Poisson poisson{*V, tension, scene::formula([](double x, double y) { return std::sin(3 * x) + y; }), everywhere(on, u.value())};
    energy[alone ? 1 : 0] = method::energy(*diffusion(*V, tension), V->complete(poisson.condensed_solution(), poisson.lift));
  }
  EXPECT_NEAR(energy[0], energy[1], 1e-11 * energy[1]);
}

INSTANTIATE_TEST_SUITE_P(Hho, Hybrid, ::testing::ValuesIn(settings()), [](const auto& setting) { return name(setting.param); });

TEST(Unknowns, are_those_of_all_cells_and_of_the_faces_inside) {
  const auto levels = hierarchy(Generator::criss_cross, 2);
  const GlobalIndex published[4][3] = {{176, 736, 3008}, {352, 1472, 6016}, {528, 2208, 9024}, {704, 2944, 12032}};  // two fields, faces
  const GlobalIndex with_cells[4][3] = {{752, 3040, 12224}, {1504, 6080, 24448}, {2448, 9888, 39744}, {3584, 14464, 58112}};
  for (int p = 1; p <= 4; ++p)
    for (int level = 0; level <= 2; ++level) {
      const mesh::Mesh& mesh = levels.levels[level];
      const auto V = space(mesh, params(p), true);
      const GlobalIndex all = static_cast<GlobalIndex>(V->map()->getGlobalNumElements());
      const GlobalIndex points = static_cast<GlobalIndex>(V->points()->getGlobalNumElements());
      EXPECT_EQ(2 * (all - points), published[p - 1][level]);
      EXPECT_EQ(2 * all + points, with_cells[p - 1][level]);
      const contact::Condensation condensation(V->map(), V->graph()->getColMap(), V->elements(), V->interior(),
                                               contact::LocalForm::general);
      EXPECT_EQ(static_cast<GlobalIndex>(condensation.rows()->getGlobalNumElements()), all - points);
    }
}

TEST(Convergence, of_the_cells_polynomials_has_order_p) {
  const double pi = std::acos(-1.0);
  const method::Gradient exact = {scene::formula([pi](double x, double y) { return pi * std::cos(pi * x) * std::sin(pi * y); }),
                                  scene::formula([pi](double x, double y) { return pi * std::sin(pi * x) * std::cos(pi * y); })};
  const auto f = scene::formula([pi](double x, double y) { return 2 * pi * pi * std::sin(pi * x) * std::sin(pi * y); });
  const auto levels = hierarchy(Generator::criss_cross, 3);
  for (const auto length : {StabilizationLength::face, StabilizationLength::cell})
    for (int p = 1; p <= 4; ++p) {
      double error[2];
      for (int k = 0; k < 2; ++k) {
        const mesh::Mesh& mesh = levels.levels[2 + k];
        auto of_method = params(p);
        of_method.own.get<Params>().stabilization_length = length;
        const auto V = space(mesh, of_method, true);
        const Poisson poisson{*V, scene::constant(1), f, everywhere(mesh, scene::constant(0))};
        error[k] = poisson.error(poisson.condensed_solution(), exact);
      }
      EXPECT_NEAR(std::log2(error[0] / error[1]), p, 0.05) << "p = " << p;
    }
}

TEST(Traction, is_taken_on_the_faces) {
  const auto levels = hierarchy(Generator::rectangle, 1);  // (-1, 2) x (0.5, 2)
  const mesh::Mesh& mesh = levels.finest();
  for (int p = 1; p <= 4; ++p) {
    // held on the left, tractions mu du/dn elsewhere
    const Polynomial u{p};
    std::vector<bool> dirichlet(mesh.tags.size(), false);
    BoundaryValues boundary = everywhere(mesh, nullptr);
    for (std::size_t tag = 0; tag < mesh.tags.size(); ++tag) {
      const std::string& side = mesh.tags[tag];
      dirichlet[tag] = side == "left";
      if (side == "left") boundary.dirichlet[tag] = u.value();
      else
        boundary.neumann[tag] = scene::formula([u, side](double x, double y) {
          return 3 * (side == "right" ? u.dx(x, y) : side == "top" ? u.dy(x, y) : -u.dy(x, y));
        });
    }
    const auto V = make_space(mesh, {dirichlet, nullptr, params(p)});
    const Poisson poisson{*V, scene::constant(3), scene::formula([u](double x, double y) { return 3 * u.minus_laplacian(x, y); }),
                          boundary};
    const Vector computed = poisson.solution();
    EXPECT_LT(distance(computed, interpolated(*V, u.value())), 1e-11 * computed.normInf());
  }
}

}  // namespace thixis::hho
