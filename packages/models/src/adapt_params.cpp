#include "thixis/models/params.hpp"

namespace thixis::models {
namespace {

core::Range above_0_up_to_1() {
  core::Range range = core::between(0, 1);
  range.lower_open = true;
  return range;
}

}  // namespace

const core::Schema<AdaptParams>& AdaptParams::schema() {
  static const auto schema =
      core::Schema<AdaptParams>("adapt",
                                "How the mesh is refined until the bound on the error is at most stopping/target; without a target, "
                                "as far as the limits allow.")
          .choice("marking", &AdaptParams::marking, {{"dorfler", Marking::dorfler}, {"uniform", Marking::uniform}},
                  "The fewest cells with a given share of the squared discretization error, or all cells.")
          .parameter("theta", &AdaptParams::theta, above_0_up_to_1(),
                     "Share of marking = dorfler: the marked cells hold theta² of the squared discretization error.")
          .parameter("max levels", &AdaptParams::max_levels, core::at_least(0), "Meshes that are added to those of the deck at most.")
          .parameter("max unknowns", &AdaptParams::max_unknowns, core::at_least(1),
                     "No mesh with more unknowns is solved, the multiplier counted.");
  return schema;
}

}  // namespace thixis::models
