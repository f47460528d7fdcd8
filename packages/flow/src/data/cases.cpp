#include "data/cases.hpp"

#include <cmath>

#include "thixis/core/error.hpp"

namespace thixis::flow {
namespace {

using scene::constant;
using scene::FieldPtr;
using scene::formula;

constexpr double injected = 5.57e-6;                     // hydrogen [kg/(m^2 year)]
constexpr double end_of_injection = 5e5;                 // years
constexpr double end_of_source = 500;                    // years
constexpr double P_0 = 1e6;                              // Pa
constexpr double height_2d = 20, height_of_column = 20;  // m

FlowState water_at(const FieldPtr& P) { return {constant(0), P, constant(0)}; }

/// P_0 at the height `top` above, growing downwards with the weight of the water; `up` is the coordinate that points against gravity.
template <class Up>
FieldPtr hydrostatic(double rho_w, double g, double top, Up up) {
  return formula([=](double x, double y) { return P_0 + rho_w * g * (top - up(x, y)); });
}

/// Water at rest, which hydrogen enters on the left; the right side is held.
void inject(TwoPhaseScene& scene, const FieldPtr& P, const FieldPtr& hydrogen) {
  scene.time_unit = "year";
  scene.jumps = {end_of_injection};
  scene.initial = water_at(P);
  FlowBoundary& left = scene.boundary["left"];
  left.kind = FlowBoundaryKind::flux;
  left.water = constant(0);
  left.hydrogen = hydrogen;
  FlowBoundary& right = scene.boundary["right"];
  right.kind = FlowBoundaryKind::state;
  right.state = scene.initial;
}

void gas_injection(TwoPhaseScene& scene) {
  inject(scene, constant(P_0), formula([](double, double, double t) { return t < end_of_injection ? injected : 0.0; }));
}

void gas_injection_2d(TwoPhaseScene& scene) {
  const auto lowest_quarter = [](double, double y, double t) { return y < height_2d / 4 && t < end_of_injection ? 4 * injected : 0.0; };
  inject(scene, hydrostatic(scene.medium.density_water, -scene.gravity[1], height_2d, [](double, double y) { return y; }),
         formula(lowest_quarter));
}

/// x points upwards. Without gas somewhere a closed column of incompressible water would have no definite pressure: there is a cap of
/// gas at the top. The volume of all gas stays what it is; that at the foot comes, goes, and gathers at the top.
void closed_column(TwoPhaseScene& scene) {
  const auto in_cap = [](double x) { return x > 18; };
  scene.time_unit = "year";
  scene.initial = {formula([=](double x, double) { return in_cap(x) ? 0.01 : 0.0; }),
                   hydrostatic(scene.medium.density_water, -scene.gravity[0], height_of_column, [](double x, double) { return x; }),
                   formula([=](double x, double) { return in_cap(x) ? 1e-4 : 3e-5; })};
  scene.hydrogen_source = formula([](double x, double, double t) { return x < 1 && t < end_of_source ? 2e-5 : 0.0; });
  scene.jumps = {end_of_source};
}

}  // namespace

const std::vector<models::Case>& cases() {
  static const std::vector<models::Case> all = {
      {"gas injection",
       "Interval of 200 m: hydrogen enters water in clay on the left for 5e5 years, a gas phase appears and is gone by 7e5 years (MoMaS)."},
      {"gas injection short",
       "Interval of 200 m: as 'gas injection' with a quadratic capillary law near S = 1; published Newton counts until 5e5 years."},
      {"gas injection 2d", "200 m x 20 m, with gravity: hydrogen enters through the lowest quarter of the left side for 5e5 years."},
      {"closed column",
       "Interval of 20 m, upright, closed: hydrogen made at the foot becomes gas there, which dissolves again and gathers at the top."}};
  return all;
}

TwoPhaseScene catalogue(const std::string& name, const FlowParams& given) {
  TwoPhaseScene scene;
  scene.name = name;
  for (const models::Case& known : cases())
    if (known.name == name) scene.sentence = known.sentence;
  scene.medium = given;
  if (name == "gas injection short") scene.capillary_law = CapillaryLaw::quadratic;
  if (name == "gas injection 2d") scene.gravity = {0, -9.81};
  if (name == "closed column") scene.gravity = {-9.81, 0};
  if (given.capillary_law) scene.capillary_law = *given.capillary_law;
  if (!given.gravity.empty()) scene.gravity = {given.gravity[0], given.gravity[1]};

  if (name == "gas injection" || name == "gas injection short") gas_injection(scene);
  else if (name == "gas injection 2d") gas_injection_2d(scene);
  else if (name == "closed column") closed_column(scene);
  else throw core::InputError("'" + name + "' is no catalogued case of two-phase flow.");
  return scene;
}

}  // namespace thixis::flow
