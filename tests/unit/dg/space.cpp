/// Interior-penalty dG: what must hold exactly for polynomials of its degree, and the properties of its forms.
#include "thixis/dg/space.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "thixis/algebra/solver.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/dg/params.hpp"
#include "thixis/mesh/adapt.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/method/transfer.hpp"

namespace thixis::dg {
namespace {

using algebra::Vector;
using mesh::Generator;
using method::BoundaryValues;
using scene::FieldPtr;

struct Setting {
  Generator generator;
  int degree;
  Variant variant;
  BoundaryTreatment boundary;
  method::Nodes nodes;
};

mesh::Hierarchy hierarchy(Generator generator, int refinements, const core::Comm& comm = core::Comm()) {
  mesh::MeshParams params;
  params.generator = generator;
  params.refinements = refinements;
  params.cells_per_rank = 20;
  if (generator == Generator::disk) params.rings = 3;
  if (generator == Generator::file) params.file = "l_shape_22.msh";
  return mesh::build(params, comm, MESH_FILES);
}

BoundaryValues everywhere(const mesh::Mesh& mesh, const FieldPtr& dirichlet, const FieldPtr& neumann = nullptr) {
  return {std::vector<FieldPtr>(mesh.tags.size(), dirichlet), std::vector<FieldPtr>(mesh.tags.size(), neumann)};
}

/// u = (0.3 + x - y/2)^p + x - y.
struct Polynomial {
  int p;
  static double inner(double x, double y) { return 0.3 + x - 0.5 * y; }
  FieldPtr value() const {
    return scene::formula([p = p](double x, double y) { return std::pow(inner(x, y), p) + x - y; });
  }
  double u_x(double x, double y) const { return p * std::pow(inner(x, y), p - 1) + 1; }
  double u_y(double x, double y) const { return -0.5 * p * std::pow(inner(x, y), p - 1) - 1; }
  double laplacian(double x, double y) const { return p < 2 ? 0 : 1.25 * p * (p - 1) * std::pow(inner(x, y), p - 2); }
  method::Gradient gradient() const {
    return {scene::formula([*this](double x, double y) { return u_x(x, y); }),
            scene::formula([*this](double x, double y) { return u_y(x, y); })};
  }
};

double distance(const Vector& v, const Vector& w) {
  Vector d(v, Teuchos::Copy);
  d.update(-1, w, 1);
  return d.normInf();
}

Vector solved(const method::Space& V, const scene::FieldPtr& tension, const Vector& rhs) {
  Vector u(V.map());
  algebra::LinearParams params;
  params.solver = algebra::SolverKind::direct;
  algebra::Solver solver(params);
  solver.set_matrix(method::assemble(*diffusion(V, tension)), 1, {V.coordinates(), {}});
  EXPECT_LT(solver.solve(rhs, u, {1e-13 * rhs.norm2(), 0, nullptr}).residual, 1e-10 * rhs.norm2());
  return u;
}

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

class InteriorPenalty : public ::testing::TestWithParam<Setting> {
 protected:
  std::unique_ptr<method::Space> space(const mesh::Mesh& m, bool held = true) const {
    method::MethodParams params;
    params.name = "dg";
    params.degree = GetParam().degree;
    params.own.get<Params>().variant = GetParam().variant;
    params.own.get<Params>().boundary = GetParam().boundary;
    params.nodes = GetParam().nodes;
    return make_space(m, {std::vector<bool>(m.tags.size(), held), nullptr, params});
  }
  mesh::Hierarchy levels = hierarchy(GetParam().generator, 1);
  const mesh::Mesh& mesh = levels.finest();
  const Polynomial u{GetParam().degree};
};

}  // namespace

TEST_P(InteriorPenalty, patch_test_with_constant_and_varying_tension) {
  const auto V = space(mesh);
  const auto boundary = everywhere(mesh, u.value());
  const auto lift = V->lift(boundary, 0);
  Vector exact(V->map()), F(V->map()), held(V->map());
  V->interpolate(*u.value(), 0, exact);
  for (const bool varies : {false, true}) {  // mu = 2 or 2 + x
    const auto tension = varies ? scene::formula([](double x, double) { return 2 + x; }) : scene::constant(2);
    const auto force = scene::formula(
        [=, u = u](double x, double y) { return varies ? -(2 + x) * u.laplacian(x, y) - u.u_x(x, y) : -2 * u.laplacian(x, y); });
    method::load(*diffusion(*V, tension), *force, boundary, 0, F);
    method::apply(*diffusion(*V, tension), lift, held);
    F.update(-1, held, 1);
    const Vector computed = solved(*V, tension, F);
    EXPECT_LT(distance(computed, exact), 1e-11);
    EXPECT_LT(std::sqrt(method::energy_error(*diffusion(*V, tension), V->complete(computed, lift), {method::Known{u.gradient()}}, 0)),
              1e-11);
  }
}

TEST_P(InteriorPenalty, patch_test_with_a_part_of_the_boundary_under_traction) {
  if (GetParam().generator != Generator::criss_cross) return;
  method::MethodParams params;
  params.degree = GetParam().degree;
  params.own.get<Params>().variant = GetParam().variant;
  params.own.get<Params>().boundary = GetParam().boundary;
  const auto right = std::find(mesh.tags.begin(), mesh.tags.end(), "right") - mesh.tags.begin();
  std::vector<bool> dirichlet(mesh.tags.size(), true);
  dirichlet[right] = false;
  const auto V = make_space(mesh, {dirichlet, nullptr, params});
  BoundaryValues boundary = everywhere(mesh, u.value());
  boundary.dirichlet[right] = nullptr;
  boundary.neumann[right] = scene::formula([u = u](double x, double y) { return 2 * u.u_x(x, y); });
  Vector exact(V->map()), F(V->map()), held(V->map());
  V->interpolate(*u.value(), 0, exact);
  method::load(*diffusion(*V, scene::constant(2)), *scene::formula([u = u](double x, double y) { return -2 * u.laplacian(x, y); }),
               boundary, 0, F);
  method::apply(*diffusion(*V, scene::constant(2)), V->lift(boundary, 0), held);
  F.update(-1, held, 1);
  EXPECT_LT(distance(solved(*V, scene::constant(2), F), exact), 1e-11);
}

/// The flux is continuous, the gradient is not: u = (x - 1/2)/mu, mu = 1 on the left half, 4 on the right one.
TEST_P(InteriorPenalty, patch_test_with_a_tension_that_jumps_across_faces) {
  if (GetParam().generator != Generator::criss_cross) return;
  const auto V = space(mesh);
  const auto tension = scene::formula([](double x, double) { return x < 0.5 ? 1.0 : 4.0; });
  const auto broken = scene::formula([](double x, double) { return (x - 0.5) / (x < 0.5 ? 1 : 4); });
  const auto boundary = everywhere(mesh, broken);
  Vector exact(V->map()), F(V->map()), held(V->map());
  V->interpolate(*broken, 0, exact);
  method::load(*diffusion(*V, tension), *scene::constant(0), boundary, 0, F);
  method::apply(*diffusion(*V, tension), V->lift(boundary, 0), held);
  F.update(-1, held, 1);
  EXPECT_LT(distance(solved(*V, tension, F), exact), 1e-11);
}

TEST_P(InteriorPenalty, sipg_is_symmetric_and_nipg_is_not) {
  const auto V = space(mesh);
  EXPECT_EQ(diffusion(*V, scene::constant(1))->symmetric(), GetParam().variant == Variant::sipg);
  for (const auto& tension : {scene::constant(3), scene::formula([](double x, double y) { return 2 + x * y / 2; })}) {
    const auto S = method::assemble(*diffusion(*V, tension));
    Vector y(V->map()), z(V->map()), Sy(V->map()), Sz(V->map());
    y.randomize();
    z.randomize();
    S->apply(y, Sy);
    S->apply(z, Sz);
    const double skew = std::abs(z.dot(Sy) - y.dot(Sz)), size = std::abs(z.dot(Sy)) + std::abs(y.dot(Sz));
    if (diffusion(*V, scene::constant(1))->symmetric()) EXPECT_LT(skew, 1e-10 * size);
    else EXPECT_GT(skew, 1e-8 * size);
  }
}

/// In v'Sv the consistency terms of NIPG cancel: what is left is the broken energy and the penalty, whatever its size.
TEST_P(InteriorPenalty, nipg_is_coercive_for_any_penalty) {
  if (GetParam().variant == Variant::sipg || GetParam().boundary == BoundaryTreatment::strong) return;
  method::MethodParams params;
  params.degree = GetParam().degree;
  params.own.get<Params>().variant = Variant::nipg;
  params.own.get<Params>().penalty = 1e-6;
  const auto V = make_space(mesh, {std::vector<bool>(mesh.tags.size(), true), nullptr, params});
  Vector y(V->map()), Sy(V->map());
  y.randomize();
  method::assemble(*diffusion(*V, scene::constant(1)))->apply(y, Sy);
  const double energy =
      method::energy(*diffusion(*V, scene::constant(1)), V->complete(y, V->lift(everywhere(mesh, scene::constant(0)), 0)));
  EXPECT_GE(y.dot(Sy), (1 - 1e-10) * energy);
}

TEST_P(InteriorPenalty, forces_cell_by_cell_are_the_action_of_the_matrix) {
  const auto V = space(mesh);
  for (const auto& tension : {scene::constant(3), scene::formula([](double x, double y) { return 2 + x * y / 2; })}) {
    Vector w(V->map()), y(V->map()), Sw(V->map());
    w.randomize();
    method::apply(*diffusion(*V, tension), V->complete(w, V->lift(everywhere(mesh, scene::constant(0)), 0)), y);
    method::assemble(*diffusion(*V, tension))->apply(w, Sw);
    EXPECT_LT(distance(y, Sw), 1e-12 * Sw.normInf());
  }
}

TEST_P(InteriorPenalty, without_dirichlet_data_constants_feel_no_force) {
  const auto V = space(mesh, false);
  Vector one(V->map()), y(V->map());
  one.putScalar(1);
  method::assemble(*diffusion(*V, scene::constant(1)))->apply(one, y);
  EXPECT_LT(y.normInf(), 1e-11);
}

TEST_P(InteriorPenalty, the_multiplier_is_known_from_its_moments_cell_by_cell) {
  const auto V = space(mesh, false);
  Vector X3(V->points()), back(V->map()), exact(V->map());
  V->interpolate_multiplier(*u.value(), 0, X3);
  V->restrict_to_unknowns(V->multiplier(X3), back);
  V->interpolate(*u.value(), 0, exact);
  EXPECT_LT(distance(back, exact), 1e-10);
}

TEST_P(InteriorPenalty, prolongation_is_exact_for_polynomials_of_nested_meshes) {
  if (GetParam().generator == Generator::disk) return;
  const auto coarse = space(levels.levels[0]), fine = space(mesh);
  Vector coarse_u(coarse->map()), values(fine->map()), exact(fine->map());
  coarse->interpolate(*u.value(), 0, coarse_u);
  method::Transfer(*coarse, *fine).prolongate(coarse->complete(coarse_u, coarse->lift(everywhere(levels.levels[0], u.value()), 0)), values);
  fine->interpolate(*u.value(), 0, exact);
  EXPECT_LT(distance(values, exact), 1e-12);
}

TEST_P(InteriorPenalty, prolongation_is_exact_on_adaptive_levels) {
  adapt_around_a_cell(levels);
  const FieldPtr w = GetParam().generator == Generator::disk ? scene::constant(2) : u.value();
  for (std::size_t j = 1; j < levels.levels.size(); ++j) {
    const auto coarse = space(levels.levels[j - 1]), fine = space(levels.levels[j]);
    Vector coarse_w(coarse->map()), values(fine->map()), exact(fine->map());
    coarse->interpolate(*w, 0, coarse_w);
    method::Transfer(*coarse, *fine).prolongate(coarse->complete(coarse_w, coarse->lift(everywhere(levels.levels[j - 1], w), 0)), values);
    fine->interpolate(*w, 0, exact);
    EXPECT_LT(distance(values, exact), 1e-12);
  }
}

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const auto generator : {Generator::criss_cross, Generator::disk, Generator::file})
    for (int p = 1; p <= 4; ++p)
      for (const auto variant : {Variant::sipg, Variant::nipg})
        for (const auto boundary : {BoundaryTreatment::weak, BoundaryTreatment::strong})
          for (const auto nodes : {method::Nodes::gauss_lobatto, method::Nodes::bernstein})
            all.push_back({generator, p, variant, boundary, nodes});
  return all;
}
std::string setting_name(const ::testing::TestParamInfo<Setting>& info) {
  const Setting& s = info.param;
  const char* const generators[] = {"criss_cross", "rectangle", "disk", "gmsh"};
  return std::string(generators[static_cast<int>(s.generator)]) + "_P" + std::to_string(s.degree) +
         (s.variant == Variant::sipg ? "_sipg" : "_nipg") + (s.boundary == BoundaryTreatment::weak ? "_weak" : "_strong") +
         (s.nodes == method::Nodes::bernstein ? "_bernstein" : "_lagrange");
}
INSTANTIATE_TEST_SUITE_P(Dg, InteriorPenalty, ::testing::ValuesIn(settings()), setting_name);

