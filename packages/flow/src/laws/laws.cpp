#include "laws/laws.hpp"

#include "thixis/core/error.hpp"

namespace thixis::flow {
namespace {

constexpr double gas_constant = 8.314;  // J/(mol K)

/// From here on P_cp and k_rl are lines, down to e = 0.
void set_wet_end(TwoPhaseLaws& laws) {
  laws.slope_wet_c = laws.true_capillary(laws.eps).value / laws.eps;
  laws.slope_wet_l = (1 - laws.true_k_rl(laws.eps).value) / laws.eps;
}

void set_dry_end(TwoPhaseLaws& laws) {
  laws.dry_c = laws.true_capillary(TwoPhaseLaws::dry);
  laws.dry_g = laws.true_k_rg(TwoPhaseLaws::dry);
}

/// a s + b s² has value and slope of van Genuchten's law at s = end, and vanishes at 0.
void set_quadratic(TwoPhaseLaws& laws, bool wanted) {
  const double end = TwoPhaseLaws::end_of_quadratic;
  laws.quadratic = false;
  const Law P = laws.capillary(end);
  laws.a = 2 * P.value / end - P.slope;
  laws.b = (P.slope - P.value / end) / end;
  laws.quadratic = wanted;
  if (wanted && !(laws.a > 0))
    throw core::InputError(
        "scene/flow/capillary law: with these S_lr, S_gr, n the quadratic law that meets van Genuchten's at s_g = 0.1 would fall; write "
        "van "
        "genuchten.");
}

}  // namespace

TwoPhaseLaws two_phase_laws(const TwoPhaseScene& scene) {
  const RockAndFluids& given = scene.medium;
  TwoPhaseLaws laws{};
  laws.porosity = given.porosity;
  laws.permeability = given.permeability;
  laws.viscosity_l = given.viscosity_water;
  laws.viscosity_g = given.viscosity_hydrogen;
  laws.rho_w = given.density_water;
  laws.diffusion = given.diffusion;
  laws.H = given.henry * given.molar_mass_hydrogen;
  laws.beta_l = given.density_water * given.molar_mass_hydrogen / given.molar_mass_water;
  laws.beta_g = given.molar_mass_hydrogen / (gas_constant * given.temperature);
  for (int i = 0; i < 2; ++i) laws.gravity[i] = scene.gravity[i];
  laws.n = given.n;
  laws.m = 1 - 1 / given.n;
  laws.P_r = given.P_r;
  laws.S_gr = given.S_gr;
  laws.width = 1 - given.S_lr - given.S_gr;
  laws.eps = given.regularization;
  set_wet_end(laws);
  set_dry_end(laws);
  set_quadratic(laws, scene.capillary_law == CapillaryLaw::quadratic);
  return laws;
}

}  // namespace thixis::flow
