#include "thixis/flow/scene.hpp"

#include "data/cases.hpp"
#include "data/examine.hpp"
#include "thixis/core/error.hpp"

namespace thixis::flow {
namespace {

using scene::constant;
using scene::expression;
using scene::FieldPtr;

/// s_g = 1 - S.
class Complement final : public scene::Field {
 public:
  explicit Complement(FieldPtr S) : S_(std::move(S)) {}
  void evaluate(const scene::Points& points, double t, double* values) const override {
    S_->evaluate(points, t, values);
    for (std::size_t i = 0; i < points.count; ++i) values[i] = 1 - values[i];
  }

 private:
  FieldPtr S_;
};

/// Reads the expressions of one deck over what is there already.
struct Reader {
  const std::map<std::string, double>& constants;

  void operator()(const std::string& path, const core::Formula& formula, FieldPtr& field) const {
    if (!formula.empty()) field = expression("scene/flow/" + path, formula.text, {0, 0}, constants);
  }
  void operator()(const std::string& path, const FlowStateParams& given, FlowState& state) const {
    (*this)(path + "/s_g", given.s_g, state.s_g);
    if (!given.S.empty()) {
      FieldPtr S;
      (*this)(path + "/S", given.S, S);
      state.s_g = std::make_shared<Complement>(S);
    }
    (*this)(path + "/P", given.P, state.P);
    (*this)(path + "/chi", given.chi, state.chi);
  }
  void operator()(const std::string& path, const FlowBoundaryParams& given, FlowBoundary& part) const {
    part.kind = given.kind;
    (*this)(path + "/water", given.water, part.water);
    (*this)(path + "/hydrogen", given.hydrogen, part.hydrogen);
    (*this)(path, static_cast<const FlowStateParams&>(given), part.state);
  }
};

FlowState water_at_rest() { return {constant(0), constant(1e6), constant(0)}; }

TwoPhaseScene from_flow(const FlowParams& given) {
  TwoPhaseScene scene;
  scene.name = "flow";
  scene.sentence = "Water and hydrogen in a rock with the data of the deck.";
  scene.medium = given;
  scene.initial = water_at_rest();
  if (given.capillary_law) scene.capillary_law = *given.capillary_law;
  if (!given.gravity.empty()) scene.gravity = {given.gravity[0], given.gravity[1]};
  return scene;
}

}  // namespace

TwoPhaseScene two_phase_scene(const models::SceneParams& params) {
  if (params.model != model_name) throw core::InputError("scene/model: this is no two-phase flow; write 'two-phase'.");
  models::require_right(params, examine);

  const FlowParams given = of(params).flow.value_or(FlowParams{});
  TwoPhaseScene scene = params.case_name ? catalogue(*params.case_name, given) : from_flow(given);
  const Reader read{given.constants};
  read("initial", given.initial, scene.initial);
  read("water source", given.water_source, scene.water_source);
  read("hydrogen source", given.hydrogen_source, scene.hydrogen_source);
  for (const auto& [tag, part] : given.boundary) {
    if (scene.boundary.count(tag) == 0 || scene.boundary[tag].kind != part.kind) {
      scene.boundary[tag] = FlowBoundary{};
      scene.boundary[tag].state = water_at_rest();
    }
    read("boundary/" + tag, part, scene.boundary[tag]);
  }
  return scene;
}

}  // namespace thixis::flow
