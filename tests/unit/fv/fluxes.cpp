/// RT_0 on the cells of a grid, quadratic potentials, nodal averages, fluxes with a given divergence.
#include <gtest/gtest.h>

#include <cmath>

#include "grids.hpp"
#include "thixis/fv/flux_lift.hpp"
#include "thixis/fv/nodal_average.hpp"

namespace thixis::fv {
namespace {

/// a + b·x + ½ sum_i c_i x_i²
struct Polynomial {
  double a, b[2], c[2];
  double operator()(double x, double y) const { return a + (b[0] + 0.5 * c[0] * x) * x + (b[1] + 0.5 * c[1] * y) * y; }
  double gradient(int i, double x) const { return b[i] + c[i] * x; }
};

/// With equal c, which the spaces of all cells hold; nothing along y in one dimension.
Polynomial polynomial(const Grid& grid, bool quadratic) {
  Polynomial p{0.7, {1.3, -0.4}, {0, 0}};
  if (quadratic) p.c[0] = p.c[1] = 0.9;
  if (grid.dimension == 1) p.b[1] = p.c[1] = 0;
  return p;
}

/// Exact v·n on the faces of each owned cell, v = grad p: constant along faces.
std::vector<double> normal_components(const Grid& grid, LocalIndex K, const Polynomial& p) {
  const RaviartThomas cells(grid);
  std::vector<double> g;
  for (int f = 0; f < cells.count(K); ++f) {
    const LocalIndex F = cells.face(K, f);
    double sum = 0;
    for (int i = 0; i < 2; ++i) sum += p.gradient(i, grid.face_centre(F, i)) * grid.face_normal(F, i);
    g.push_back(cells.sign(K, f) * sum);
  }
  return g;
}

std::vector<bool> boundary(const Grid& grid) {
  std::vector<bool> held(grid.faces);
  for (LocalIndex F = 0; F < grid.faces; ++F) held[F] = grid.face_tag(F) >= 0;
  return held;
}

View<const Quadratic**> potentials(const Grid& grid, const Polynomial& p) {
  const RaviartThomas cells(grid);
  const View<Quadratic**> out("potentials", grid.owned_cells, 1);
  for (LocalIndex K = 0; K < grid.owned_cells; ++K)
    out(K, 0) = cells.potential(K, p(grid.centre(K, 0), grid.centre(K, 1)), normal_components(grid, K, p).data());
  return out;
}

/// What p is at the corners and, in two dimensions, at the midpoints of the faces.
View<const double**> values_on_faces(const Grid& grid, const Polynomial& p) {
  const View<double**> out("values", grid.faces, 1);
  for (LocalIndex F = 0; F < grid.faces; ++F) out(F, 0) = p(grid.face_centre(F, 0), grid.face_centre(F, 1));
  return out;
}

TEST(raviart_thomas, the_potential_of_exact_fluxes_is_the_quadratic_polynomial) {
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    const Grid grid = sample.make(core::Comm());
    const RaviartThomas cells(grid);
    const Polynomial p = polynomial(grid, true);
    const auto found = potentials(grid, p);
    for (LocalIndex K = 0; K < grid.owned_cells; ++K) {
      EXPECT_NEAR(cells.divergence(K, normal_components(grid, K, p).data()), p.c[0] + p.c[1], 1e-11);
      for (int i = 0; i < grid.corners(); ++i) {
        const LocalIndex v = grid.cell_vertices(K, i);
        const double y[2] = {grid.vertex(v, 0) - grid.centre(K, 0), grid.vertex(v, 1) - grid.centre(K, 1)};
        EXPECT_NEAR(found(K, 0)(y), p(grid.vertex(v, 0), grid.vertex(v, 1)), 1e-11);
      }
    }
  }
}

TEST(raviart_thomas, the_norm_is_that_of_the_field) {
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    const Grid grid = sample.make(core::Comm());
    const RaviartThomas cells(grid);
    for (LocalIndex K = 0; K < grid.owned_cells; ++K) {
      std::vector<double> g;
      for (int f = 0; f < cells.count(K); ++f) g.push_back(std::sin(7.0 * static_cast<double>(grid.cell_id[K]) + 3 * f));
      const Quadratic p = cells.potential(K, 0, g.data());
      // v is affine: |v|² is integrated by its values at the corners and the barycentre, for intervals and triangles by
      // (|K| (1/((d+1)(d+2))) (sum_i v_i² + (sum_i v_i)²)), for rectangles axis by axis.
      double exact = 0;
      const int d = grid.corners() == 3 ? 2 : 1;
      for (int axis = 0; axis < grid.dimension; ++axis) {
        double squares = 0, sum = 0;
        int used = 0;
        for (int i = 0; i < grid.corners(); ++i) {
          const LocalIndex v = grid.cell_vertices(K, i);
          if (grid.corners() == 4 && std::abs(grid.vertex(v, 1 - axis) - grid.vertex(grid.cell_vertices(K, 0), 1 - axis)) > 1e-9) continue;
          const double value = p.at[axis] + p.slope[axis] * (grid.vertex(v, axis) - grid.centre(K, axis));
          squares += value * value;
          sum += value;
          ++used;
        }
        ASSERT_EQ(used, d + 1);
        exact += grid.volume(K) / ((d + 1) * (d + 2)) * (squares + sum * sum);
      }
      EXPECT_NEAR(cells.square(K, g.data()), exact, 1e-12 * (1 + exact));
    }
  }
}