/// The whole matrix by the identities of its unknowns.
using Entries = std::map<std::pair<GlobalIndex, GlobalIndex>, double>;

Entries entries(const method::Space& V, const scene::FieldPtr& tension) {
  const auto S = method::assemble(*diffusion(V, tension));
  const auto ids = V.unknown_ids();
  Vector own(S->getRowMap()), ghosted(S->getColMap());
  for (std::size_t row = 0; row < ids.size(); ++row) own.replaceLocalValue(row, static_cast<double>(ids[row]));
  const auto import = S->getGraph()->getImporter();
  if (import.is_null()) ghosted.assign(own);
  else ghosted.doImport(own, *import, Tpetra::INSERT);
  const auto id = algebra::host_view(std::as_const(ghosted));
  const auto matrix = S->getLocalMatrixHost();
  std::vector<GlobalIndex> pairs;
  std::vector<double> values;
  for (int row = 0; row < matrix.numRows(); ++row)
    for (auto k = matrix.graph.row_map(row); k < matrix.graph.row_map(row + 1); ++k) {
      pairs.push_back(ids[row]);
      pairs.push_back(static_cast<GlobalIndex>(id(matrix.graph.entries(k))));
      values.push_back(matrix.values(k));
    }
  const core::Comm comm = V.mesh().comm;
  pairs = comm.gather(pairs);
  values = comm.gather(values);
  Entries all;
  for (std::size_t k = 0; k < values.size(); ++k) all[{pairs[2 * k], pairs[2 * k + 1]}] = values[k];
  EXPECT_EQ(all.size(), values.size());
  return all;
}

