/// Continuous P1 to P4 on the meshes of all generators: everything that must hold exactly for polynomials of their degree.
#include "thixis/fem/lagrange_space.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "thixis/algebra/solver.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"
#include "thixis/fem/forms.hpp"
#include "thixis/mesh/adapt.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/method/measures.hpp"
#include "thixis/method/transfer.hpp"

namespace thixis::fem {
namespace {

using algebra::Vector;
using mesh::Generator;
using method::BoundaryValues;
using method::Nodes;
using method::Space;
using scene::FieldPtr;

mesh::Hierarchy hierarchy(Generator generator, int refinements = 2) {
  mesh::MeshParams params;
  params.generator = generator;
  params.refinements = refinements;
  params.cells_per_rank = 20;
  if (generator == Generator::rectangle) params.lower = {-1, 0.5}, params.upper = {2, 2};
  if (generator == Generator::disk) params.rings = 3;
  if (generator == Generator::file) params.file = "l_shape_22.msh";
  return mesh::build(params, core::Comm(), MESH_FILES);
}

/// The same condition on all of the boundary.
BoundaryValues everywhere(const mesh::Mesh& mesh, const FieldPtr& dirichlet, const FieldPtr& neumann = nullptr) {
  return {std::vector<FieldPtr>(mesh.tags.size(), dirichlet), std::vector<FieldPtr>(mesh.tags.size(), neumann)};
}

double area(const mesh::Mesh& mesh) {
  const auto host = mesh::on_host(mesh);
  double sum = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) sum += mesh::cell_area(host.coordinates, host.cell_vertices, K);
  return mesh.comm.sum(sum);
}

/// (1, sum of psi_a over the vertices of the boundary).
double share_of_the_boundary(const mesh::Mesh& mesh) {
  const auto host = mesh::on_host(mesh);
  std::vector<bool> on_boundary(mesh.vertices, false);
  for (LocalIndex F = 0; F < mesh.faces; ++F)
    for (int i = 0; i < 2 && host.face_tag(F) >= 0; ++i) on_boundary[host.face_vertices(F, i)] = true;
  double sum = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int i = 0; i < 3; ++i)
      if (on_boundary[host.cell_vertices(K, i)]) sum += mesh::cell_area(host.coordinates, host.cell_vertices, K) / 3;
  return mesh.comm.sum(sum);
}

double sum(const Vector& v) { return v.meanValue() * static_cast<double>(v.getGlobalLength()); }

double distance(const Vector& v, const Vector& w) {
  Vector d(v, Teuchos::Copy);
  d.update(-1, w, 1);
  return d.normInf();
}

Vector interpolated(const Space& space, const FieldPtr& u) {
  Vector values(space.map());
  space.interpolate(*u, 0, values);
  return values;
}

struct Setting {
  Generator generator;
  int degree;
  Nodes nodes;
};

