/// The lift of the boundary data: the right values on the boundary, nearly the least energy.
#include "boundary_lift.hpp"

#include "feasible_setting.hpp"

namespace thixis::equilibration {
namespace {

/// The trace of case S: (r² - R²)^6.
FieldPtr trace(double sign) {
  return scene::formula([sign](double x, double y) {
    const double r2 = (x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5), R2 = 1.0 / 9;
    return r2 < R2 ? 0.0 : sign * std::pow(r2 - R2, 6);
  });
}

double energy(int level, int degree, MethodName name = MethodName::fem) {
  const auto levels = square(level);
  const auto& mesh = levels.finest();
  const auto V = make_space(mesh, {name, degree});
  const FeasiblePair s(*V, two_membranes(mesh, trace(1), trace(-1), scene::constant(1), scene::constant(1)));
  return s.boundary_energy();
}

}  // namespace

TEST(BoundaryLift, energy_of_degree_1_is_nearly_the_least) {
  const double least[] = {4.82e-3, 2.39e-3, 9.20e-4, 3.28e-4};
  for (int level = 0; level < 4; ++level) {
    const double lift = energy(level, 1);
    std::cout << "lift " << lift << " " << lift / least[level] << std::endl;
    EXPECT_LT(lift, 1.03 * least[level]);
    EXPECT_GT(lift, 0.9 * least[level]);
  }
}

TEST(BoundaryLift, orders) {
  for (int p = 1; p <= 4; ++p) {
    const double order = std::log2(energy(2, p) / energy(3, p));
    EXPECT_GT(order, p + 0.25);
    EXPECT_LT(order, p + 1.25);
    std::cout << "order " << p << " " << order << std::endl;
  }
}

TEST(BoundaryLift, is_the_same_for_all_methods) {
  for (int p = 1; p <= 2; ++p)
    for (const MethodName name : {MethodName::dg, MethodName::hho}) EXPECT_NEAR(energy(1, p), energy(1, p, name), 1e-12);
}

}  // namespace thixis::equilibration