TEST_P(InteriorPenalty, the_matrix_does_not_depend_on_the_ranks) {
  if (GetParam().nodes == method::Nodes::bernstein) return;
  const auto one_rank = hierarchy(GetParam().generator, 1, core::Comm(MPI_COMM_SELF));
  for (const auto& tension : {scene::constant(3), scene::formula([](double x, double y) { return x < 0.5 ? 2 + x * y : 1; })}) {
    const Entries here = entries(*space(mesh), tension), alone = entries(*space(one_rank.finest()), tension);
    ASSERT_EQ(here.size(), alone.size());
    double largest = 0, difference = 0;
    for (const auto& [place, value] : alone) {
      largest = std::max(largest, std::abs(value));
      ASSERT_EQ(here.count(place), 1);
      difference = std::max(difference, std::abs(value - here.at(place)));
    }
    EXPECT_LT(difference, 1e-12 * largest);
  }
}

/// Whether S + S' has a Cholesky factor.
bool positive_definite(const Entries& S) {
  std::map<GlobalIndex, int> number;
  for (const auto& [place, value] : S) number.try_emplace(place.first, static_cast<int>(number.size()));
  const int n = static_cast<int>(number.size());
  std::vector<double> A(n * n);
  for (const auto& [place, value] : S) {
    const int i = number.at(place.first), j = number.at(place.second);
    A[i * n + j] += value;
    A[j * n + i] += value;
  }
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < k; ++j) {
      for (int i = 0; i < j; ++i) A[k * n + j] -= A[k * n + i] * A[j * n + i];
      A[k * n + j] /= A[j * n + j];
      A[k * n + k] -= A[k * n + j] * A[k * n + j];
    }
    if (!(A[k * n + k] > 0)) return false;
    A[k * n + k] = std::sqrt(A[k * n + k]);
  }
  return true;
}

