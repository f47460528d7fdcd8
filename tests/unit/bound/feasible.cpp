/// The feasible pair of conforming spaces: exact where nothing has to be done, a tight bound from above elsewhere.
#include "thixis/bound/feasible.hpp"

#include <chrono>

#include "feasible_setting.hpp"

namespace thixis::bound {
namespace {

class Feasible : public ::testing::TestWithParam<Setting> {
 protected:
  mesh::Hierarchy levels = square(1);
  const mesh::Mesh& mesh = levels.finest();
  const core::Comm& comm = mesh.comm;
  std::unique_ptr<Space> V = make_space(mesh, GetParam());
  const int p = GetParam().degree;

  /// Energies and contact term of s by brute force.
  struct Dense {
    std::vector<double> whole2, at_nodes2, rest2, contact;
  };
  Dense dense(const Coefficients (&u)[2], double mu1, double mu2, const FieldPtr& lambda, int sides) const {
    const double theta1 = mu2 / (mu1 + mu2), theta2 = mu1 / (mu1 + mu2);
    Sampler sample(*V);
    Dense d;
    for (auto* v : {&d.whole2, &d.at_nodes2, &d.rest2, &d.contact}) v->assign(mesh.owned_cells, 0.0);
    densely(mesh, sides, [&](double weight, const PointOfCell& at) {
      const LocalIndex K = at.cell;
      auto gap = sample.coefficients(u[0], K), below = gap, kept = gap;
      const auto lower = sample.coefficients(u[1], K);
      for (std::size_t l = 0; l < gap.size(); ++l) {
        gap[l] -= lower[l];
        below[l] = std::max(-gap[l], 0.0);
        kept[l] = std::max(gap[l], 0.0);
      }
      sample.at(at);
      const Sample nodes = sample(below), left = sample(kept);
      for (int i = 0; i < 2; ++i) {
        const double mu = i == 0 ? mu1 : mu2, theta = i == 0 ? theta1 : theta2;
        for (int k = 0; k < 2; ++k) {
          const double n = theta * nodes.gradient[k], m = left.value < 0 ? -theta * left.gradient[k] : 0;
          d.at_nodes2[K] += weight * mu * n * n;
          d.rest2[K] += weight * mu * m * m;
          d.whole2[K] += weight * mu * (n + m) * (n + m);
        }
      }
      double value = 0;
      lambda->evaluate({1, &at.x, &at.y}, 0, &value);
      d.contact[K] += weight * value * std::max(left.value, 0.0);
    });
    return d;
  }
};

std::string name_of(const ::testing::TestParamInfo<Setting>& info) {
  const Setting& s = info.param;
  return std::string(s.name == "fem"  ? "fem"
                     : s.name == "dg" ? "dg"
                                      : "hho") +
         std::to_string(s.degree) + (s.nodes == Nodes::bernstein ? "_bernstein" : "");
}

}  // namespace

TEST_P(Feasible, nothing_is_done_to_a_feasible_pair_with_polynomial_data) {
  const auto u1 = scene::formula([this](double x, double y) { return 1.5 + std::pow(x - 0.3 * y, p); });
  const auto u2 = scene::formula([](double x, double y) { return x - y; });
  const FeasiblePair s(*V, two_membranes(mesh, u1, u2, scene::constant(1), scene::constant(3)));
  EXPECT_EQ(s.boundary_energy(), 0);
  const auto force = scene::formula([](double x, double y) { return x + 2 * y; });
  FeasiblePair::Parts parts;
  s.evaluate({interpolated(*V, u1), interpolated(*V, u2)}, density_of(mesh, force, 1), 1, parts);
  EXPECT_LT(sum_of(comm, parts.whole), 1e-12);
  EXPECT_LT(sum_of(comm, parts.at_nodes), 1e-13);
  EXPECT_LT(sum_of(comm, parts.rest), 1e-12);
  double exact = 0;
  at_points(mesh, 8, [&](double weight, const PointOfCell& at) {
    exact += weight * (at.x + 2 * at.y) * (1.5 + std::pow(at.x - 0.3 * at.y, p) - at.x + at.y);
  });
  EXPECT_NEAR(sum_of(comm, parts.contact), comm.sum(exact), 1e-12);
}

TEST_P(Feasible, a_free_boundary_across_the_cells_is_bounded_from_above_and_tightly) {
  const double mu1 = 1, mu2 = 3;
  const auto u1 = scene::formula([](double x, double y) { return std::hypot(x - 0.45, y - 0.53) - 0.3 + 0.3 * x; });
  const auto u2 = scene::formula([](double x, double) { return 0.3 * x; });
  const FeasiblePair s(*V, two_membranes(mesh, scene::constant(1), scene::constant(0), scene::constant(mu1), scene::constant(mu2)));
  const auto force = scene::formula([](double x, double y) { return 1 + x * y; });
  const Coefficients u[2] = {interpolated(*V, u1, scene::constant(1)), interpolated(*V, u2, scene::constant(0))};
  FeasiblePair::Parts parts;
  s.evaluate(u, density_of(mesh, force, 2), 2, parts);
  const Dense exact = dense(u, mu1, mu2, force, 24);
  double rest2 = 0, rest2_exact = 0, contact = 0, contact_exact = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
    // where the curve only grazes a cell the dense sum misses a sliver or two of its 576
    const double sliver = 0.05 * (exact.at_nodes2[K] + exact.rest2[K]) + 1e-10;
    EXPECT_GE(std::pow(parts.whole(K), 2), exact.whole2[K] - sliver);
    EXPECT_NEAR(std::pow(parts.at_nodes(K), 2), exact.at_nodes2[K], 2e-2 * exact.at_nodes2[K] + 1e-13);
    EXPECT_GE(std::pow(parts.rest(K), 2), exact.rest2[K] - sliver);
    EXPECT_GE(parts.contact(K), exact.contact[K] * (1 - 2e-3) - 1e-13);
    rest2 += std::pow(parts.rest(K), 2);
    rest2_exact += exact.rest2[K];
    contact += parts.contact(K);
    contact_exact += exact.contact[K];
  }
  rest2 = comm.sum(rest2);
  rest2_exact = comm.sum(rest2_exact);
  if (p == 1 || GetParam().nodes == Nodes::bernstein) {
    EXPECT_LT(rest2, 1e-25);
  }
  EXPECT_LT(rest2, (p == 3 ? 1.45 : 1.2) * rest2_exact + 1e-12);
  EXPECT_LT(comm.sum(contact), 1.002 * comm.sum(contact_exact));
}