/// u = (0.3 + x - y/2)^p + x - y and -Lap u.
struct Polynomial {
  int p;
  static double inner(double x, double y) { return 0.3 + x - 0.5 * y; }
  FieldPtr value() const {
    return scene::formula([p = p](double x, double y) { return std::pow(inner(x, y), p) + x - y; });
  }
  method::Gradient gradient() const {
    return {scene::formula([p = p](double x, double y) { return p * std::pow(inner(x, y), p - 1) + 1; }),
            scene::formula([p = p](double x, double y) { return -0.5 * p * std::pow(inner(x, y), p - 1) - 1; })};
  }
  FieldPtr minus_laplacian() const {
    return scene::formula([p = p](double x, double y) { return p < 2 ? 0.0 : -1.25 * p * (p - 1) * std::pow(inner(x, y), p - 2); });
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

class Lagrange : public ::testing::TestWithParam<Setting> {
 protected:
  std::unique_ptr<Space> space(const mesh::Mesh& mesh_, bool held, const FieldPtr& level_set = nullptr) const {
    method::MethodParams params;
    params.degree = GetParam().degree;
    params.nodes = GetParam().nodes;
    return make_lagrange_space(mesh_, {std::vector<bool>(mesh_.tags.size(), held), level_set, params});
  }
  /// Polynomials of the physical domain are none of the refined mesh's parameter domain where refinement moves vertices.
  bool nested() const { return GetParam().generator != Generator::disk; }

  mesh::Hierarchy levels = hierarchy(GetParam().generator, 1);
  const mesh::Mesh& mesh = levels.finest();
  const Polynomial u{GetParam().degree};
};

Vector solved(const Space& V, const FieldPtr& tension, Vector rhs) {
  Vector u(V.map());
  algebra::LinearParams params;
  params.solver = algebra::SolverKind::direct;
  algebra::Solver solver(params);
  solver.set_matrix(method::assemble(*diffusion(V, tension)), 1, {V.coordinates(), {}});
  EXPECT_TRUE(solver.solve(rhs, u, {1e-13 * rhs.norm2(), 0, nullptr}).residual < 1e-10 * rhs.norm2());
  return u;
}

}  // namespace

TEST_P(Lagrange, has_the_mass_of_its_functions_in_the_cells) {
  const auto affine = scene::formula([](double x, double y) { return 1 + x - 2 * y; });
  const auto free = space(mesh, false);
  Vector values(free->map()), moments(free->map()), expected(free->map()), product(free->map());
  free->interpolate(*affine, 0, values);
  const auto w = free->complete(values, method::Coefficients("nothing", free->lift(everywhere(mesh, scene::constant(0)), 0).extent(0)));
  method::apply(*method::mass(*free), w, moments);
  method::load(*diffusion(*free, scene::constant(1)), *affine, everywhere(mesh, nullptr, scene::constant(0)), 0, expected);
  EXPECT_GT(expected.normInf(), 1e-3);
  EXPECT_LE(distance(moments, expected), 1e-12);
  method::assemble(*method::mass(*free))->apply(values, product);
  EXPECT_LE(distance(moments, product), 1e-12);
  EXPECT_NEAR(method::l2_error(*free, w, affine, 0), 0, 1e-20);
  EXPECT_NEAR(method::l2_error(*free, w, scene::formula([](double x, double y) { return 4 + x - 2 * y; }), 0), 9 * area(mesh), 1e-9);
}

TEST_P(Lagrange, stiffness_is_symmetric_and_its_rows_sum_to_zero_where_nothing_is_held) {
  const auto V = space(mesh, false);
  const auto S = method::assemble(*diffusion(*V, scene::formula([](double x, double y) { return 2 + x * x + y; })));
  Vector one(V->map()), y(V->map()), z(V->map()), Sy(V->map()), Sz(V->map());
  one.putScalar(1);  // both families sum to 1
  S->apply(one, y);
  EXPECT_LT(y.normInf(), 1e-11);
  y.randomize();
  z.randomize();
  S->apply(y, Sy);
  S->apply(z, Sz);
  EXPECT_NEAR(z.dot(Sy), y.dot(Sz), 1e-10 * std::abs(y.dot(Sy)));
  EXPECT_GT(y.dot(Sy), 0);
}

TEST_P(Lagrange, patch_test) {
  const auto V = space(mesh, true);
  const auto boundary = everywhere(mesh, u.value());
  const auto lift = V->lift(boundary, 0);
  Vector F(V->map()), held(V->map());
  const auto tension = scene::constant(3);
  method::load(*diffusion(*V, tension), *scene::formula([this](double x, double y) {
    return 3 * (u.p < 2 ? 0 : -1.25 * u.p * (u.p - 1) * std::pow(u.inner(x, y), u.p - 2));
  }),
               boundary, 0, F);
  method::apply(*diffusion(*V, tension), lift, held);
  F.update(-1, held, 1);
  const Vector computed = solved(*V, tension, F);
  EXPECT_LT(distance(computed, interpolated(*V, u.value())), 1e-11);
  EXPECT_LT(std::sqrt(method::energy_error(*diffusion(*V, tension), V->complete(computed, lift), {method::Known{u.gradient()}}, 0)), 1e-11);
}

TEST_P(Lagrange, the_energy_error_of_zero_is_the_energy_of_the_exact_solution) {
  const auto V = space(mesh, false);
  const auto nothing_held = V->lift(everywhere(mesh, nullptr), 0);
  const double error = method::energy_error(*diffusion(*V, scene::constant(2)), V->complete(Vector(V->map()), nothing_held),
                                            {method::Known{u.gradient()}}, 0);
  const double energy = method::energy(*diffusion(*V, scene::constant(2)), V->complete(interpolated(*V, u.value()), nothing_held));
  EXPECT_GT(energy, 0.1 * area(mesh));
  EXPECT_NEAR(error, energy, 1e-11 * energy);
}

TEST_P(Lagrange, loads_of_a_constant_are_the_integrals_of_the_basis_in_cut_cells_too) {
  const auto cut = scene::formula([](double x, double y) { return std::hypot(x - 0.4, y - 0.7) - 0.31; });
  const auto V = space(mesh, false), V_cut = space(mesh, false, cut);
  Vector F(V->map()), F_cut(V->map());
  method::load(*diffusion(*V, scene::constant(1)), *scene::constant(3), everywhere(mesh, nullptr), 0, F);
  method::load(*diffusion(*V_cut, scene::constant(1)), *scene::constant(3), everywhere(mesh, nullptr), 0, F_cut);
  EXPECT_NEAR(sum(F), 3 * area(mesh), 1e-12 * area(mesh));
  EXPECT_LT(distance(F, F_cut), 1e-13);
}

TEST_P(Lagrange, no_gauss_lobatto_or_bernstein_function_has_a_negative_mean) {
  if (GetParam().nodes == Nodes::equispaced) return;
  const auto V = space(mesh, false);
  Vector F(V->map());
  method::load(*diffusion(*V, scene::constant(1)), *scene::constant(1), everywhere(mesh, nullptr), 0, F);
  const auto values = algebra::host_view(std::as_const(F));
  for (std::size_t l = 0; l < values.extent(0); ++l) EXPECT_GE(values(l), -1e-16);
}

TEST_P(Lagrange, pairing_is_the_lumped_mass_of_degree_1_and_the_identity_beyond) {
  const auto V = space(mesh, false);
  EXPECT_EQ(V->nodal_multiplier(), u.p == 1);
  if (u.p == 1) {
    EXPECT_NEAR(sum(V->pairing()), area(mesh), 1e-12 * area(mesh));
    EXPECT_NEAR(sum(space(mesh, true)->pairing()), area(mesh) - share_of_the_boundary(mesh), 1e-12 * area(mesh));
  } else {
    Vector one(V->points());
    one.putScalar(1);
    EXPECT_EQ(distance(V->pairing(), one), 0);
  }
}

TEST_P(Lagrange, forces_cell_by_cell_are_the_action_of_the_matrix) {
  for (const bool held : {false, true}) {
    const auto tension = scene::formula([](double x, double y) { return 2 + x * y / 4; });
    const auto V = space(mesh, held);
    Vector w(V->map()), y(V->map()), Sw(V->map());
    w.randomize();
    const auto all = V->complete(w, V->lift(everywhere(mesh, held ? scene::constant(0) : nullptr), 0));
    method::apply(*diffusion(*V, tension), all, y);
    method::assemble(*diffusion(*V, tension))->apply(w, Sw);
    EXPECT_LT(distance(y, Sw), 1e-12 * Sw.normInf());
    EXPECT_NEAR(method::energy(*diffusion(*V, tension), all), w.dot(Sw), 1e-11 * w.dot(Sw));
  }
}

TEST_P(Lagrange, complete_and_restrict_are_inverse) {
  const auto V = space(mesh, true);
  Vector w(V->map()), back(V->map());
  w.randomize();
  V->restrict_to_unknowns(V->complete(w, V->lift(everywhere(mesh, u.value()), 0)), back);
  EXPECT_EQ(distance(w, back), 0);
}

TEST_P(Lagrange, identities_are_different_and_those_of_the_display_complete) {
  const auto V = space(mesh, true);
  const auto ids = V->unknown_ids();
  std::vector<double> seen(3 * mesh.global_cells * 16 + mesh.global_vertices, 0.0);
  for (const GlobalIndex id : ids) seen.at(id) += 1;
  mesh.comm.sum(seen);
  EXPECT_EQ(*std::max_element(seen.begin(), seen.end()), 1);
  const auto grid = V->display();
  std::vector<int> shown(grid.global_points, 0);
  for (std::size_t a = 0; a < grid.points.size(); ++a)
    if (grid.point_owner[a] == mesh.comm.rank()) shown.at(grid.point_id[a]) += 1;
  mesh.comm.sum(shown);
  EXPECT_EQ(*std::min_element(shown.begin(), shown.end()), 1);
  EXPECT_EQ(*std::max_element(shown.begin(), shown.end()), 1);
  EXPECT_EQ(mesh.comm.sum(static_cast<long long>(grid.triangles.size())), u.p * u.p * mesh.global_cells);
}

TEST_P(Lagrange, what_is_shown_are_the_values_at_the_points_of_the_display) {
  const auto V = space(mesh, false);
  const auto grid = V->display();
  const auto values = V->shown(V->complete(interpolated(*V, u.value()), V->lift(everywhere(mesh, nullptr), 0)));
  for (std::size_t a = 0; a < grid.points.size(); ++a) {
    if (grid.point_owner[a] != mesh.comm.rank()) continue;
    const double x = grid.points[a][0], y = grid.points[a][1];
    EXPECT_NEAR(values[a], std::pow(Polynomial::inner(x, y), u.p) + x - y, 1e-12);
  }
}

TEST_P(Lagrange, prolongation_is_exact) {
  for (const bool held : {false, true}) {
    const auto coarse = space(levels.levels[0], held), fine = space(mesh, held);
    const FieldPtr w = nested() ? u.value() : scene::constant(2);
    const auto coarse_w = coarse->complete(interpolated(*coarse, w), coarse->lift(everywhere(levels.levels[0], held ? w : nullptr), 0));
    Vector values(fine->map());
    method::Transfer(*coarse, *fine).prolongate(coarse_w, values);
    EXPECT_LT(distance(values, interpolated(*fine, w)), 1e-12);
  }
}

TEST_P(Lagrange, prolongation_is_exact_on_adaptive_levels) {
  adapt_around_a_cell(levels);
  const FieldPtr w = nested() ? u.value() : scene::constant(2);
  for (std::size_t j = 1; j < levels.levels.size(); ++j)
    for (const bool held : {false, true}) {
      const auto coarse = space(levels.levels[j - 1], held), fine = space(levels.levels[j], held);
      const auto lift = coarse->lift(everywhere(levels.levels[j - 1], held ? w : nullptr), 0);
      Vector values(fine->map()), X3(coarse->points()), finer(fine->points()), expected(fine->points());
      method::Transfer(*coarse, *fine).prolongate(coarse->complete(interpolated(*coarse, w), lift), values);
      EXPECT_LT(distance(values, interpolated(*fine, w)), 1e-12);
      if (held) continue;
      coarse->interpolate_multiplier(*w, 0, X3);
      method::Transfer(*coarse, *fine).multiplier(X3, finer);
      fine->interpolate_multiplier(*w, 0, expected);
      if (nested() || u.p == 1) {
        EXPECT_LT(distance(finer, expected), 1e-11);
      }
    }
}

TEST_P(Lagrange, patch_test_on_an_adaptive_mesh) {
  adapt_around_a_cell(levels);
  const mesh::Mesh& finest = levels.finest();
  const auto V = space(finest, true);
  const auto boundary = everywhere(finest, u.value());
  Vector F(V->map()), held(V->map());
  method::load(*diffusion(*V, scene::constant(1)), *u.minus_laplacian(), boundary, 0, F);
  method::apply(*diffusion(*V, scene::constant(1)), V->lift(boundary, 0), held);
  F.update(-1, held, 1);
  EXPECT_LT(distance(solved(*V, scene::constant(1), F), interpolated(*V, u.value())), 1e-10);
}

TEST_P(Lagrange, a_multiplier_is_known_from_its_moments_and_goes_to_the_finer_mesh) {
  const auto coarse = space(levels.levels[0], false), fine = space(mesh, false);
  const FieldPtr lambda = nested() ? u.value() : scene::constant(2);
  Vector X3(coarse->points()), finer(fine->points()), expected(fine->points()), back(coarse->map());
  coarse->interpolate_multiplier(*lambda, 0, X3);
  coarse->restrict_to_unknowns(coarse->multiplier(X3), back);
  EXPECT_LT(distance(back, interpolated(*coarse, lambda)), 1e-10);
  method::Transfer(*coarse, *fine).multiplier(X3, finer);
  fine->interpolate_multiplier(*lambda, 0, expected);
  if (nested() || u.p == 1) {
    EXPECT_LT(distance(finer, expected), 1e-11);
  }
}

TEST_P(Lagrange, penetration_is_the_depth_below_the_obstacle_also_between_the_nodes) {
  if (u.p < 2) return;
  const auto V = space(mesh, false);
  const auto w = scene::formula([](double x, double y) { return std::pow(x + 0.7 * y - 0.613, 2) - 0.01; });  // -0.01 along a line
  const auto all = V->complete(interpolated(*V, w), V->lift(everywhere(mesh, nullptr), 0));
  EXPECT_NEAR(method::penetration(*V, all, nullptr, 0), 0.01, 1e-4);
  EXPECT_NEAR(method::penetration(*V, all, scene::constant(0.005).get(), 0), 0.015, 1e-4);
  EXPECT_EQ(method::penetration(*V, all, scene::constant(-0.02).get(), 0), 0);
}

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const auto generator : {Generator::criss_cross, Generator::rectangle, Generator::disk, Generator::file})
    for (int p = 1; p <= 4; ++p)
      for (const auto nodes : {Nodes::gauss_lobatto, Nodes::equispaced, Nodes::bernstein})
        if (p > 1 || nodes == Nodes::gauss_lobatto) all.push_back({generator, p, nodes});
  return all;
}
std::string setting_name(const ::testing::TestParamInfo<Setting>& info) {
  const char* const generators[] = {"criss_cross", "rectangle", "disk", "gmsh"};
  const char* const nodes[] = {"gauss_lobatto", "equispaced", "bernstein"};
  return std::string(generators[static_cast<int>(info.param.generator)]) + "_P" + std::to_string(info.param.degree) + "_" +
         nodes[static_cast<int>(info.param.nodes)];
}
INSTANTIATE_TEST_SUITE_P(Fem, Lagrange, ::testing::ValuesIn(settings()), setting_name);