/// (1 + 1/p)/4 max_K sum_F w_F |F|²/|K|, w_F = 2 on the boundary (docs/methods/dg.md, 2).
double sufficient_penalty(const mesh::Mesh& mesh, int p) {
  const auto host = mesh::on_host(mesh);
  double largest = 0;
  for (LocalIndex K = 0; K < mesh.cells; ++K) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const LocalIndex F = host.cell_faces(K, i);
      const double length = mesh::face_geometry(host.coordinates, host.face_vertices, F).length;
      sum += (host.face_tag(F) < 0 ? 1 : 2) * length * length;
    }
    largest = std::max(largest, sum / mesh::cell_area(host.coordinates, host.cell_vertices, K));
  }
  return (1 + 1.0 / p) / 4 * largest;
}

mesh::Mesh coarse(Generator generator) { return hierarchy(generator, 0, core::Comm(MPI_COMM_SELF)).levels[0]; }

/// The same mesh pressed to a tenth of its height.
mesh::Mesh flattened(Generator generator) {
  const mesh::Mesh mesh = coarse(generator);
  const auto x = mesh::on_host(mesh).coordinates;
  for (LocalIndex v = 0; v < mesh.vertices; ++v) mesh.coordinates(v, 1) = 0.1 * x(v, 1);
  return mesh;
}

