#include "params.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "cases.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/expression.hpp"

namespace thixis::scene {
namespace {

void examine_tension(const std::string& path, const core::Formula& formula, const Constants& constants, const Report& report) try {
  const core::Expression parsed(formula.text, {"x", "y", "t", "r"}, constants);
  if (parsed.constant() && parsed({0, 0, 0, 0}) <= 0) report(path, "a tension must be positive, not " + formula.text + ".");
} catch (const core::InputError&) {
  // reported as an expression already
}

/// A function of the deck, where it stands.
struct Entry {
  std::string block, name;
  const core::Formula& formula;
  std::string path() const { return block + "/" + name; }
};

/// All functions of one membrane, in the same order for every membrane.
std::vector<Entry> entries(const MembraneEntries& m, const SceneParams& params) {
  const DataParams& data = *params.data;
  const std::string &l = m.index, u = "u" + l;
  std::vector<Entry> all = {{"data", "mu" + l, data.*m.mu}, {"data", "f" + l, data.*m.f},    {"data", "g" + l, data.*m.g},
                            {"data", u, data.*m.u},         {"data", u + "_x", data.*m.u_x}, {"data", u + "_y", data.*m.u_y}};
  for (const auto& [tag, part] : params.boundary) {
    all.push_back({"boundary/" + tag, "g" + l, part.*m.g_here});
    all.push_back({"boundary/" + tag, "t" + l, part.*m.t_here});
  }
  return all;
}

/// Reports functions of the other model; true if there is none.
bool examine_names(const SceneParams& params, const Report& report) {
  bool right = true;
  const auto refuse = [&](const Entry& entry, const std::string& sentence) {
    if (entry.formula.empty()) return;
    report(entry.path(), sentence);
    right = false;
  };
  const auto one = entries(membranes_of(Model::obstacle)[0], params), upper = entries(membranes_of(Model::membranes)[0], params),
             lower = entries(membranes_of(Model::membranes)[1], params);
  for (std::size_t i = 0; i < one.size(); ++i)
    if (params.model == Model::obstacle) {
      refuse(upper[i], fmt::format("there is one membrane; write {} in place of {}.", one[i].name, upper[i].name));
      refuse(lower[i],
             fmt::format("the obstacle psi takes the place of the lower membrane; drop {}, or write model = 'membranes'.", lower[i].name));
    } else {
      refuse(one[i], fmt::format("there are two membranes; write {} and {} in place of {}, or model = 'obstacle'.", upper[i].name,
                                 lower[i].name, one[i].name));
    }
  if (params.model != Model::obstacle)
    refuse({"data", "psi", params.data->psi}, "the lower membrane takes the place of an obstacle; drop psi, or write model = 'obstacle'.");
  return right;
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
void examine_time(const std::vector<MembraneEntries>& membranes, const SceneParams& params, const Report& report) {
  const DataParams& data = *params.data;
  if (params.model != Model::parabolic_membranes) {
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

void examine_data(const SceneParams& params, const Report& report) {
  const DataParams& data = *params.data;
  const auto membranes = membranes_of(params.model);
  for (const auto& m : membranes) {
    for (const auto& entry : entries(m, params)) examine_formula(entry.path(), entry.formula, data.constants, report);
    examine_tension("data/mu" + m.index, data.*m.mu, data.constants, report);
  }
  examine_formula("data/psi", data.psi, data.constants, report);
  examine_formula("data/lambda", data.lambda, data.constants, report);
  examine_formula("interface", params.interface, data.constants, report);
  examine_constants("data/constants", data.constants, report);
  if (data.centre.size() != 2) report("data/centre", "the centre has two coordinates; write {x,y}.");
  if (!examine_names(params, report)) return;  // what seems to be missing may only have a wrong name
  examine_exact(membranes, data, report);
  examine_dirichlet(membranes, params, report);
  examine_time(membranes, params, report);
  if (params.model == Model::obstacle && data.psi.empty()) report("data/psi", "nothing says where the obstacle is; give psi, its height.");
}

const std::vector<std::pair<std::string, Model>>& models() {
  static const std::vector<std::pair<std::string, Model>> all = {{"membranes", Model::membranes},
                                                                 {"obstacle", Model::obstacle},
                                                                 {"parabolic membranes", Model::parabolic_membranes},
                                                                 {"signorini", Model::signorini},
                                                                 {"two-phase", Model::two_phase}};
  return all;
}

void examine_case(const SceneParams& params, const Report& report) {
  const Case* found = nullptr;
  for (const Case& known : cases())
    if (known.name == params.case_name) found = &known;
  if (found == nullptr) return report("case", "'" + *params.case_name + "' is no catalogued case; `thixis cases` lists them.");
  for (const auto& [name, model] : models())
    if (model == found->model && model != params.model)
      report("case", "'" + found->name + "' is a case of another model; write model = '" + name + "' or take one of its own.");
  if (found->model == Model::two_phase) return;
  if (!params.boundary.empty())
    report("boundary", "a catalogued case brings its own boundary data; drop this block, or give 'data' in place of 'case'.");
  examine_formula("interface", params.interface, catalogue(found->name).constants, report);
}

core::Range case_names() {
  core::Range range;
  for (const Case& known : cases()) range.names.push_back(known.name);
  return range;
}

/// What describes membranes does not describe a flow.
void examine_two_phase(const SceneParams& params, const Report& report) {
  if (params.data) report("data", "these are functions of membranes; describe two-phase flow in 'flow'.");
  if (!params.boundary.empty()) report("boundary", "the boundary of two-phase flow is described in 'flow/boundary'; move this there.");
  if (!params.interface.empty()) report("interface", "finite volumes cut no cells; drop this.");
  if (!params.case_name && !params.flow) report("", "nothing says which problem to solve; give a catalogued 'case' or a sublist 'flow'.");
  if (params.case_name) examine_case(params, report);
  if (params.flow) examine_flow(*params.flow, report);
}

/// Whether expressions may use it.
bool is_right(const Constants::value_type& constant) {
  try {
    const core::Expression nothing("0", {"x", "y", "t", "r"}, {constant});
    return true;
  } catch (const core::InputError&) {
    return false;
  }
}

/// The others are reported by examine_constants.
Constants with_right_names(const Constants& constants) {
  Constants right;
  for (const auto& constant : constants)
    if (is_right(constant)) right.insert(constant);
  return right;
}

}  // namespace

void examine_formula(const std::string& path, const core::Formula& formula, const Constants& constants, const Report& report) {
  if (formula.empty()) return;
  try {
    const core::Expression parsed(formula.text, {"x", "y", "t", "r"}, constants);
    if (parsed.constant() && !std::isfinite(parsed({0, 0, 0, 0}))) report(path, "'" + formula.text + "' is not a finite number.");
  } catch (const core::InputError& error) {
    // wrong names are reported where they stand, and not by every expression that may use them
    const Constants right = with_right_names(constants);
    if (right.size() < constants.size()) return examine_formula(path, formula, right, report);
    report(path, error.what());
  }
}

void examine_constants(const std::string& path, const Constants& constants, const Report& report) {
  const Constants right = with_right_names(constants);
  for (const auto& [name, value] : constants) {
    if (right.count(name) > 0) continue;
    const bool is_name = std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
    report(path + "/" + name, is_name && std::isdigit(static_cast<unsigned char>(name[0])) == 0
                                  ? "this name has a meaning in every expression already; take another one."
                                  : "this can not be the name of a constant; use letters, digits and _, a letter first.");
  }
}

std::string to_text(Model model) {
  for (const auto& [name, known] : models())
    if (known == model) return name;
  return "";
}

std::vector<MembraneEntries> membranes_of(Model model) {
  using D = DataParams;
  using B = BoundaryParams;
  switch (model) {
    case Model::obstacle:
      return {{"", &D::mu, &D::f, &D::g, &D::u, &D::u_x, &D::u_y, &B::g, &B::t}};
    case Model::membranes:
    case Model::parabolic_membranes:
      return {{"1", &D::mu1, &D::f1, &D::g1, &D::u1, &D::u1_x, &D::u1_y, &B::g1, &B::t1},
              {"2", &D::mu2, &D::f2, &D::g2, &D::u2, &D::u2_x, &D::u2_y, &B::g2, &B::t2}};
    default:
      return {};
  }
}

void examine(const SceneParams& params, const Report& report) {
  if (params.model == Model::two_phase) return examine_two_phase(params, report);
  if (params.flow) report("flow", "this describes two-phase flow; write model = 'two-phase', or drop it.");
  if (params.case_name && params.data) return report("data", "there is a case as well; give either 'case' or 'data'.");
  if (!params.case_name && !params.data)
    return report("", "nothing says which problem to solve; give a catalogued 'case' or a sublist 'data'.");
  if (!params.data) return examine_case(params, report);
  if (!membranes_of(params.model).empty()) examine_data(params, report);
}

const core::Schema<InitialParams>& InitialParams::schema() {
  static const auto s =
      core::Schema<InitialParams>("initial", "Model parabolic membranes: where the membranes are at time 0; without it the exact solution.")
          .parameter("u1", &InitialParams::u1, "Height of the upper membrane at time 0.")
          .parameter("u2", &InitialParams::u2, "Height of the lower membrane at time 0, at most u1.");
  return s;
}

const core::Schema<DataParams>& DataParams::schema() {
  static const auto s =
      core::Schema<DataParams>(
          "data", "The functions of the problem: numbers or expressions of x, y, t, r (distance to the centre), pi and the constants.")
          .parameter("mu1", &DataParams::mu1, "Tension of the upper membrane; positive, without it 1.")
          .parameter("mu2", &DataParams::mu2, "Tension of the lower membrane; positive, without it 1.")
          .parameter("f1", &DataParams::f1, "Force on the upper membrane; without it 0.")
          .parameter("f2", &DataParams::f2, "Force on the lower membrane; without it 0.")
          .parameter("g1", &DataParams::g1, "Height of the upper membrane on the boundary; without it that of u1.")
          .parameter("g2", &DataParams::g2, "Height of the lower membrane on the boundary, at most g1; without it that of u2.")
          .parameter("u1", &DataParams::u1, "Exact solution, upper membrane, if known.")
          .parameter("u2", &DataParams::u2, "Exact solution, lower membrane, if known.")
          .parameter("u1_x", &DataParams::u1_x, "Derivative of u1 in x; without it differences of u1.")
          .parameter("u1_y", &DataParams::u1_y, "Derivative of u1 in y; without it differences of u1.")
          .parameter("u2_x", &DataParams::u2_x, "Derivative of u2 in x; without it differences of u2.")
          .parameter("u2_y", &DataParams::u2_y, "Derivative of u2 in y; without it differences of u2.")
          .parameter("mu", &DataParams::mu, "Model obstacle: tension of the membrane; positive, without it 1.")
          .parameter("f", &DataParams::f, "Model obstacle: force on the membrane; without it 0.")
          .parameter("g", &DataParams::g, "Model obstacle: height of the membrane on the boundary, at least psi; without it that of u.")
          .parameter("psi", &DataParams::psi,
                     "Model obstacle: height of the obstacle; must be given. It should be continuous; on an edge where it jumps the upper "
                     "height counts.")
          .parameter("u", &DataParams::u, "Model obstacle: exact solution, if known.")
          .parameter("u_x", &DataParams::u_x, "Model obstacle: derivative of u in x; without it differences of u.")
          .parameter("u_y", &DataParams::u_y, "Model obstacle: derivative of u in y; without it differences of u.")
          .parameter("lambda", &DataParams::lambda, "Exact multiplier, if known.")
          .block("initial", &DataParams::initial, InitialParams::schema())
          .parameter(
              "degree", &DataParams::degree, core::between(0, 30),
              "Names the data as exact: mu, f, g, t and psi are polynomials of at most this degree (in x and y, and in t) in every "
              "cell of the mesh, or on either side of the interface: then the bound is up to quadrature of the data all the same. Not "
              "needed where an expression is one polynomial: that is seen. "
              "docs/methods/estimates.md, 8, has what it is good for.")
          .parameter("centre", &DataParams::centre, core::entries(2), "The point from which r is measured.")
          .values("constants", &DataParams::constants,
                  "Named numbers that the expressions of this block, of 'interface' and of 'boundary' may use.");
  return s;
}

const core::Schema<BoundaryParams>& BoundaryParams::schema() {
  static const auto s =
      core::Schema<BoundaryParams>("boundary",
                                   "One sublist per boundary tag; other parts are dirichlet with g1, g2 (model obstacle: g) of the data.")
          .choice("kind", &BoundaryParams::kind, {{"dirichlet", BoundaryKind::dirichlet}, {"neumann", BoundaryKind::neumann}},
                  "dirichlet: u1 = g1, u2 = g2; neumann: mu1 du1/dn = t1, mu2 du2/dn = t2, n outward; model obstacle: the same without "
                  "indices.")
          .parameter("g1", &BoundaryParams::g1, "Of kind dirichlet: height of the upper membrane; without it g1 of the data.")
          .parameter("g2", &BoundaryParams::g2, "Of kind dirichlet: height of the lower membrane; without it g2 of the data.")
          .parameter("t1", &BoundaryParams::t1, "Of kind neumann: force per length on the upper membrane; without it 0.")
          .parameter("t2", &BoundaryParams::t2, "Of kind neumann: force per length on the lower membrane; without it 0.")
          .parameter("g", &BoundaryParams::g, "Of kind dirichlet, model obstacle: height of the membrane; without it g of the data.")
          .parameter("t", &BoundaryParams::t, "Of kind neumann, model obstacle: force per length on the membrane; without it 0.");
  return s;
}

const core::Schema<SceneParams>& SceneParams::schema() {
  static const auto s =
      core::Schema<SceneParams>("scene", "Which problem is solved: a catalogued case, or data of your own.")
          .choice("model", &SceneParams::model, models(), "The equations and what is constrained.")
          .required()
          .parameter("case", &SceneParams::case_name, case_names(), "A catalogued case (`thixis cases`); give this or 'data'.")
          .exemplary()
          .block("data", &SceneParams::data, DataParams::schema())
          .block("flow", &SceneParams::flow, FlowParams::schema())
          .parameter("interface", &SceneParams::interface,
                     "Expression whose zero set are the curves across which data jump, a product for several; integrals follow them in the "
                     "cells that they are seen to cut.")
          .blocks("boundary", &SceneParams::boundary, BoundaryParams::schema())
          .check([](const SceneParams& params, core::Problems& problems) {
            if (!params.case_name && problems.given("case")) return;  // a case that does not exist is reported already
            examine(params, [&](const std::string& path, const std::string& sentence) { problems.add(path, sentence); });
          });
  return s;
}

}  // namespace thixis::scene
