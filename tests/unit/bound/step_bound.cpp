/// The equations behind the bound in time, at iterates that solve nothing: the same as without time, with the rate of change among the
/// sources.
#include "thixis/bound/step_bound.hpp"

#include "bound_setting.hpp"

namespace thixis::bound {
namespace {

constexpr double tau = 0.01;

class StepOfBound : public BoundSetting {
 protected:
  /// The iterates of `c` at the end of a step, after those of `before`: the residual takes in the rate of change.
  static void in_time(Case& c, const Case& before) {
    for (int alpha = 0; alpha < c.problem.count; ++alpha) {
      const Coefficients rate("rate", c.u[alpha].extent(0));
      for (std::size_t e = 0; e < rate.extent(0); ++e) rate(e) = (c.u[alpha](e) - before.u[alpha](e)) / tau;
      Vector part(c.V->map());
      method::apply(*method::mass(*c.V), rate, part);
      c.residual[alpha]->update(-1, part, 1);
    }
  }
  /// Another function with the same boundary values.
  static void move(Case& c, double by) {
    for (int alpha = 0; alpha < c.problem.count; ++alpha) {
      Vector values(c.V->map());
      c.V->restrict_to_unknowns(c.u[alpha], values);
      const auto ids = c.V->unknown_ids();
      {
        const auto out = algebra::host_view(values);
        for (std::size_t row = 0; row < out.extent(0); ++row)
          out(row) += by * std::sin(7.13 * static_cast<double>(ids[row] % 10007) + alpha);
      }
      c.u[alpha] = c.V->complete(values, c.V->lift(c.problem.boundary[alpha], 0));
    }
  }
};

TEST_P(StepOfBound, has_fluxes_in_equilibrium_with_the_rate_of_change) {
  struct Data {
    bool varying, neumann;
    int count;
  };
  for (const auto& setting : settings()) {
    if (setting.name == "dg") continue;
    for (const auto& [varying, neumann, count] : {Data{false, false, 2}, Data{true, true, 2}, Data{false, true, 1}}) {
      auto c = arbitrary(setting, varying, neumann, count), before = arbitrary(setting, varying, neumann, count);
      move(before, 0.1);
      in_time(c, before);
      StepBound bound(*c.V, c.problem, levels, level);
      bound.start(0, before.u, {});
      bound.begin(0, tau, before.u);
      const auto eta = bound(c.iterate());
      EXPECT_LE(eta.total, (1 + 1e-12) * (eta.discretization + eta.linearization + eta.algebraic)) << named(setting);
      bound.accept();
      const auto all = bound.so_far();
      EXPECT_LE(all.total, (1 + 1e-12) * (all.discretization + all.linearization + all.algebraic)) << named(setting);
      EXPECT_GE(all.total, eta.total) << named(setting);
      for (int alpha = 0; alpha < count; ++alpha) {
        const Errors e = errors(bound, alpha);
        EXPECT_LE(e.worst(), 1e-10) << named(setting) << (varying ? ", varying tensions" : "") << (neumann ? ", Neumann data" : "")
                                    << ", membrane " << alpha + 1 << " of " << count << ": total " << e.total << ", lin " << e.linearization
                                    << ", alg " << e.algebraic << ", jump " << e.jump;
      }
    }
  }
}

/// Away from the obstacle and without a multiplier s_N is u_h for continuous elements, and what is balanced is f - (u - u_before)/tau.
TEST_P(StepOfBound, takes_the_rate_of_change_from_the_force) {
  for (const auto& setting : settings()) {
    if (setting.name != "fem") continue;
    auto c = arbitrary(setting, false, false, 1, -10), before = arbitrary(setting, false, false, 1, -10);
    move(before, 0.1);
    in_time(c, before);
    StepBound bound(*c.V, c.problem, levels, level);
    bound.begin(0, tau, before.u);
    bound(c.iterate());
    const int q = bound.flux_degree(), n = c.V->basis().size();
    const auto f = density_of(mesh, force(0), q), ours = bound.fluxes(0).density;
    const auto rule = reference::triangle_quadrature(2 * q);
    const auto phi = reference::Modal(q).values(rule.size(), rule.point.data());
    const auto psi = c.V->basis().tabulate(rule.size(), rule.point.data());
    const auto host = mesh::on_host(mesh);
    double worst = 0, size = 0;
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
      for (int m = 0; m < n; ++m) {
        double expected = f(K, m);
        for (int g = 0; g < rule.size(); ++g) {
          double change = 0;
          for (int l = 0; l < n; ++l) {
            const LocalIndex e = c.V->coefficients().element_entries(K, l);
            change += psi.value[g * n + l] * (c.u[0](e) - before.u[0](e));
          }
          expected -= 2 * mesh::cell_area(host.coordinates, host.cell_vertices, K) * rule.weight[g] * phi[g * n + m] * change / tau;
        }
        worst = std::max(worst, std::abs(expected - ours(K, m)));
        size = std::max(size, std::abs(expected));
      }
    EXPECT_LE(mesh.comm.max(worst), 1e-11 * mesh.comm.max(size)) << named(setting);
  }
}

/// Where nothing changes over a step the bound is that without time, times the root of the step.
TEST_P(StepOfBound, is_the_stationary_bound_where_nothing_changes) {
  for (const auto& setting : settings()) {
    if (setting.name == "dg") continue;
    const auto c = arbitrary(setting, false, true, 2);
    GuaranteedBound stationary(*c.V, c.problem, levels, level);
    StepBound bound(*c.V, c.problem, levels, level);
    bound.begin(0, tau, c.u);
    const auto steady = stationary(c.iterate()), eta = bound(c.iterate());
    EXPECT_NEAR(eta.total, std::sqrt(tau) * steady.total, 2e-3 * std::sqrt(tau) * steady.total) << named(setting);
    EXPECT_NEAR(eta.algebraic, std::sqrt(tau) * steady.algebraic, 1e-9 * eta.algebraic) << named(setting);
  }
}

/// Data that do not belong together are not balanced: a residual without the rate of change.
TEST_P(StepOfBound, does_not_balance_the_residual_of_another_step) {
  for (const auto& setting : settings()) {
    if (setting.name == "dg") continue;
    auto c = arbitrary(setting, false, false, 2), before = arbitrary(setting, false, false, 2);
    move(before, 0.1);
    StepBound bound(*c.V, c.problem, levels, level);
    bound.begin(0, tau, before.u);
    bound(c.iterate());
    EXPECT_GT(std::max(errors(bound, 0).worst(), errors(bound, 1).worst()), 1e-5) << named(setting);
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, StepOfBound, ::testing::Values("criss-cross", "disk", "refined file", "adaptive square"), underscored);

}  // namespace
}  // namespace thixis::bound
