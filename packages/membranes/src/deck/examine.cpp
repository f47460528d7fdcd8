#include "deck/examine.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "deck/cases.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/expression.hpp"

namespace thixis::membranes {
namespace {

using scene::Constants;
using scene::examine_constants;
using scene::examine_formula;
using scene::Report;

void examine_tension(const std::string& path, const core::Formula& formula, const Constants& constants, const Report& report) try {
  const core::Expression parsed(formula.text, {"x", "y", "t", "r"}, constants);
  if (parsed.constant() && parsed({0, 0, 0, 0}) <= 0) report(path, "a tension must be positive, not " + formula.text + ".");
} catch (const core::InputError&) {
  // reported as an expression already
}

void examine_exact(const std::vector<MembraneEntries>& membranes, const DataParams& data, const Report& report) {
  std::string all;  // "u1 and u2"
  bool known = true;
  for (const auto& m : membranes) {
    all += (all.empty() ? "u" : " and u") + m.index;
    known = known && !(data.*m.u).empty();
  }
  if (!known && !data.lambda.empty())
    report("data/lambda", fmt::format("an exact multiplier is of use together with {0} only; give {0} or drop lambda.", all));
  for (const auto& m : membranes) {
    const std::string u = "u" + m.index, path = "data/" + u;
    const bool in_x = !(data.*m.u_x).empty(), in_y = !(data.*m.u_y).empty();
    for (const auto& other : membranes)
      if (!(data.*m.u).empty() && (data.*other.u).empty())
        report(path, fmt::format("the exact solution needs u{} as well; give both or none.", other.index));
    if (in_x != in_y) report(path + (in_x ? "_x" : "_y"), fmt::format("give both {0}_x and {0}_y or none.", u));
    if ((data.*m.u).empty() && in_x)
      report(path + "_x", fmt::format("the gradient of the exact solution needs {} itself; give it or drop the gradient.", u));
  }
}

/// What only scenes in time have, and what they must have.
void examine_time(const std::string& model, const std::vector<MembraneEntries>& membranes, const SceneParams& params,
                  const Report& report) {
  const DataParams& data = *params.data;
  if (model != model::in_time) {
    if (data.initial) report("data/initial", "a stationary scene begins nowhere; drop it, or write model = 'parabolic membranes'.");
    return;
  }
  if (data.initial)
    for (const auto& [name, formula] : {std::pair("u1", &data.initial->u1), std::pair("u2", &data.initial->u2)}) {
      const std::string path = std::string("data/initial/") + name;
      if (formula->empty()) report(path, "one membrane alone does not begin; give both u1 and u2.");
      examine_formula(path, *formula, data.constants, report);
    }
  else if (data.u1.empty() || data.u2.empty())
    report("data/initial", "nothing says where the membranes are at time 0; give a sublist 'initial' with u1 and u2.");
  for (const auto& m : membranes) try {
      const core::Formula& mu = data.*m.mu;
      if (!mu.empty() && core::Expression(mu.text, {"x", "y", "t", "r"}, data.constants).uses("t"))
        report("data/mu" + m.index, "a tension must not depend on time; write it without t.");
    } catch (const core::InputError&) {
      // reported as an expression already
    }
}

void examine_dirichlet(const std::vector<MembraneEntries>& membranes, const SceneParams& params, const Report& report) {
  const auto held = [&data = *params.data](const MembraneEntries& m) { return !(data.*m.g).empty() || !(data.*m.u).empty(); };
  // parts that are not named are held by the data: every membrane or none
  const bool everywhere = params.boundary.empty() || std::any_of(membranes.begin(), membranes.end(), held);
  for (const auto& m : membranes) {
    const std::string& l = m.index;
    if (everywhere && !held(m))
      report("data", fmt::format("nothing says what u{0} is on the boundary; give data/g{0} or the exact solution data/u{0}.", l));
    for (const auto& [tag, part] : params.boundary) {
      const std::string path = "boundary/" + tag;
      const bool g = !(part.*m.g_here).empty(), t = !(part.*m.t_here).empty();
      if (part.kind == BoundaryKind::neumann) {
        if (g) report(path + "/g" + l, fmt::format("a part of kind neumann has no g{0}; give t{0}, or kind = dirichlet.", l));
      } else {
        if (t) report(path + "/t" + l, fmt::format("a part of kind dirichlet has no t{0}; give g{0}, or kind = neumann.", l));
        if (!g && !held(m)) report(path, fmt::format("give g{} here or in data.", l));
      }
    }
  }
}

void examine_data(const std::string& model, const SceneParams& params, const Report& report) {
  const DataParams& data = *params.data;
  const auto membranes = membranes_of(model);
  for (const auto& m : membranes) {
    for (const auto& entry : places(m, params)) examine_formula(entry.path(), entry.formula, data.constants, report);
    examine_tension("data/mu" + m.index, data.*m.mu, data.constants, report);
  }
  examine_formula("data/psi", data.psi, data.constants, report);
  examine_formula("data/lambda", data.lambda, data.constants, report);
  examine_formula("interface", params.interface, data.constants, report);
  examine_constants("data/constants", data.constants, report);
  if (data.centre.size() != 2) report("data/centre", "the centre has two coordinates; write {x,y}.");
  if (!examine_names(model, params, report)) return;  // what seems to be missing may only have a wrong name
  examine_exact(membranes, data, report);
  examine_dirichlet(membranes, params, report);
  examine_time(model, membranes, params, report);
  if (model == model::obstacle && data.psi.empty()) report("data/psi", "nothing says where the obstacle is; give psi, its height.");
}

void examine_case(const std::string& model, const std::string& name, const SceneParams& params, const Report& report) {
  const auto& cases = cases_of(model);
  if (std::none_of(cases.begin(), cases.end(), [&](const models::Case& known) { return known.name == name; }))
    return report("case", "'" + name + "' is no case of this model; `thixis cases` lists them.");
  if (!params.boundary.empty())
    report("boundary", "a catalogued case brings its own boundary data; drop this block, or give 'data' in place of 'case'.");
  examine_formula("interface", params.interface, catalogue(name).constants, report);
}

}  // namespace

void examine(const models::SceneParams& scene, const Report& report) {
  const SceneParams& params = of(scene);
  if (scene.case_name && params.data) return report("data", "there is a case as well; give either 'case' or 'data'.");
  if (!scene.case_name && !params.data)
    return report("", "nothing says which problem to solve; give a catalogued 'case' or a sublist 'data'.");
  if (params.data) examine_data(scene.model, params, report);
  else examine_case(scene.model, *scene.case_name, params, report);
}

}  // namespace thixis::membranes
