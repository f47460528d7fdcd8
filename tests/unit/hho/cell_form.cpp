/// The form on a cell against its definition, in physical coordinates and another basis of test functions.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "problems.hpp"
#include "reference_cell.hpp"
#include "thixis/hho/params.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/method/form.hpp"
#include "thixis/reference/modal.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::hho {
namespace {

using Point = std::array<double, 2>;
using Dense = std::vector<std::vector<double>>;

Dense dense(std::size_t rows, std::size_t columns) { return Dense(rows, std::vector<double>(columns, 0.0)); }

Dense product(const Dense& A, const Dense& B) {
  Dense C = dense(A.size(), B[0].size());
  for (std::size_t i = 0; i < A.size(); ++i)
    for (std::size_t k = 0; k < B.size(); ++k)
      for (std::size_t j = 0; j < B[0].size(); ++j) C[i][j] += A[i][k] * B[k][j];
  return C;
}

Dense inverse(const Dense& A) {
  std::vector<double> flat;
  for (const auto& row : A) flat.insert(flat.end(), row.begin(), row.end());
  flat = reference::inverse(static_cast<int>(A.size()), flat);
  Dense B = dense(A.size(), A.size());
  for (std::size_t i = 0; i < A.size(); ++i) std::copy_n(flat.begin() + i * A.size(), A.size(), B[i].begin());
  return B;
}

/// A triangle with the basis of its cell and, on each face, Legendre polynomials between `face_ends`.
struct Cell {
  Point vertex[3];
  std::array<Point, 2> face_ends[3];
  reference::CellBasis basis;

  Point map(double xi, double eta) const {
    Point x;
    for (int d = 0; d < 2; ++d) x[d] = (1 - xi - eta) * vertex[0][d] + xi * vertex[1][d] + eta * vertex[2][d];
    return x;
  }
  double J(int d, int a) const { return vertex[a + 1][d] - vertex[0][d]; }
  double determinant() const { return J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0); }
  Point pull_back(Point x) const {
    const double dx = x[0] - vertex[0][0], dy = x[1] - vertex[0][1];
    return {(J(1, 1) * dx - J(0, 1) * dy) / determinant(), (-J(1, 0) * dx + J(0, 0) * dy) / determinant()};
  }
  std::vector<double> psi(Point x) const { return basis.tabulate(1, pull_back(x).data()).value; }
  std::vector<Point> grad_psi(Point x) const {
    const auto g = basis.tabulate(1, pull_back(x).data()).gradient;
    std::vector<Point> result;
    for (int i = 0; i < basis.size(); ++i)
      result.push_back(
          {(J(1, 1) * g[2 * i] - J(1, 0) * g[2 * i + 1]) / determinant(), (-J(0, 1) * g[2 * i] + J(0, 0) * g[2 * i + 1]) / determinant()});
    return result;
  }
  double length(int f) const { return std::hypot(face_ends[f][1][0] - face_ends[f][0][0], face_ends[f][1][1] - face_ends[f][0][1]); }
  double diameter() const { return std::max({length(0), length(1), length(2)}); }
  Point normal(int f) const {
    const Point &a = vertex[(f + 1) % 3], &b = vertex[(f + 2) % 3];
    return {(b[1] - a[1]) / length(f), (a[0] - b[0]) / length(f)};
  }
  /// Monomials of degree p-1 around the centre.
  std::vector<double> monomials(Point x) const {
    const Point centre = map(1.0 / 3, 1.0 / 3);
    std::vector<double> q;
    for (int i = 0; i < basis.degree(); ++i)
      for (int j = 0; i + j < basis.degree(); ++j)
        q.push_back(std::pow(3 * (x[0] - centre[0]) / diameter(), i) * std::pow(3 * (x[1] - centre[1]) / diameter(), j));
    return q;
  }
};

