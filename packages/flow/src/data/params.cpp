#include "thixis/flow/params.hpp"

namespace thixis::flow {
namespace {

template <class P>
core::Schema<P> with_state(core::Schema<P> schema) {
  return schema.parameter("S", &P::S, "Saturation of the liquid; without it 1 - s_g.")
      .parameter("s_g", &P::s_g, "Saturation of the gas; without it and S, 0.")
      .parameter("P", &P::P, "Pressure of the liquid [Pa]; without it 1e6.")
      .parameter("chi", &P::chi, "Molar fraction of the hydrogen that is dissolved in the water; without it 0.");
}

}  // namespace

const core::Schema<FlowStateParams>& FlowStateParams::schema() {
  static const auto s = with_state(core::Schema<FlowStateParams>(
      "initial", "The state at time 0: numbers or expressions of x, y [m], r (distance to the origin), pi and the constants."));
  return s;
}

const core::Schema<FlowBoundaryParams>& FlowBoundaryParams::schema() {
  static const auto s =
      with_state(core::Schema<FlowBoundaryParams>("boundary",
                                                  "One sublist per boundary tag; nothing flows through other parts. Functions of one part "
                                                  "may depend on the place on it, e.g. y < 5 ? 1e-6 : 0.")
                     .choice("kind", &FlowBoundaryParams::kind,
                             {{"no-flow", FlowBoundaryKind::no_flow}, {"flux", FlowBoundaryKind::flux}, {"state", FlowBoundaryKind::state}},
                             "no-flow: closed; flux: water and hydrogen enter at given rates, taken at the middle of a step; state: the "
                             "state outside is given, S or s_g, P and chi, taken at the end of a step.")
                     .parameter("water", &FlowBoundaryParams::water,
                                "Of kind flux: water that enters [kg/m² and unit of time (time/unit)]; without it 0.")
                     .parameter("hydrogen", &FlowBoundaryParams::hydrogen,
                                "Of kind flux: hydrogen that enters [kg/m² and unit of time (time/unit)]; without it 0."));
  return s;
}

const core::Schema<FlowParams>& FlowParams::schema() {
  using P = FlowParams;
  static const auto s =
      core::Schema<P>("flow",
                      "Two-phase flow of water and hydrogen: rock, fluids, and what drives them; with a case, what is changed of it. SI "
                      "units, rates per time/unit. Defaults are the data of the gas injection benchmark of MoMaS.")
          .parameter("porosity", &P::porosity, core::strictly_between(0, 1), "phi, the share of the rock that fluids fill.")
          .parameter("permeability", &P::permeability, core::at_least(1e-30), "K [m²] of the rock; the tightest have 1e-24.")
          .parameter("viscosity of water", &P::viscosity_water, core::above(0), "mu_l [Pa s].")
          .parameter("viscosity of hydrogen", &P::viscosity_hydrogen, core::above(0), "mu_g [Pa s].")
          .parameter("density of water", &P::density_water, core::above(0), "rho_w [kg/m³].")
          .parameter("diffusion", &P::diffusion, core::at_least(0), "D [m²/s] of hydrogen dissolved in water.")
          .parameter("molar mass of water", &P::molar_mass_water, core::above(0), "M_w [kg/mol].")
          .parameter("molar mass of hydrogen", &P::molar_mass_hydrogen, core::above(0), "M_h [kg/mol].")
          .parameter("henry", &P::henry, core::above(0),
                     "Henry's constant [mol/(Pa m³)]: hydrogen that water dissolves per pressure of the gas.")
          .parameter("temperature", &P::temperature, core::above(0), "T [K].")
          .parameter("n", &P::n, core::above(1), "Exponent of van Genuchten's laws.")
          .parameter("P_r", &P::P_r, core::above(0), "Pressure of van Genuchten's capillary law [Pa].")
          .parameter("S_lr", &P::S_lr, core::between(0, 1), "Residual saturation of the liquid.")
          .parameter("S_gr", &P::S_gr, core::between(0, 1), "Residual saturation of the gas.")
          .parameter("regularization", &P::regularization, core::strictly_between(0, 0.1),
                     "eps: capillary pressure and permeability of the liquid, which have infinite slopes where the effective saturation is "
                     "1, are straight lines from 1 - eps on.")
          .choice("capillary law", &P::capillary_law,
                  {{"van genuchten", CapillaryLaw::van_genuchten}, {"quadratic", CapillaryLaw::quadratic}},
                  "van genuchten, or quadratic in s_g up to 0.1, with value and slope of van Genuchten's law there; not given: that of the "
                  "case, or van genuchten.")
          .parameter("gravity", &P::gravity, core::Range().entries(2),
                     "Two components [m/s²], e.g. {0,-9.81}; not given: that of the case, or none.")
          .block("initial", &P::initial, FlowStateParams::schema())
          .parameter("water source", &P::water_source, "Water that is made [kg/m³ and unit of time (time/unit)]; without it 0.")
          .parameter("hydrogen source", &P::hydrogen_source, "Hydrogen that is made [kg/m³ and unit of time (time/unit)]; without it 0.")
          .blocks("boundary", &P::boundary, FlowBoundaryParams::schema())
          .values("constants", &P::constants, "Named numbers that the expressions of this block may use.");
  return s;
}

const core::Schema<SceneParams>& SceneParams::schema() {
  static const auto s = core::Schema<SceneParams>("scene", "Flow.").block("flow", &SceneParams::flow, FlowParams::schema());
  return s;
}

const core::Schema<ExpectParams>& ExpectParams::schema() {
  static const auto s =
      core::Schema<ExpectParams>("expect", "Flow.")
          .parameter("water balance at most", &ExpectParams::water_balance_at_most, core::above(0),
                     "Largest defect of a step in the mass of water, relative to the water in place.")
          .parameter("hydrogen balance at most", &ExpectParams::hydrogen_balance_at_most, core::above(0),
                     "Largest defect of a step in the mass of hydrogen, relative to what was injected.")
          .parameter("front between", &ExpectParams::front_between, "Smallest and largest position of the gas front at the end.")
          .check([](const ExpectParams& params, core::Problems& problems) {
            models::check_pair(params.front_between, "front between", problems);
          });
  return s;
}

}  // namespace thixis::flow
