#include "level/membranes_on_mesh.hpp"

#include "scene/exact_gradient.hpp"

namespace thixis::membranes {

double squared_energy(const MembraneLevel& level, const Pair& now) {
  double sum = 0;
  for (int alpha = 0; alpha < level.count(); ++alpha) sum += method::energy(*level.forms()[alpha], now.u[alpha]);
  return sum;
}

double squared_energy_error(const MembraneLevel& level, const Pair& now, double t) {
  const MembraneScene& scene = level.scene();
  double sum = 0;
  for (int alpha = 0; alpha < level.count(); ++alpha)
    sum += method::energy_error(*level.forms()[alpha], now.u[alpha],
                                {method::Known{exact_gradient(*scene.exact, alpha, level.space().mesh())}}, t);
  return sum;
}

}  // namespace thixis::membranes