/// a_K by its definition, mu a function of x, y.
template <class Mu>
Dense by_definition(const Cell& K, Mu mu, double kappa, bool cell_length) {
  const int n = K.basis.size(), p = K.basis.degree(), width = n + 3 * p;
  const auto inside = reference::triangle_quadrature(2 * p + 4), line = reference::line_quadrature(2 * p + 4);
  const std::size_t m = K.monomials({0, 0}).size();
  Dense mass = dense(m, m), weighted = dense(m, m), A = dense(width, width), right[2] = {dense(m, width), dense(m, width)};
  double mean = 0;
  for (int q = 0; q < inside.size(); ++q) {
    const Point x = K.map(inside.point[2 * q], inside.point[2 * q + 1]);
    const auto tests = K.monomials(x);
    const auto slopes = K.grad_psi(x);
    const double weight = inside.weight[q] * K.determinant();
    mean += 2 * inside.weight[q] * mu(x[0], x[1]);
    for (std::size_t k = 0; k < m; ++k) {
      for (std::size_t l = 0; l < m; ++l) {
        mass[k][l] += weight * tests[k] * tests[l];
        weighted[k][l] += weight * mu(x[0], x[1]) * tests[k] * tests[l];
      }
      for (int i = 0; i < n; ++i)
        for (int d = 0; d < 2; ++d) right[d][k][i] += weight * slopes[i][d] * tests[k];
    }
  }
  for (int f = 0; f < 3; ++f) {
    Dense jump = dense(p, width);
    for (int q = 0; q < line.size(); ++q) {
      const auto& [a, b] = K.face_ends[f];
      const double s = line.point[q];
      const Point x = {(1 - s) * a[0] + s * b[0], (1 - s) * a[1] + s * b[1]}, normal = K.normal(f);
      const auto tests = K.monomials(x), values = K.psi(x), L = reference::legendre(p, s);
      for (std::size_t k = 0; k < m; ++k)
        for (int d = 0; d < 2; ++d) {
          const double weight = line.weight[q] * K.length(f) * tests[k] * normal[d];
          for (int i = 0; i < n; ++i) right[d][k][i] -= weight * values[i];
          for (int j = 0; j < p; ++j) right[d][k][n + f * p + j] += weight * L[j];
        }
      for (int j = 0; j < p; ++j)
        for (int i = 0; i < n; ++i) jump[j][i] += line.weight[q] * L[j] * values[i];
    }
    for (int j = 0; j < p; ++j) jump[j][n + f * p + j] = -1;
    const double scale = kappa * mean * K.length(f) / (cell_length ? K.diameter() : K.length(f));
    for (int j = 0; j < p; ++j)
      for (int r = 0; r < width; ++r)
        for (int c = 0; c < width; ++c) A[r][c] += scale * jump[j][r] * jump[j][c];
  }
  for (int d = 0; d < 2; ++d) {
    const Dense G = product(inverse(mass), right[d]), moments = product(weighted, G);
    for (std::size_t k = 0; k < m; ++k)
      for (int r = 0; r < width; ++r)
        for (int c = 0; c < width; ++c) A[r][c] += G[k][r] * moments[k][c];
  }
  return A;
}

class CellForm : public ::testing::TestWithParam<Setting> {
 protected:
  template <class Mu>
  void expect_definition(const scene::FieldPtr& tension, Mu mu, StabilizationLength length) {
    auto of_method = params(GetParam().degree, GetParam().nodes);
    of_method.own.get<Params>().stabilization = 2.5;
    of_method.own.get<Params>().stabilization_length = length;
    const auto V = space(mesh, of_method, false);
    const auto form = diffusion(*V, tension)->cells();
    const reference::CellBasis basis(GetParam().degree, method::family(GetParam().nodes));
    const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), method::patch_cells(mesh));
    const auto host = mesh::on_host(mesh);
    const int width = basis.size() + 3 * basis.degree();
    const method::LocalMatrices A("local", cells.extent(0) - 1, width, width);
    form->matrices(1, A);  // all cells but the first
    for (int e = 0; e < A.extent_int(0); ++e) {
      const LocalIndex K = cells(1 + e);
      Cell cell{{}, {}, basis};
      const auto place = [&](LocalIndex v) { return Point{host.coordinates(v, 0), host.coordinates(v, 1)}; };
      for (int f = 0; f < 3; ++f) {
        cell.vertex[f] = place(host.cell_vertices(K, f));
        const LocalIndex F = host.cell_faces(K, f);
        cell.face_ends[f] = {place(host.face_vertices(F, 0)), place(host.face_vertices(F, 1))};
      }
      const Dense expected = by_definition(cell, mu, of_method.own.get<Params>().stabilization, length == StabilizationLength::cell);
      double largest = 0;
      for (int i = 0; i < width; ++i) largest = std::max(largest, expected[i][i]);
      for (int i = 0; i < width; ++i)
        for (int j = 0; j < width; ++j) ASSERT_NEAR(A(e, i, j), expected[i][j], 1e-13 * largest) << K << ": " << i << ", " << j;
    }
  }

  mesh::Hierarchy levels = hierarchy(GetParam().generator, 0);
  const mesh::Mesh& mesh = levels.finest();
};

}  // namespace