TEST_P(Feasible, gaps_of_noise_cost_noise) {
  const auto u1 = scene::formula([](double x, double y) { return x * y + 1e-16 * std::sin(1e5 * (x + y)); });
  const auto u2 = scene::formula([](double x, double y) { return x * y; });
  const FeasiblePair s(*V, two_membranes(mesh, scene::constant(1), scene::constant(0), scene::constant(1), scene::constant(1)));
  const auto force = scene::constant(1);
  FeasiblePair::Parts parts;
  const auto held = scene::formula([](double x, double y) { return x * y; });
  s.evaluate({interpolated(*V, u1, held), interpolated(*V, u2, held)}, density_of(mesh, force, 0), 0, parts);
  EXPECT_LT(sum_of(comm, parts.whole, 2), 1e-24);
  EXPECT_LT(sum_of(comm, parts.contact), 1e-15);
}

TEST_P(Feasible, varying_tensions_give_the_energies_of_constant_ones_where_they_agree) {
  const auto u1 = scene::formula([](double x, double y) { return std::sin(5 * x + 4 * y); });
  const auto u2 = scene::constant(0);
  const auto force = scene::constant(2);
  const Coefficients u[2] = {interpolated(*V, u1, scene::constant(1)), interpolated(*V, u2, scene::constant(0))};
  FeasiblePair::Parts constant, varying;
  const FeasiblePair s(*V, two_membranes(mesh, scene::constant(1), scene::constant(0), scene::constant(2), scene::constant(5)));
  s.evaluate(u, density_of(mesh, force, 0), 0, constant);
  const FeasiblePair same(*V,
                          two_membranes(mesh, scene::constant(1), scene::constant(0), scene::formula([](double, double) { return 2.0; }),
                                        scene::formula([](double, double) { return 5.0; })));
  same.evaluate(u, density_of(mesh, force, 0), 0, varying);
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
    EXPECT_NEAR(constant.whole(K), varying.whole(K), 1e-11);
    EXPECT_NEAR(constant.at_nodes(K), varying.at_nodes(K), 1e-11);
    EXPECT_NEAR(constant.rest(K), varying.rest(K), 1e-11);
    EXPECT_NEAR(constant.contact(K), varying.contact(K), 1e-12);
  }
}

TEST_P(Feasible, nothing_happens_in_cells_without_violation_and_the_time_is_recorded) {
  const auto fine = square(4);
  const auto space = make_space(fine.finest(), GetParam());
  const auto u1 = scene::formula([](double x, double y) { return 1 + x * y; });
  const FeasiblePair s(*space,
                       two_membranes(fine.finest(), scene::constant(1), scene::constant(0), scene::constant(1), scene::constant(1)));
  FeasiblePair::Parts parts;
  const Coefficients u[2] = {interpolated(*space, u1, scene::constant(1)), interpolated(*space, scene::constant(0))};
  const auto lambda = density_of(fine.finest(), scene::constant(1), p);
  s.evaluate(u, lambda, p, parts);
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 10; ++i) s.evaluate(u, lambda, p, parts);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_EQ(sum_of(comm, parts.at_nodes), 0);
  RecordProperty("nanoseconds_per_cell", static_cast<int>(1e8 * seconds / fine.finest().owned_cells));
}

INSTANTIATE_TEST_SUITE_P(Degrees, Feasible,
                         ::testing::Values(Setting{"fem", 1}, Setting{"fem", 2}, Setting{"fem", 3}, Setting{"fem", 4},
                                           Setting{"fem", 3, Nodes::bernstein}),
                         name_of);

}  // namespace thixis::bound
