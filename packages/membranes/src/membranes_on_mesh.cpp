#include "membranes_on_mesh.hpp"

#include "exact_gradient.hpp"

namespace thixis::membranes {

double squared_energy(const MembraneLevel& level, const Pair& now) {
  double sum = 0;
  for (int alpha = 0; alpha < level.count(); ++alpha) sum += level.space().energy(*level.scene().tension[alpha], now.u[alpha]);
  return sum;
}

double squared_energy_error(const MembraneLevel& level, const Pair& now, double t) {
  const MembraneScene& scene = level.scene();
  double sum = 0;
  for (int alpha = 0; alpha < level.count(); ++alpha)
    sum += level.space().energy_error(*scene.tension[alpha], now.u[alpha], exact_gradient(*scene.exact, alpha, level.space().mesh()), t);
  return sum;
}

}  // namespace thixis::membranes