TEST(nodal_average, leaves_continuous_functions_as_they_are) {
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    const Grid grid = sample.make(core::Comm());
    const Polynomial p = polynomial(grid, true);
    const View<double**> square("square", grid.owned_cells, 1);
    NodalAverage(grid, std::vector<bool>(grid.faces, false))(potentials(grid, p), values_on_faces(grid, p), square);
    for (LocalIndex K = 0; K < grid.owned_cells; ++K) EXPECT_NEAR(square(K, 0), 0, 1e-20);
  }
}

/// Boundary values enter: an affine function whose values there are raised by one, in one dimension and on rectangles by hand.
TEST(nodal_average, takes_the_values_of_held_faces) {
  const Grid grid = fv::build(interval_params(2, 0, 2), core::Comm(MPI_COMM_SELF), ".");
  const Polynomial p = polynomial(grid, false);
  const View<double**> square("square", grid.owned_cells, 1), given("given", grid.faces, 1);
  const auto exact = values_on_faces(grid, p);
  for (LocalIndex F = 0; F < grid.faces; ++F) given(F, 0) = exact(F, 0) + 1;
  NodalAverage(grid, boundary(grid))(potentials(grid, p), given, square);
  for (LocalIndex K = 0; K < 2; ++K) EXPECT_NEAR(square(K, 0), 7. / 3, 1e-12);  // |grad|² of the quadratic with 1, 0, 0 at its nodes

  const Grid one = fv::build(tensor_params(1, 1, {0, 0}, {2, 3}), core::Comm(MPI_COMM_SELF), ".");
  const Polynomial q = polynomial(one, false);
  const View<double**> squares("square", 1, 1), raised("raised", 4, 1);
  const auto on_faces = values_on_faces(one, q);
  for (LocalIndex F = 0; F < 4; ++F) raised(F, 0) = on_faces(F, 0) + 1;
  NodalAverage(one, boundary(one))(potentials(one, q), raised, squares);
  // 1 - (1 - x²)(1 - y²) on the reference square: ∫ (2x)² ∫ (1 - y²)² = 128/45, by the ratio of the sides and its inverse
  EXPECT_NEAR(squares(0, 0), 128. / 45 * (1.5 + 1 / 1.5), 1e-12);
}

/// Values that jump from cell to cell: what ranks share counts once.
TEST(nodal_average, does_not_depend_on_the_number_of_ranks) {
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    const auto squares = [](const Grid& grid) {
      const RaviartThomas cells(grid);
      const View<Quadratic**> p("p", grid.owned_cells, 1);
      for (LocalIndex K = 0; K < grid.owned_cells; ++K) {
        double g[4];
        for (int f = 0; f < cells.count(K); ++f) g[f] = cells.sign(K, f) * std::cos(static_cast<double>(grid.face_id[cells.face(K, f)]));
        p(K, 0) = cells.potential(K, std::sin(static_cast<double>(grid.cell_id[K])), g);
      }
      const View<double**> given("given", grid.faces, 1), square("square", grid.owned_cells, 1);
      std::vector<bool> held = boundary(grid);
      for (LocalIndex F = 0; F < grid.faces; ++F) {
        given(F, 0) = std::sin(static_cast<double>(grid.face_id[F]));
        if (grid.face_tag(F) == 0) held[F] = false;
      }
      NodalAverage(grid, held)(p, given, square);
      return square;
    };
    const Grid grid = sample.make(core::Comm()), all = whole(sample);
    const auto mine = squares(grid), reference = squares(all);
    for (LocalIndex K = 0; K < grid.owned_cells; ++K) {
      const double expected = reference(std::find(all.cell_id.begin(), all.cell_id.end(), grid.cell_id[K]) - all.cell_id.begin(), 0);
      EXPECT_NEAR(mine(K, 0), expected, 1e-11 * (1 + expected));
    }
  }
}

