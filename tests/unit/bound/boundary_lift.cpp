/// The lift of the boundary data: the right values on the boundary, nearly the least energy.
#include "lift/boundary_lift.hpp"

#include "feasible_setting.hpp"

namespace thixis::bound {
namespace {

/// The trace of case S: (r² - R²)^6.
FieldPtr trace(double sign) {
  return scene::formula([sign](double x, double y) {
    const double r2 = (x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5), R2 = 1.0 / 9;
    return r2 < R2 ? 0.0 : sign * std::pow(r2 - R2, 6);
  });
}

double energy(int level, int degree, std::string name = "fem") {
  const auto levels = square(level);
  const auto& mesh = levels.finest();
  const auto V = make_space(mesh, {name, degree});
  const FeasiblePair s(*V, two_membranes(mesh, trace(1), trace(-1), scene::constant(1), scene::constant(1)));
  return s.boundary_energy();
}

/// A lift with all that it is made of.
struct Lifted {
  Lifted(int level, const Setting& setting, const FieldPtr& g1, const FieldPtr& g2)
      : levels(square(level)), V(make_space(levels.finest(), setting)) {
    const auto& mesh = levels.finest();
    const std::array<method::BoundaryValues, 2> boundary = {everywhere(mesh, g1), everywhere(mesh, g2)};
    const ContinuousNodes nodes =
        continuous_nodes(mesh, V->cells(), V->basis(), V->basis().points(), std::vector<bool>(mesh.tags.size(), true));
    const std::vector<double> held[2] = {boundary_coefficients(*V, nodes, boundary[0].dirichlet, 0),
                                         boundary_coefficients(*V, nodes, boundary[1].dirichlet, 0)};
    lift = std::make_unique<BoundaryLift>(*V, nodes, std::array<FieldPtr, 2>{scene::constant(1), scene::constant(2)}, boundary, held, 2);
  }
  mesh::Hierarchy levels;
  std::unique_ptr<Space> V;
  std::unique_ptr<BoundaryLift> lift;
};

}  // namespace

TEST(BoundaryLift, with_the_interpolant_it_takes_the_values_of_the_data) {
  for (const Nodes nodes : {Nodes::gauss_lobatto, Nodes::equispaced, Nodes::bernstein})
    for (int p = 1; p <= 4; ++p) {
      const auto g = scene::formula([](double x, double y) { return std::exp(x - 0.5 * y) * std::sin(3 * x + y); });
      const Lifted lifted(1, {"fem", p, nodes}, g, trace(-1));
      const auto& mesh = lifted.levels.finest();
      const auto host = mesh::on_host(mesh);
      const auto u = interpolated(*lifted.V, scene::constant(0), g);
      Sampler sample(*lifted.V);
      for (LocalIndex k = 0; k < lifted.lift->cells().extent_int(0); ++k) {
        const LocalIndex K = lifted.lift->cells()(k);
        for (int i = 0; i < 3; ++i) {
          if (host.face_tag(host.cell_faces(K, i)) < 0) continue;
          for (int m = 0; m <= 10; ++m) {
            double lambda[3] = {}, value = 0;
            lambda[(i + 1) % 3] = m / 10.0;
            lambda[(i + 2) % 3] = 1 - m / 10.0;
            const PointOfCell at = point_of(host, K, lambda[1], lambda[2]);
            g->evaluate({1, &at.x, &at.y}, 0, &value);
            sample.at(at);
            const double s = sample(sample.coefficients(u, K)).value + (*lifted.lift)(0, k, at.xi, at.eta).value;
            EXPECT_NEAR(s, value, 1e-12);
          }
        }
      }
    }
}

TEST(BoundaryLift, is_continuous_and_vanishes_beyond_its_layer) {
  const Lifted lifted(2, {"fem", 2}, trace(1), trace(-1));
  const auto& mesh = lifted.levels.finest();
  const auto host = mesh::on_host(mesh);
  std::vector<double> seen(mesh.faces, NAN);
  const auto& cells = lifted.lift->cells();
  std::vector<int> visits(mesh.faces, 0);
  double largest = 0;
  for (LocalIndex k = 0; k < cells.extent_int(0); ++k)
    for (int i = 0; i < 3; ++i) {
      const LocalIndex F = host.cell_faces(cells(k), i);
      const bool along = host.face_vertices(F, 0) == host.cell_vertices(cells(k), (i + 1) % 3);
      double lambda[3] = {};
      lambda[(i + 1) % 3] = along ? 0.3 : 0.7;
      lambda[(i + 2) % 3] = along ? 0.7 : 0.3;
      const double value = (*lifted.lift)(0, k, lambda[1], lambda[2]).value;
      largest = std::max(largest, std::abs(value));
      if (visits[F]++ == 0) {
        seen[F] = value;
        continue;
      }
      EXPECT_NEAR(seen[F], value, 1e-15);
    }
  const double size = mesh.comm.max(largest);
  for (LocalIndex F = 0; F < mesh.faces; ++F) {
    const LocalIndex a = host.face_cells(F, 0), b = host.face_cells(F, 1);
    const bool here = a >= 0 && b >= 0 && a < mesh.owned_cells && b < mesh.owned_cells;
    if (here && visits[F] == 1) {
      EXPECT_LT(std::abs(seen[F]), 1e-14 * size);
    }
  }
}

TEST(BoundaryLift, nothing_is_made_for_polynomials) {
  for (int p = 1; p <= 4; ++p) {
    const auto g = scene::formula([p](double x, double y) { return std::pow(x + 0.3 * y, p) - 2 * y; });
    const Lifted lifted(1, {"fem", p}, g, scene::constant(-3));
    EXPECT_TRUE(lifted.lift->empty());
    EXPECT_EQ(lifted.lift->cells().extent(0), 0);
    EXPECT_EQ(lifted.lift->of_cells().place.extent(0), 0);
    EXPECT_EQ(lifted.lift->of_cells().products.extent(0), 0);
    EXPECT_EQ(lifted.lift->energy(), 0);
  }
}

TEST(BoundaryLift, cells_count_what_is_lifted_and_clipped) {
  for (int p = 1; p <= 3; ++p) {
    const Lifted lifted(1, {"fem", p}, trace(1), trace(-1));
    const auto& mesh = lifted.levels.finest();
    const FeasiblePair s(*lifted.V, two_membranes(mesh, trace(1), trace(-1), scene::constant(1), scene::constant(2)));
    EXPECT_NEAR(s.boundary_energy(), lifted.lift->energy(), 1e-12);
    const Coefficients u[2] = {interpolated(*lifted.V, scene::constant(0), trace(1)),
                               interpolated(*lifted.V, scene::constant(0), trace(-1))};
    FeasiblePair::Parts parts;
    s.evaluate(u, density_of(mesh, scene::constant(3), 1), 1, parts);
    std::vector<LocalIndex> place(mesh.owned_cells, -1);
    for (LocalIndex k = 0; k < lifted.lift->cells().extent_int(0); ++k) place[lifted.lift->cells()(k)] = k;
    std::vector<double> whole2(mesh.owned_cells, 0.0), contact(mesh.owned_cells, 0.0);
    Sampler sample(*lifted.V);
    densely(mesh, 32, [&](double weight, const PointOfCell& at) {
      const LocalIndex K = at.cell;
      if (place[K] < 0) return;
      sample.at(at);
      const Sample upper = sample(sample.coefficients(u[0], K)), lower = sample(sample.coefficients(u[1], K));
      const auto L1 = (*lifted.lift)(0, place[K], at.xi, at.eta), L2 = (*lifted.lift)(1, place[K], at.xi, at.eta);
      const double gap = upper.value - lower.value + L1.value - L2.value;
      for (int d = 0; d < 2; ++d) {
        const double slope = gap < 0 ? upper.gradient[d] - lower.gradient[d] + L1.gradient[d] - L2.gradient[d] : 0;
        whole2[K] += weight * (std::pow(L1.gradient[d] - 2 * slope / 3, 2) + 2 * std::pow(L2.gradient[d] + slope / 3, 2));
      }
      contact[K] += weight * 3 * std::max(gap, 0.0);
    });
    double bound = 0, exact = 0;
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
      if (place[K] < 0) continue;
      EXPECT_GT(parts.whole(K), 0.99 * std::sqrt(whole2[K]) - 1e-10);
      EXPECT_NEAR(parts.contact(K), contact[K], 0.01 * contact[K] + 1e-10);
      bound += std::pow(parts.whole(K), 2);
      exact += whole2[K];
    }
    EXPECT_LT(mesh.comm.sum(bound), 4 * mesh.comm.sum(exact));  // lift and move undo each other here: u is 0 inside
  }
}

TEST(BoundaryLift, energy_of_degree_1_is_nearly_the_least) {
  const double least[] = {4.82e-3, 2.39e-3, 9.20e-4, 3.28e-4};
  for (int level = 0; level < 4; ++level) {
    const double lift = energy(level, 1);
    EXPECT_LT(lift, 1.03 * least[level]);
    EXPECT_GT(lift, 0.99 * least[level]);
  }
}

TEST(BoundaryLift, orders) {
  for (int p = 1; p <= 4; ++p) {
    const double order = std::log2(energy(2, p) / energy(3, p));
    EXPECT_GT(order, p + 0.25);
    EXPECT_LT(order, p + 1.25);
  }
}

TEST(BoundaryLift, is_the_same_for_all_methods) {
  for (int p = 1; p <= 2; ++p)
    for (const auto& name : tests::built({"dg", "hho"})) EXPECT_NEAR(energy(1, p), energy(1, p, name), 1e-12);
}

}  // namespace thixis::bound
