/// Elasticity on Lagrange elements of two components: patch tests, rigid motions, energies, orders.
#include <gtest/gtest.h>

#include <cmath>

#include "thixis/algebra/solver.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"
#include "thixis/fem/forms.hpp"
#include "thixis/fem/lagrange_space.hpp"
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
using Displacement = std::vector<FieldPtr>;

mesh::Hierarchy hierarchy(Generator generator, int refinements) {
  mesh::MeshParams params;
  params.generator = generator;
  params.refinements = refinements;
  params.cells_per_rank = 20;
  if (generator == Generator::rectangle) params.lower = {-1, 0.5}, params.upper = {2, 2};
  if (generator == Generator::file) params.file = "l_shape_22.msh";
  return mesh::build(params, core::Comm(), MESH_FILES);
}

std::unique_ptr<Space> space(const mesh::Mesh& mesh, int degree, const std::vector<bool>& held) {
  method::SpaceOptions options;
  options.params.degree = degree;
  options.components = 2;
  options.dirichlet = held;
  return make_lagrange_space(mesh, options);
}
std::unique_ptr<Space> space(const mesh::Mesh& mesh, int degree, bool held) {
  return space(mesh, degree, std::vector<bool>(2 * mesh.tags.size(), held));
}

/// Displacements on all of the boundary.
BoundaryValues displaced(const mesh::Mesh& mesh, const Displacement& u) {
  BoundaryValues boundary;
  for (std::size_t tag = 0; tag < mesh.tags.size(); ++tag) {
    boundary.dirichlet.insert(boundary.dirichlet.end(), u.begin(), u.end());
    boundary.neumann.insert(boundary.neumann.end(), 2, nullptr);
  }
  return boundary;
}

Displacement nothing() { return {scene::constant(0), scene::constant(0)}; }

Vector interpolated(const Space& V, const Displacement& u) {
  Vector values(V.map());
  V.interpolate(u, 0, values);
  return values;
}

double distance(const Vector& v, const Vector& w) {
  Vector d(v, Teuchos::Copy);
  d.update(-1, w, 1);
  return d.normInf();
}

Vector solved(const method::Form& form, const Displacement& force, const BoundaryValues& boundary) {
  const Space& V = form.space();
  Vector F(V.map()), held(V.map()), u(V.map());
  method::load(form, force, boundary, 0, F);
  method::apply(form, V.lift(boundary, 0), held);
  F.update(-1, held, 1);
  algebra::LinearParams params;
  params.solver = algebra::SolverKind::direct;
  algebra::Solver solver(params);
  solver.set_matrix(method::assemble(form), 1);
  const double size = F.norm2();
  EXPECT_LE(solver.solve(F, u, {1e-13 * size, 0, nullptr}).residual, 1e-10 * size);
  return u;
}

/// u = (1 + 2x - 3y, 4x + 5y - 6)/10: strains 0.2, 0.5, 0.05.
Displacement linear() {
  return {scene::formula([](double x, double y) { return 0.1 + 0.2 * x - 0.3 * y; }),
          scene::formula([](double x, double y) { return 0.4 * x + 0.5 * y - 0.6; })};
}

constexpr double mu = 1.5, lambda = 4;
method::FormPtr elastic(const Space& V) { return elasticity(V, scene::constant(mu), scene::constant(lambda)); }

/// c (0.3 + x - y/2)^p, c = (1, 2), and -div sigma of it.
struct Polynomial {
  int p;
  static double inner(double x, double y) { return 0.3 + x - 0.5 * y; }
  Displacement value() const {
    return {scene::formula([p = p](double x, double y) { return std::pow(inner(x, y), p); }),
            scene::formula([p = p](double x, double y) { return 2 * std::pow(inner(x, y), p); })};
  }
  Displacement force() const {
    const auto second = [p = p](double x, double y) { return p < 2 ? 0 : p * (p - 1) * std::pow(inner(x, y), p - 2); };
    // c·(1, -1/2) = 0: no volume changes; and the Laplacian of the inner function squared is 5/4
    return {scene::formula([second](double x, double y) { return -mu * 1.25 * second(x, y); }),
            scene::formula([second](double x, double y) { return -mu * 2.5 * second(x, y); })};
  }
};

}  // namespace

TEST(Elasticity, reproduces_linear_displacements) {
  for (const Generator generator : {Generator::file, Generator::disk, Generator::criss_cross}) {
    const auto levels = hierarchy(generator, 1);
    for (int p = 1; p <= 4; ++p) {
      const auto V = space(levels.finest(), p, true);
      const auto computed = solved(*elastic(*V), nothing(), displaced(levels.finest(), linear()));
      EXPECT_LE(distance(computed, interpolated(*V, linear())), 1e-12) << p;
    }
  }
}