TEST(flux_lift, has_the_divergence_asked_for) {
  for (const Sample& sample : samples())
    for (const bool some_held : {true, false}) {
      SCOPED_TRACE(sample.name + (some_held ? "" : ", closed"));
      const Grid grid = sample.make(core::Comm());
      const RaviartThomas cells(grid);
      std::vector<bool> held(grid.faces, false);
      if (some_held)
        for (LocalIndex F = 0; F < grid.faces; ++F) held[F] = grid.face_tag(F) == 1;
      const View<double**> r("r", grid.owned_cells, 2), sigma("sigma", grid.faces, 2), rest("rest", grid.owned_cells, 2);
      for (LocalIndex K = 0; K < grid.owned_cells; ++K) {
        r(K, 0) = 1e-12 * std::sin(5.0 * static_cast<double>(grid.cell_id[K]));
        r(K, 1) = 3 + grid.centre(K, 0);
      }
      FluxLift(grid, held)(r, sigma, rest);
      double worst[2] = {0, 0};
      for (LocalIndex K = 0; K < grid.owned_cells; ++K)
        for (int j = 0; j < 2; ++j) {
          double g[4];
          for (int f = 0; f < cells.count(K); ++f) {
            const LocalIndex F = cells.face(K, f);
            g[f] = cells.sign(K, f) * sigma(F, j);
            if (grid.face_tag(F) >= 0 && !held[F]) {
              EXPECT_EQ(sigma(F, j), 0);
            }
          }
          const double left = std::abs(cells.divergence(K, g) - r(K, j));
          worst[j] = std::max(worst[j], left);
          if (some_held) {
            EXPECT_EQ(rest(K, j), 0);
          }
        }
      if (some_held) {
        EXPECT_LE(worst[0], 1e-21);
        EXPECT_LE(worst[1], 1e-8);
      }
    }
}

/// In one dimension it is the integral of the density from the closed end.
TEST(flux_lift, is_the_cumulated_sum_on_an_interval) {
  const Grid grid = fv::build(interval_params(50, 0, 2), core::Comm(), ".");
  std::vector<bool> held(grid.faces);
  for (LocalIndex F = 0; F < grid.faces; ++F) held[F] = grid.face_tag(F) >= 0 && grid.tags[grid.face_tag(F)] == "right";
  const View<double**> r("r", grid.owned_cells, 1), sigma("sigma", grid.faces, 1), rest("rest", grid.owned_cells, 1);
  const double h = 0.04;
  for (LocalIndex K = 0; K < grid.owned_cells; ++K) r(K, 0) = std::sin(static_cast<double>(grid.cell_id[K]));
  FluxLift(grid, held)(r, sigma, rest);
  for (LocalIndex F = 0; F < grid.faces; ++F) {
    const int before = static_cast<int>(std::lround(grid.face_centre(F, 0) / h));
    double sum = 0;
    for (int K = 0; K < before; ++K) sum += h * std::sin(static_cast<double>(K));
    EXPECT_NEAR(sigma(F, 0) * grid.face_normal(F, 0), sum, 1e-11);
  }
}

/// Closed everywhere: div sigma + c rho = r, tested by its sum: the integral of r is that of c rho.
TEST(flux_lift, keeps_in_a_closed_domain_what_can_not_leave) {
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    const Grid grid = sample.make(core::Comm());
    const View<double**> r("r", grid.owned_cells, 1), sigma("sigma", grid.faces, 1), rest("rest", grid.owned_cells, 1);
    Kokkos::deep_copy(r, 2.);
    FluxLift(grid, std::vector<bool>(grid.faces, false))(r, sigma, rest);
    double sum = 0;
    for (LocalIndex K = 0; K < grid.owned_cells; ++K) sum += rest(K, 0);
    for (LocalIndex F = 0; F < grid.faces; ++F) EXPECT_NEAR(sigma(F, 0), 0, 1e-10);
    const Grid all = whole(sample);
    double lower[2] = {1e9, 1e9}, upper[2] = {-1e9, -1e9};
    for (LocalIndex v = 0; v < all.vertices; ++v)
      for (int i = 0; i < 2; ++i) {
        lower[i] = std::min(lower[i], all.vertex(v, i));
        upper[i] = std::max(upper[i], all.vertex(v, i));
      }
    const double D2 = std::pow(upper[0] - lower[0], 2) + std::pow(upper[1] - lower[1], 2);
    EXPECT_NEAR(grid.comm.sum(sum), 4 * sample.volume * D2, 1e-7 * sample.volume * D2);  // rho = 2 D²
  }
}

}  // namespace
}  // namespace thixis::fv
