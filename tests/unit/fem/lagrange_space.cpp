/// Continuous P1 on the meshes of all generators: everything that must hold exactly for affine functions.
#include "thixis/fem/lagrange_space.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "thixis/algebra/solver.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::fem {
namespace {

using algebra::Vector;
using mesh::Generator;
using method::BoundaryValues;
using method::Space;
using scene::FieldPtr;

/// u(x, y) = 2 + 3 x - y with gradient (3, -1).
FieldPtr affine() {
  return scene::formula([](double x, double y) { return 2 + 3 * x - y; });
}
constexpr double gradient_squared = 10;

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

std::unique_ptr<Space> space(const mesh::Mesh& mesh, bool held, const FieldPtr& level_set = nullptr) {
  return make_lagrange_space(mesh, {std::vector<bool>(mesh.tags.size(), held), level_set, {}});
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

class OnEachMesh : public ::testing::TestWithParam<Generator> {
 protected:
  mesh::Hierarchy levels = hierarchy(GetParam());
  const mesh::Mesh& mesh = levels.finest();
};

}  // namespace

TEST_P(OnEachMesh, stiffness_is_symmetric_and_its_rows_sum_to_zero_where_nothing_is_held) {
  const auto V = space(mesh, false);
  const auto S = V->stiffness(*scene::formula([](double x, double y) { return 2 + x * x + y; }));
  Vector one(V->map()), y(V->map()), z(V->map()), Sy(V->map()), Sz(V->map());
  one.putScalar(1);
  S->apply(one, y);
  EXPECT_LT(y.normInf(), 1e-12);
  y.randomize();
  z.randomize();
  S->apply(y, Sy);
  S->apply(z, Sz);
  EXPECT_NEAR(z.dot(Sy), y.dot(Sz), 1e-10 * std::abs(y.dot(Sy)));
  EXPECT_GT(y.dot(Sy), 0);
}

TEST_P(OnEachMesh, the_energy_of_an_affine_function_is_exact_in_the_matrix_and_cell_by_cell) {
  const auto V = space(mesh, false);
  const auto S = V->stiffness(*scene::constant(2));
  const Vector u = interpolated(*V, affine());
  Vector Su(V->map());
  S->apply(u, Su);
  const double energy = 2 * gradient_squared * area(mesh);
  EXPECT_NEAR(u.dot(Su), energy, 1e-11 * energy);
  const auto nothing_held = V->lift(everywhere(mesh, nullptr), 0);
  EXPECT_NEAR(V->energy(*scene::constant(2), V->complete(u, nothing_held)), energy, 1e-11 * energy);
}

TEST_P(OnEachMesh, an_affine_solution_is_reproduced) {
  for (const auto& tension : {scene::constant(3), scene::formula([](double x, double y) { return 2 + std::sin(x) + 0.1 * y; })}) {
    const auto V = space(mesh, true);
    const auto lift = V->lift(everywhere(mesh, affine()), 0);
    // div(mu grad u) is not zero for a varying tension: its load is the action of S on the interpolant, held vertices included
    const Vector exact = interpolated(*V, affine());
    Vector F(V->map()), rhs(V->map()), u(V->map());
    V->forces(*tension, V->complete(exact, lift), F);
    if (tension->constant()) {
      EXPECT_LT(F.normInf(), 1e-12);  // the patch test: an affine function is in equilibrium without forces
    }
    Vector held(V->map());
    V->forces(*tension, lift, held);
    rhs.update(1, F, -1, held, 0);
    algebra::LinearParams params;
    params.solver = algebra::SolverKind::direct;
    algebra::Solver solver(params);
    solver.set_matrix(V->stiffness(*tension), 1, V->coordinates());
    ASSERT_TRUE(solver.solve(rhs, u, {1e-10, 0, nullptr}).converged);
    EXPECT_LT(distance(u, exact), 1e-12);
    EXPECT_LT(V->energy_error(*tension, V->complete(u, lift), {scene::constant(3), scene::constant(-1)}, 0), 1e-20);
  }
}

TEST_P(OnEachMesh, the_energy_error_of_zero_is_the_energy_of_the_exact_solution) {
  const auto V = space(mesh, false);
  const Vector zero(V->map());
  const auto u = V->complete(zero, V->lift(everywhere(mesh, nullptr), 0));
  const double error = V->energy_error(*scene::constant(2), u, {scene::constant(3), scene::constant(-1)}, 0);
  EXPECT_NEAR(error, 2 * gradient_squared * area(mesh), 1e-11 * error);
}

TEST_P(OnEachMesh, the_load_of_a_constant_is_exact_in_cut_cells_too) {
  const auto cut = scene::formula([](double x, double y) { return std::hypot(x - 0.4, y - 0.7) - 0.31; });
  for (const auto& level_set : {FieldPtr(), cut}) {
    const auto V = space(mesh, true, level_set);
    Vector F(V->map());
    V->load(*scene::constant(3), everywhere(mesh, scene::constant(0)), 0, F);
    F.update(-3, V->pairing(), 1);
    EXPECT_LT(F.normInf(), 1e-14);
  }
}

TEST_P(OnEachMesh, the_pairing_sums_to_the_area_but_for_what_is_held) {
  EXPECT_NEAR(sum(space(mesh, false)->pairing()), area(mesh), 1e-12 * area(mesh));
  EXPECT_NEAR(sum(space(mesh, true)->pairing()), area(mesh) - share_of_the_boundary(mesh), 1e-12 * area(mesh));
}

TEST_P(OnEachMesh, forces_cell_by_cell_are_the_action_of_the_matrix) {
  for (const bool held : {false, true}) {
    const auto tension = scene::formula([](double x, double y) { return 2 + x * y / 4; });
    const auto V = space(mesh, held);
    Vector u(V->map()), y(V->map()), Su(V->map());
    u.randomize();
    V->forces(*tension, V->complete(u, V->lift(everywhere(mesh, held ? scene::constant(0) : nullptr), 0)), y);
    V->stiffness(*tension)->apply(u, Su);
    EXPECT_LT(distance(y, Su), 1e-12 * Su.normInf());
    EXPECT_NEAR(V->energy(*tension, V->complete(u, V->lift(everywhere(mesh, held ? scene::constant(0) : nullptr), 0))), u.dot(Su),
                1e-11 * u.dot(Su));
  }
}

TEST_P(OnEachMesh, complete_and_restrict_are_inverse) {
  const auto V = space(mesh, true);
  Vector u(V->map()), back(V->map());
  u.randomize();
  V->restrict_to_unknowns(V->complete(u, V->lift(everywhere(mesh, affine()), 0)), back);
  EXPECT_EQ(distance(u, back), 0);
}

TEST_P(OnEachMesh, prolongation_is_exact_for_affine_functions_of_the_parameter_domain) {
  for (const bool held : {false, true})
    for (std::size_t level = 1; level < levels.levels.size(); ++level) {
      const auto coarse = space(levels.levels[level - 1], held), fine = space(levels.levels[level], held);
      // where refinement moves vertices (disk), only functions that are affine along each edge of the hexagon are: take constants there
      const FieldPtr u = GetParam() == Generator::disk ? scene::constant(2) : affine();
      const auto coarse_u =
          coarse->complete(interpolated(*coarse, u), coarse->lift(everywhere(levels.levels[level - 1], held ? u : nullptr), 0));
      Vector values(fine->map());
      fine->prolongate(*coarse, coarse_u, values);
      EXPECT_LT(distance(values, interpolated(*fine, u)), 1e-13) << "level " << level;
    }
}

std::string generator_name(const ::testing::TestParamInfo<Generator>& info) {
  const char* const names[] = {"criss_cross", "rectangle", "disk", "gmsh"};
  return names[static_cast<int>(info.param)];
}
INSTANTIATE_TEST_SUITE_P(Fem, OnEachMesh, ::testing::Values(Generator::criss_cross, Generator::rectangle, Generator::disk, Generator::file),
                         generator_name);

TEST(Traction, sums_to_force_and_moment_of_a_linear_one) {
  const auto levels = hierarchy(Generator::rectangle);  // (-1, 2) x (0.5, 2)
  const mesh::Mesh& mesh = levels.finest();
  const auto V = space(mesh, false);
  auto boundary = everywhere(mesh, nullptr);
  const auto right = std::find(mesh.tags.begin(), mesh.tags.end(), "right") - mesh.tags.begin();
  boundary.neumann[right] = scene::formula([](double, double y) { return 1 + 2 * y; });
  Vector F(V->map());
  V->load(*scene::constant(0), boundary, 0, F);
  EXPECT_NEAR(sum(F), 1.5 + (4 - 0.25), 1e-13);  // the integral of 1 + 2 y
  const Vector y = interpolated(*V, scene::formula([](double, double py) { return py; }));
  EXPECT_NEAR(F.dot(y), (4 - 0.25) / 2 + 2 * (8 - 0.125) / 3, 1e-12);
  const Vector x = interpolated(*V, scene::formula([](double px, double) { return px - 2; }));
  EXPECT_NEAR(F.dot(x), 0, 1e-13);  // nothing off the edge
}

TEST(Lift, at_a_vertex_between_two_held_parts_is_the_value_of_the_part_listed_first) {
  const auto levels = hierarchy(Generator::criss_cross);
  const mesh::Mesh& mesh = levels.finest();
  const auto V = space(mesh, true);
  BoundaryValues boundary = everywhere(mesh, nullptr);
  for (std::size_t tag = 0; tag < mesh.tags.size(); ++tag) boundary.dirichlet[tag] = scene::constant(static_cast<double>(tag + 1));
  const auto values = V->at_vertices(V->lift(boundary, 0));
  const auto host = mesh::on_host(mesh);
  for (LocalIndex v = 0; v < mesh.vertices; ++v) {
    const double x = host.coordinates(v, 0), y = host.coordinates(v, 1);
    if (mesh.vertex_owner[v] != mesh.comm.rank()) continue;
    const double expected = x == 0 ? 1 : x == 1 ? 2 : y == 0 ? 3 : y == 1 ? 4 : 0;  // left, right, bottom, top
    EXPECT_EQ(values[v], expected) << x << ", " << y;
  }
}

TEST(Tension, that_is_not_positive_in_some_cell_is_refused_on_all_ranks) {
  const auto levels = hierarchy(Generator::criss_cross);
  const auto V = space(levels.finest(), true);
  EXPECT_THROW(V->stiffness(*scene::formula([](double x, double y) { return x + y - 0.1; })), core::InputError);
}

}  // namespace thixis::fem