TEST(Elasticity, reproduces_polynomials_of_degree_p) {
  const auto levels = hierarchy(Generator::file, 1);
  for (int p = 2; p <= 4; ++p) {
    const Polynomial u{p};
    const auto V = space(levels.finest(), p, true);
    const auto computed = solved(*elastic(*V), u.force(), displaced(levels.finest(), u.value()));
    EXPECT_LE(distance(computed, interpolated(*V, u.value())), 1e-10) << p;
  }
}

/// Each side holds some directions of the linear displacement and has tractions sigma n in the others.
TEST(Elasticity, takes_displacements_and_tractions_direction_by_direction) {
  const auto levels = hierarchy(Generator::rectangle, 1);
  const mesh::Mesh& mesh = levels.finest();
  const auto host = mesh::on_host(mesh);
  const double eps[2][2] = {{0.2, 0.05}, {0.05, 0.5}}, volume = 0.7;
  std::vector<double> normal(2 * mesh.tags.size(), 0);
  for (LocalIndex F = 0; F < mesh.faces; ++F) {
    const LocalIndex tag = host.face_tag(F);
    if (tag < 0 || mesh::first_cell(host.face_cells, F) >= mesh.owned_cells) continue;
    const auto face = mesh::face_geometry(host.coordinates, host.face_vertices, F);
    const int sign = mesh::normal_sign(host.face_cells, F, mesh::first_cell(host.face_cells, F));
    for (int d = 0; d < 2; ++d) normal[2 * tag + d] = sign * face.normal[d];
  }
  std::vector<double> least = normal, most = normal;
  for (double& value : least) value = mesh.comm.min(value);
  for (double& value : most) value = mesh.comm.max(value);
  std::vector<bool> held;
  BoundaryValues boundary;
  for (std::size_t tag = 0; tag < mesh.tags.size(); ++tag) {
    double n[2];
    for (int d = 0; d < 2; ++d) n[d] = most[2 * tag + d] > -least[2 * tag + d] ? most[2 * tag + d] : least[2 * tag + d];
    for (int i = 0; i < 2; ++i) {
      const double traction = 2 * mu * (eps[i][0] * n[0] + eps[i][1] * n[1]) + lambda * volume * n[i];
      held.push_back((tag + i) % 2 == 0);
      boundary.dirichlet.push_back(held.back() ? linear()[i] : nullptr);
      boundary.neumann.push_back(held.back() ? nullptr : scene::constant(traction));
    }
  }
  for (int p = 1; p <= 4; ++p) {
    const auto V = space(mesh, p, held);
    EXPECT_LE(distance(solved(*elastic(*V), nothing(), boundary), interpolated(*V, linear())), 1e-12) << p;
  }
}

TEST(Elasticity, rigid_motions_have_no_energy_and_exert_no_force) {
  const auto levels = hierarchy(Generator::file, 1);
  const Displacement rigid = {scene::formula([](double, double y) { return 0.5 - 3 * y; }),
                              scene::formula([](double x, double) { return 2 + 3 * x; })};
  const Displacement shear = {scene::formula([](double, double y) { return 3 * y; }), scene::constant(0)};
  double area = 0;
  for (int p = 1; p <= 4; ++p) {
    const auto V = space(levels.finest(), p, false);
    const auto form = elastic(*V);
    const method::Coefficients zero("zero", V->coefficients().entries.size());
    const auto u = V->complete(interpolated(*V, rigid), zero), sheared = V->complete(interpolated(*V, shear), zero);
    Vector force(V->map()), of_shear(V->map());
    method::apply(*form, u, force);
    method::apply(*form, sheared, of_shear);
    EXPECT_LE(method::energy(*form, u), 1e-20) << p;
    EXPECT_LE(force.normInf(), 1e-11 * of_shear.normInf()) << p;
    Vector one(V->map());
    method::load(*form, Displacement{scene::constant(1), scene::constant(0)}, displaced(levels.finest(), {nullptr, nullptr}), 0, one);
    if (p == 1) area = one.norm1();  // functions of degree 1 have positive means
    EXPECT_NEAR(method::energy(*form, sheared), 9 * mu * area, 1e-10 * area) << p;
  }
}

