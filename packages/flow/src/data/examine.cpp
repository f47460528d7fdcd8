#include "data/examine.hpp"

#include <algorithm>

#include "data/cases.hpp"

namespace thixis::flow {
namespace {

using B = FlowBoundaryParams;
using scene::Constants;
using scene::examine_constants;
using scene::examine_formula;
using scene::Report;

/// A function of a part of the boundary, and the kind of part that has it.
struct Entry {
  const char* name;
  core::Formula FlowBoundaryParams::*formula;
  FlowBoundaryKind kind;
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = {{"S", &B::S, FlowBoundaryKind::state},        {"s_g", &B::s_g, FlowBoundaryKind::state},
                                         {"P", &B::P, FlowBoundaryKind::state},        {"chi", &B::chi, FlowBoundaryKind::state},
                                         {"water", &B::water, FlowBoundaryKind::flux}, {"hydrogen", &B::hydrogen, FlowBoundaryKind::flux}};
  return all;
}

void examine_saturation(const std::string& path, const FlowStateParams& state, const Report& report) {
  if (!state.S.empty() && !state.s_g.empty()) report(path + "/S", "s_g = 1 - S is given as well; give one of the two.");
}

void examine_part(const std::string& path, const B& part, const Constants& constants, const Report& report) {
  for (const Entry& entry : entries()) {
    const core::Formula& formula = part.*entry.formula;
    examine_formula(path + "/" + entry.name, formula, constants, report);
    if (formula.empty() || part.kind == entry.kind) continue;
    report(path + "/" + entry.name, std::string("this belongs to a part of kind ") +
                                        (entry.kind == FlowBoundaryKind::state ? "state" : "flux") + "; write that kind, or drop it.");
  }
  examine_saturation(path, part, report);
}

void examine_flow(const FlowParams& flow, const Report& report) {
  const auto formula = [&](const std::string& path, const core::Formula& text) {
    examine_formula("flow/" + path, text, flow.constants, report);
  };
  formula("initial/S", flow.initial.S);
  formula("initial/s_g", flow.initial.s_g);
  formula("initial/P", flow.initial.P);
  formula("initial/chi", flow.initial.chi);
  formula("water source", flow.water_source);
  formula("hydrogen source", flow.hydrogen_source);
  examine_saturation("flow/initial", flow.initial, report);
  for (const auto& [tag, part] : flow.boundary) examine_part("flow/boundary/" + tag, part, flow.constants, report);
  examine_constants("flow/constants", flow.constants, report);
  if (!(flow.S_lr + flow.S_gr < 1)) report("flow/S_gr", "S_lr + S_gr must be below 1, so that something can flow.");
}

}  // namespace

void examine(const models::SceneParams& scene, const Report& report) {
  const SceneParams& params = of(scene);
  if (!scene.case_name && !params.flow) report("", "nothing says which problem to solve; give a catalogued 'case' or a sublist 'flow'.");
  const auto known = [&](const models::Case& one) { return one.name == scene.case_name; };
  if (scene.case_name && std::none_of(cases().begin(), cases().end(), known))
    report("case", "'" + *scene.case_name + "' is no case of this model; `thixis cases` lists them.");
  if (params.flow) examine_flow(*params.flow, report);
}

}  // namespace thixis::flow