TEST_P(CellForm, is_its_definition_for_a_constant_tension) {
  for (const auto length : {StabilizationLength::face, StabilizationLength::cell})
    expect_definition(
        scene::constant(3), [](double, double) { return 3.0; }, length);
}

TEST_P(CellForm, is_its_definition_for_a_tension_that_varies) {
  const auto mu = [](double x, double y) { return 2 + x * y / 4; };
  for (const auto length : {StabilizationLength::face, StabilizationLength::cell}) expect_definition(scene::formula(mu), mu, length);
}

TEST_P(CellForm, is_the_same_for_a_constant_that_poses_as_a_function) {
  expect_definition(
      scene::formula([](double, double) { return 3.0; }), [](double, double) { return 3.0; }, StabilizationLength::face);
}

INSTANTIATE_TEST_SUITE_P(Hho, CellForm, ::testing::ValuesIn(settings()), [](const auto& setting) { return name(setting.param); });

TEST(Reconstruction, is_the_gradient_of_polynomials) {
  const Point x[3] = {{0.2, -0.1}, {1.3, 0.4}, {0.1, 0.9}};
  for (int p = 1; p <= 4; ++p)
    for (const auto family : {reference::Family::gauss_lobatto, reference::Family::equispaced, reference::Family::bernstein}) {
      const Polynomial u{p};
      const Cell K{{x[0], x[1], x[2]}, {{x[1], x[2]}, {x[2], x[0]}, {x[0], x[1]}}, reference::CellBasis(p, family)};
      const ReferenceCell cell = reference_cell(K.basis);
      const int n = cell.functions;
      std::vector<double> v(cell.unknowns, 0.0), at_points(n);
      for (int l = 0; l < n; ++l) {
        const Point y = K.map(K.basis.points()[2 * l], K.basis.points()[2 * l + 1]);
        at_points[l] = u(y[0], y[1]);
      }
      for (int i = 0; i < n; ++i)
        for (int l = 0; l < n; ++l) v[i] += K.basis.from_values()[i * n + l] * at_points[l];
      const auto line = reference::line_quadrature(2 * p);
      for (int f = 0; f < 3; ++f)
        for (int q = 0; q < line.size(); ++q) {
          const auto& [a, b] = K.face_ends[f];
          const double s = line.point[q];
          const auto L = reference::legendre(p, s);
          for (int j = 0; j < p; ++j) v[n + f * p + j] += line.weight[q] * L[j] * u((1 - s) * a[0] + s * b[0], (1 - s) * a[1] + s * b[1]);
        }
      for (const Point xi : {Point{0.1, 0.2}, Point{0.7, 0.1}, Point{0.3, 0.6}}) {
        const double lambda[3] = {1 - xi[0] - xi[1], xi[0], xi[1]};
        std::vector<double> B(cell.B.size);
        cell.B.values(lambda, B.data());
        const double slope[3][2] = {{K.J(1, 0) - K.J(1, 1), K.J(0, 1) - K.J(0, 0)}, {K.J(1, 1), -K.J(0, 1)}, {-K.J(1, 0), K.J(0, 0)}};
        Point G = {0, 0};
        for (int f = 0; f < 3; ++f)
          for (int k = 0; k < cell.B.size; ++k)
            for (int i = 0; i < cell.unknowns; ++i)
              for (int d = 0; d < 2; ++d) G[d] += slope[f][d] / K.determinant() * B[k] * cell.G[f][k * cell.unknowns + i] * v[i];
        const Point y = K.map(xi[0], xi[1]);
        EXPECT_NEAR(G[0], u.dx(y[0], y[1]), 1e-12);
        EXPECT_NEAR(G[1], u.dy(y[0], y[1]), 1e-12);
      }
      for (int f = 0; f < 3; ++f)
        for (int j = 0; j < p; ++j) {
          double difference = 0;
          for (int i = 0; i < cell.unknowns; ++i) difference += cell.R[f][j * cell.unknowns + i] * v[i];
          EXPECT_NEAR(difference, 0, 1e-13);
        }
    }
}

}  // namespace thixis::hho