namespace {

std::unique_ptr<Space> space_of_degree(const mesh::Mesh& mesh, int degree, bool held) {
  method::MethodParams params;
  params.degree = degree;
  return make_lagrange_space(mesh, {std::vector<bool>(mesh.tags.size(), held), nullptr, params});
}

}  // namespace

TEST(Poisson, converges_with_order_p) {
  const double pi = std::acos(-1.0);
  const method::Gradient exact = {scene::formula([pi](double x, double y) { return pi * std::cos(pi * x) * std::sin(pi * y); }),
                                  scene::formula([pi](double x, double y) { return pi * std::sin(pi * x) * std::cos(pi * y); })};
  const auto f = scene::formula([pi](double x, double y) { return 2 * pi * pi * std::sin(pi * x) * std::sin(pi * y); });
  const auto levels = hierarchy(Generator::criss_cross, 3);
  for (int p = 1; p <= 4; ++p) {
    double error[2];
    for (int k = 0; k < 2; ++k) {
      const mesh::Mesh& mesh = levels.levels[2 + k];
      const auto V = space_of_degree(mesh, p, true);
      Vector F(V->map());
      method::load(*diffusion(*V, scene::constant(1)), *f, everywhere(mesh, scene::constant(0)), 0, F);
      const auto u = V->complete(solved(*V, scene::constant(1), F), V->lift(everywhere(mesh, scene::constant(0)), 0));
      error[k] = std::sqrt(method::energy_error(*diffusion(*V, scene::constant(1)), u, {method::Known{exact}}, 0));
    }
    EXPECT_NEAR(std::log2(error[0] / error[1]), p, 0.05) << "p = " << p;
  }
}

