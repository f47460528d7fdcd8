/// The equations that make the bound a bound, at iterates that solve nothing: fluxes in equilibrium with data and multiplier, residuals
/// that are taken up by their own fluxes, a multiplier that is nowhere negative.
#include "bound_setting.hpp"

namespace thixis::bound {
namespace {

class Bound : public BoundSetting {
 protected:
  /// The least value of a density on a lattice in all cells, over the largest.
  double least(const ConstCellTable& density, int q) const {
    double low = 0, high = 1e-300;
    const reference::Modal modal(q);
    constexpr int sides = 7;
    std::vector<double> points;
    for (int i = 0; i <= sides; ++i)
      for (int j = 0; i + j <= sides; ++j) points.insert(points.end(), {double(i) / sides, double(j) / sides});
    const int count = static_cast<int>(points.size() / 2);
    const auto phi = modal.values(count, points.data());
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
      for (int point = 0; point < count; ++point) {
        double value = 0;
        for (int m = 0; m < modal.size(); ++m) value += phi[point * modal.size() + m] * density(K, m);
        low = std::min(low, value);
        high = std::max(high, value);
      }
    return mesh.comm.min(low) / mesh.comm.max(high);
  }
};

TEST_P(Bound, has_fluxes_in_equilibrium_with_data_and_multiplier_and_with_the_residuals) {
  struct Data {
    bool varying, neumann;
    int count;
  };
  for (const auto& setting : settings())
    for (const auto& [varying, neumann, count] : {Data{false, false, 2}, Data{true, true, 2}, Data{false, true, 1}}) {
      const auto c = arbitrary(setting, varying, neumann, count);
      GuaranteedBound bound(*c.V, c.problem, levels, level);
      const auto eta = bound(c.iterate());
      EXPECT_LE(eta.total, (1 + 1e-12) * (eta.discretization + eta.linearization + eta.algebraic)) << named(setting);
      for (int alpha = 0; alpha < count; ++alpha) {
        const Errors e = errors(bound, alpha);
        EXPECT_LE(e.worst(), 1e-10) << named(setting) << (varying ? ", varying tensions" : "") << (neumann ? ", Neumann data" : "")
                                    << ", membrane " << alpha + 1 << " of " << count << ": total " << e.total << ", lin " << e.linearization
                                    << ", alg " << e.algebraic << ", jump " << e.jump;
      }
    }
}

/// What one membrane gains the other one loses.
TEST_P(Bound, takes_the_sum_of_the_forces_whatever_the_multiplier_is) {
  for (const auto& setting : settings()) {
    const auto c = arbitrary(setting, false, true, 2);
    GuaranteedBound bound(*c.V, c.problem, levels, level);
    bound(c.iterate());
    const int q = bound.flux_degree();
    const ConstCellTable upper = bound.fluxes(0).density, lower = bound.fluxes(1).density, f1 = density_of(mesh, force(0), q),
                         f2 = density_of(mesh, force(1), q);
    double worst = 0, size = 0;
    for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
      for (int m = 0; m < f1.extent_int(1); ++m) {
        worst = std::max(worst, std::abs(upper(K, m) + lower(K, m) - f1(K, m) - f2(K, m)));
        size = std::max(size, std::abs(f1(K, m)));
      }
    EXPECT_LE(mesh.comm.max(worst), 1e-12 * mesh.comm.max(size)) << named(setting);
  }
}

/// The density of membrane 1 minus that without a multiplier.
TEST_P(Bound, has_a_multiplier_that_is_nowhere_negative) {
  for (const auto& setting : settings()) {
    if (setting.name != "fem") continue;
    const auto c = arbitrary(setting, false, true, 2);
    auto none = arbitrary(setting, false, true, 2, -10);
    GuaranteedBound bound(*c.V, c.problem, levels, level), without(*none.V, none.problem, levels, level);
    bound(c.iterate());
    without(none.iterate());
    const auto with_it = bound.fluxes(0).density, force = without.fluxes(0).density;
    const CellTable lambda("lambda", with_it.extent(0), with_it.extent(1));
    double size = 0;
    for (std::size_t K = 0; K < lambda.extent(0); ++K)
      for (int m = 0; m < lambda.extent_int(1); ++m) {
        lambda(K, m) = with_it(K, m) - force(K, m);
        size = std::max(size, std::abs(lambda(K, m)));
      }
    double most = 0;  // of a mesh with one free vertex the only multiplier may be negative
    for (const double value : c.lambda->getData()) most = std::max(most, value);
    if (mesh.comm.max(most) > 0.1) {
      EXPECT_GT(mesh.comm.max(size), 1e-6) << named(setting);
    }
    EXPECT_GE(least(lambda, bound.flux_degree()), -1e-12) << named(setting);
  }
}

/// What is wrong with the data shows: a residual that is not that of the iterate, another multiplier, another field.
TEST_P(Bound, does_not_balance_data_that_do_not_belong_together) {
  for (const auto& setting : settings()) {
    for (int what = 0; what < 2; ++what) {
      auto c = arbitrary(setting, false, false, 2);
      GuaranteedBound bound(*c.V, c.problem, levels, level);
      bound(c.iterate());
      const double right = std::max(errors(bound, 0).worst(), errors(bound, 1).worst());
      {
        auto& wrong = what == 0 ? *c.residual[0] : *c.lambda;
        const auto values = algebra::host_view(wrong);
        for (std::size_t l = 0; l < values.extent(0); ++l) values(l) += 0.1 * (1 + std::abs(values(l)));
      }
      bound(c.iterate());
      EXPECT_LT(right, 1e-10) << named(setting);
      EXPECT_GT(std::max(errors(bound, 0).worst(), errors(bound, 1).worst()), 1e-5) << named(setting) << ", " << what;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, Bound,
                         ::testing::Values("criss-cross", "disk", "file", "refined file", "adaptive square", "adaptive disk"), underscored);

}  // namespace
}  // namespace thixis::bound