class Penalty : public ::testing::TestWithParam<int> {
 protected:
  bool definite(const mesh::Mesh& mesh, Variant variant, double penalty) const {
    method::MethodParams params;
    params.degree = GetParam();
    params.own.get<Params>().variant = variant;
    params.own.get<Params>().penalty = penalty;
    const auto V = make_space(mesh, {std::vector<bool>(mesh.tags.size(), true), nullptr, params});
    return positive_definite(entries(*V, scene::constant(1)));
  }
};

TEST_P(Penalty, that_the_shape_of_the_cells_asks_for_makes_sipg_positive_definite) {
  for (const auto generator : {Generator::criss_cross, Generator::disk, Generator::file})
    for (const bool flat : {false, true}) {
      const mesh::Mesh mesh = flat ? flattened(generator) : coarse(generator);
      const double enough = sufficient_penalty(mesh, GetParam());
      EXPECT_TRUE(definite(mesh, Variant::sipg, 1.001 * enough));
      EXPECT_FALSE(definite(mesh, Variant::sipg, 0.1 * enough));
      EXPECT_EQ(enough < Params().penalty, !flat);
    }
}

TEST_P(Penalty, of_any_size_makes_nipg_positive_definite) { EXPECT_TRUE(definite(flattened(Generator::criss_cross), Variant::nipg, 1e-3)); }

INSTANTIATE_TEST_SUITE_P(Degrees, Penalty, ::testing::Range(1, 5));

TEST(Poisson, converges_with_order_p) {
  const double pi = std::acos(-1.0);
  const method::Gradient exact = {scene::formula([pi](double x, double y) { return pi * std::cos(pi * x) * std::sin(pi * y); }),
                                  scene::formula([pi](double x, double y) { return pi * std::sin(pi * x) * std::cos(pi * y); })};
  const auto f = scene::formula([pi](double x, double y) { return 2 * pi * pi * std::sin(pi * x) * std::sin(pi * y); });
  const auto levels = hierarchy(Generator::criss_cross, 3);
  for (int p = 1; p <= 4; ++p)
    for (const auto variant : {Variant::sipg, Variant::nipg}) {
      double error[2];
      for (int k = 0; k < 2; ++k) {
        const mesh::Mesh& mesh = levels.levels[2 + k];
        method::MethodParams params;
        params.degree = p;
        params.own.get<Params>().variant = variant;
        const auto V = make_space(mesh, {std::vector<bool>(mesh.tags.size(), true), nullptr, params});
        const auto zero = everywhere(mesh, scene::constant(0));
        Vector F(V->map());
        method::load(*diffusion(*V, scene::constant(1)), *f, zero, 0, F);
        error[k] =
            std::sqrt(method::energy_error(*diffusion(*V, scene::constant(1)),
                                           V->complete(solved(*V, scene::constant(1), F), V->lift(zero, 0)), {method::Known{exact}}, 0));
      }
      EXPECT_NEAR(std::log2(error[0] / error[1]), p, 0.05) << "p = " << p;
    }
}

}  // namespace thixis::dg