TEST(Traction, sums_to_force_and_moment_of_a_linear_one) {
  const auto levels = hierarchy(Generator::rectangle);  // (-1, 2) x (0.5, 2)
  const mesh::Mesh& mesh = levels.finest();
  for (int p = 1; p <= 4; ++p) {
    const auto V = space_of_degree(mesh, p, false);
    auto boundary = everywhere(mesh, nullptr);
    const auto right = std::find(mesh.tags.begin(), mesh.tags.end(), "right") - mesh.tags.begin();
    boundary.neumann[right] = scene::formula([](double, double y) { return 1 + 2 * y; });
    Vector F(V->map());
    method::load(*diffusion(*V, scene::constant(1)), *scene::constant(0), boundary, 0, F);
    EXPECT_NEAR(sum(F), 1.5 + (4 - 0.25), 1e-13);  // the integral of 1 + 2 y
    const Vector y = interpolated(*V, scene::formula([](double, double py) { return py; }));
    EXPECT_NEAR(F.dot(y), (4 - 0.25) / 2 + 2 * (8 - 0.125) / 3, 1e-12);
    const Vector x = interpolated(*V, scene::formula([](double px, double) { return px - 2; }));
    EXPECT_NEAR(F.dot(x), 0, 1e-13);  // nothing off the edge
  }
}