TEST(Elasticity, is_one_form_whether_it_is_assembled_applied_or_measured) {
  const auto levels = hierarchy(Generator::file, 1);
  const auto softening = scene::formula([](double x, double y) { return 2 + x * x - y; });
  for (int p = 1; p <= 4; ++p)
    for (const bool varying : {false, true}) {
      const auto V = space(levels.finest(), p, true);
      const auto form = varying ? elasticity(*V, softening, scene::formula([](double x, double) { return 3 + x; })) : elastic(*V);
      const Displacement some = {scene::formula([](double x, double y) { return std::sin(3 * x + y); }),
                                 scene::formula([](double x, double y) { return std::cos(x - 2 * y); })};
      const Vector w = interpolated(*V, some);
      const auto all = V->complete(w, method::Coefficients("zero", V->coefficients().entries.size()));
      Vector y(V->map()), Sw(V->map());
      method::apply(*form, all, y);
      method::assemble(*form)->apply(w, Sw);
      EXPECT_LE(distance(y, Sw), 1e-12 * Sw.normInf());
      EXPECT_NEAR(method::energy(*form, all), w.dot(Sw), 1e-11 * w.dot(Sw)) << p << varying;
    }
}

TEST(Elasticity, does_not_ask_how_constants_are_written) {
  const auto levels = hierarchy(Generator::file, 0);
  const auto V = space(levels.finest(), 3, true);
  const auto written =
      elasticity(*V, scene::formula([](double, double) { return mu; }), scene::formula([](double, double) { return lambda; }));
  const Vector w = interpolated(*V, Polynomial{3}.value());
  Vector of_constants(V->map()), of_functions(V->map());
  method::assemble(*elastic(*V))->apply(w, of_constants);
  method::assemble(*written)->apply(w, of_functions);
  EXPECT_LE(distance(of_constants, of_functions), 1e-12 * of_constants.normInf());
}

TEST(Elasticity, has_errors_of_order_p_in_the_energy) {
  const Displacement u = {scene::formula([](double x, double y) { return std::sin(2 * x) * std::cos(y); }),
                          scene::formula([](double x, double y) { return std::cos(x + y); })};
  const std::vector<method::Known> exact = {{{scene::formula([](double x, double y) { return 2 * std::cos(2 * x) * std::cos(y); }),
                                              scene::formula([](double x, double y) { return -std::sin(2 * x) * std::sin(y); })}},
                                            {{scene::formula([](double x, double y) { return -std::sin(x + y); }),
                                              scene::formula([](double x, double y) { return -std::sin(x + y); })}}};
  // u_0,xx = -4 u_0, u_0,yy = -u_0, u_0,xy = -2 cos(2x) sin(y); all second derivatives of u_1 are -u_1
  const Displacement force = {scene::formula([](double x, double y) {
                                const double u0 = std::sin(2 * x) * std::cos(y), u1 = std::cos(x + y);
                                return mu * 5 * u0 + (lambda + mu) * (4 * u0 + u1);
                              }),
                              scene::formula([](double x, double y) {
                                const double u0_xy = -2 * std::cos(2 * x) * std::sin(y), u1 = std::cos(x + y);
                                return mu * 2 * u1 - (lambda + mu) * (u0_xy - u1);
                              })};
  for (int p = 1; p <= 4; ++p) {
    double error[2];
    for (int k = 0; k < 2; ++k) {
      const auto levels = hierarchy(Generator::criss_cross, k);
      const auto V = space(levels.finest(), p, true);
      const auto form = elastic(*V);
      const auto boundary = displaced(levels.finest(), u);
      error[k] = std::sqrt(method::energy_error(*form, V->complete(solved(*form, force, boundary), V->lift(boundary, 0)), exact, 0));
    }
    EXPECT_GT(std::log2(error[0] / error[1]), p - 0.1) << p << ": " << error[0] << ", " << error[1];
    EXPECT_LT(std::log2(error[0] / error[1]), p + 0.5) << p;
  }
}

TEST(Elasticity, refuses_materials_that_are_not_stable) {
  const auto levels = hierarchy(Generator::criss_cross, 0);
  const auto V = space(levels.finest(), 1, true);
  EXPECT_THROW(method::assemble(*elasticity(*V, scene::constant(-1), scene::constant(3))), core::InputError);
  EXPECT_THROW(method::assemble(*elasticity(*V, scene::constant(1), scene::constant(-1))), core::InputError);
  EXPECT_THROW(method::assemble(*elasticity(*V, scene::constant(1), scene::formula([](double x, double) { return x - 1.5; }))),
               core::InputError);
}

}  // namespace thixis::fem