TEST(Lift, at_a_vertex_between_two_held_parts_is_the_value_of_the_part_listed_first) {
  const auto levels = hierarchy(Generator::criss_cross);
  const mesh::Mesh& mesh = levels.finest();
  const auto V = space_of_degree(mesh, 1, true);
  BoundaryValues boundary = everywhere(mesh, nullptr);
  for (std::size_t tag = 0; tag < mesh.tags.size(); ++tag) boundary.dirichlet[tag] = scene::constant(static_cast<double>(tag + 1));
  const auto values = V->shown(V->lift(boundary, 0));
  const auto grid = V->display();
  for (std::size_t a = 0; a < grid.points.size(); ++a) {
    if (grid.point_owner[a] != mesh.comm.rank()) continue;
    const double x = grid.points[a][0], y = grid.points[a][1];
    const double expected = x == 0 ? 1 : x == 1 ? 2 : y == 0 ? 3 : y == 1 ? 4 : 0;  // left, right, bottom, top
    EXPECT_EQ(values[a], expected) << x << ", " << y;
  }
}

TEST(Tension, that_is_not_positive_in_some_cell_is_refused_on_all_ranks) {
  const auto levels = hierarchy(Generator::criss_cross);
  const auto V = space_of_degree(levels.finest(), 2, true);
  EXPECT_THROW(method::assemble(*diffusion(*V, scene::formula([](double x, double y) { return x + y - 0.1; }))), core::InputError);
}

}  // namespace thixis::fem
