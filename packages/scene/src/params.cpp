#include "params.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cases.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/expression.hpp"

namespace thixis::scene {
namespace {

using Report = std::function<void(const std::string&, const std::string&)>;
using Constants = std::map<std::string, double>;

void examine_formula(const std::string& path, const core::Formula& formula, const Constants& constants, const Report& report) {
  if (formula.empty()) return;
  try {
    const core::Expression parsed(formula.text, {"x", "y", "t", "r"}, constants);
    if (parsed.constant() && !std::isfinite(parsed({0, 0, 0, 0}))) report(path, "'" + formula.text + "' is not a finite number.");
  } catch (const core::InputError& error) {
    report(path, error.what());
  }
}

void examine_tension(const std::string& path, const core::Formula& formula, const Constants& constants, const Report& report) try {
  const core::Expression parsed(formula.text, {"x", "y", "t", "r"}, constants);
  if (parsed.constant() && parsed({0, 0, 0, 0}) <= 0) report(path, "a tension must be positive, not " + formula.text + ".");
} catch (const core::InputError&) {
  // reported as an expression already
}

void examine_constants(const Constants& constants, const Report& report) {
  for (const char* taken : {"x", "y", "t", "r", "pi"})
    if (constants.count(taken) > 0)
      report(std::string("data/constants/") + taken, "this name has a meaning in every expression already; take another one.");
}

void examine_exact(const DataParams& data, const Report& report) {
  const bool known = !data.u1.empty() && !data.u2.empty();
  if (!data.u1.empty() && data.u2.empty()) report("data/u1", "the exact solution needs u2 as well; give both or none.");
  if (data.u1.empty() && !data.u2.empty()) report("data/u2", "the exact solution needs u1 as well; give both or none.");
  if (!known && !data.lambda.empty())
    report("data/lambda", "an exact multiplier is of use together with u1 and u2 only; give these or drop it.");
  if (data.u1_x.empty() != data.u1_y.empty()) report(data.u1_x.empty() ? "data/u1_y" : "data/u1_x", "give both u1_x and u1_y or none.");
  if (data.u2_x.empty() != data.u2_y.empty()) report(data.u2_x.empty() ? "data/u2_y" : "data/u2_x", "give both u2_x and u2_y or none.");
  if (data.u1.empty() && !data.u1_x.empty())
    report("data/u1_x", "the gradient of the exact solution needs u1 itself; give it or drop the gradient.");
  if (data.u2.empty() && !data.u2_x.empty())
    report("data/u2_x", "the gradient of the exact solution needs u2 itself; give it or drop the gradient.");
}

void examine_dirichlet(const SceneParams& params, const DataParams& data, const Report& report) {
  const bool first = !data.g1.empty() || !data.u1.empty(), second = !data.g2.empty() || !data.u2.empty();
  const auto missing = [](int alpha) {
    return fmt::format("nothing says what u{0} is on the boundary; give data/g{0} or the exact solution data/u{0}.", alpha);
  };
  if (params.boundary.empty()) {
    if (!first) report("data", missing(1));
    if (!second) report("data", missing(2));
  } else if (first != second) {
    report("data", missing(first ? 2 : 1));
  }
  for (const auto& [tag, part] : params.boundary) {
    const std::string path = "boundary/" + tag;
    if (part.kind == BoundaryKind::neumann) {
      if (!part.g1.empty()) report(path + "/g1", "a part of kind neumann has no g1; give t1, or kind = dirichlet.");
      if (!part.g2.empty()) report(path + "/g2", "a part of kind neumann has no g2; give t2, or kind = dirichlet.");
    } else {
      if (!part.t1.empty()) report(path + "/t1", "a part of kind dirichlet has no t1; give g1, or kind = neumann.");
      if (!part.t2.empty()) report(path + "/t2", "a part of kind dirichlet has no t2; give g2, or kind = neumann.");
      if (part.g1.empty() && !first) report(path, "give g1 here or in data.");
      if (part.g2.empty() && !second) report(path, "give g2 here or in data.");
    }
  }
}

void examine_data(const SceneParams& params, const DataParams& data, const Report& report) {
  const std::pair<const char*, const core::Formula*> all[] = {
      {"mu1", &data.mu1},   {"mu2", &data.mu2},   {"f1", &data.f1},    {"f2", &data.f2},         {"g1", &data.g1},
      {"g2", &data.g2},     {"u1", &data.u1},     {"u2", &data.u2},    {"lambda", &data.lambda}, {"u1_x", &data.u1_x},
      {"u1_y", &data.u1_y}, {"u2_x", &data.u2_x}, {"u2_y", &data.u2_y}};
  for (const auto& [name, formula] : all) examine_formula(std::string("data/") + name, *formula, data.constants, report);
  examine_tension("data/mu1", data.mu1, data.constants, report);
  examine_tension("data/mu2", data.mu2, data.constants, report);
  for (const auto& [tag, part] : params.boundary) {
    const std::pair<const char*, const core::Formula*> here[] = {{"g1", &part.g1}, {"g2", &part.g2}, {"t1", &part.t1}, {"t2", &part.t2}};
    for (const auto& [name, formula] : here) examine_formula("boundary/" + tag + "/" + name, *formula, data.constants, report);
  }
  examine_constants(data.constants, report);
  if (data.centre.size() != 2) report("data/centre", "the centre has two coordinates; write {x,y}.");
  examine_exact(data, report);
  examine_dirichlet(params, data, report);
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
  if (!params.boundary.empty())
    report("boundary", "a catalogued case brings its own boundary data; drop this block, or give 'data' in place of 'case'.");
  examine_formula("interface", params.interface, catalogue(found->name).constants, report);
}

core::Range case_names() {
  core::Range range;
  for (const Case& known : cases()) range.names.push_back(known.name);
  return range;
}

}  // namespace

void examine(const SceneParams& params, const Report& report) {
  if (params.case_name && params.data) return report("data", "there is a case as well; give either 'case' or 'data'.");
  if (!params.case_name && !params.data)
    return report("", "nothing says which problem to solve; give a catalogued 'case' or a sublist 'data'.");
  if (params.data) {
    examine_data(params, *params.data, report);
    examine_formula("interface", params.interface, params.data->constants, report);
  } else {
    examine_case(params, report);
  }
}

const core::Schema<DataParams>& DataParams::schema() {
  static const auto s =
      core::Schema<DataParams>(
          "data", "The functions of the problem: numbers or expressions of x, y, t, r (distance to the centre), pi and the constants.")
          .parameter("mu1", &DataParams::mu1, "Tension of the upper membrane; positive.")
          .parameter("mu2", &DataParams::mu2, "Tension of the lower membrane; positive.")
          .parameter("f1", &DataParams::f1, "Force on the upper membrane.")
          .parameter("f2", &DataParams::f2, "Force on the lower membrane.")
          .parameter("g1", &DataParams::g1, "Height of the upper membrane on the boundary; without it that of u1.")
          .parameter("g2", &DataParams::g2, "Height of the lower membrane on the boundary, at most g1; without it that of u2.")
          .parameter("u1", &DataParams::u1, "Exact solution, upper membrane, if known.")
          .parameter("u2", &DataParams::u2, "Exact solution, lower membrane, if known.")
          .parameter("lambda", &DataParams::lambda, "Exact multiplier, if known.")
          .parameter("u1_x", &DataParams::u1_x, "Derivative of u1 in x; without it differences of u1.")
          .parameter("u1_y", &DataParams::u1_y, "Derivative of u1 in y; without it differences of u1.")
          .parameter("u2_x", &DataParams::u2_x, "Derivative of u2 in x; without it differences of u2.")
          .parameter("u2_y", &DataParams::u2_y, "Derivative of u2 in y; without it differences of u2.")
          .parameter("centre", &DataParams::centre, core::entries(2), "The point from which r is measured.")
          .values("constants", &DataParams::constants,
                  "Named numbers that the expressions of this block, of 'interface' and of 'boundary' may use.");
  return s;
}

const core::Schema<BoundaryParams>& BoundaryParams::schema() {
  static const auto s =
      core::Schema<BoundaryParams>("boundary",
                                   "One sublist per boundary tag, for both membranes; other parts are dirichlet with g1, g2 of the data.")
          .choice("kind", &BoundaryParams::kind, {{"dirichlet", BoundaryKind::dirichlet}, {"neumann", BoundaryKind::neumann}},
                  "dirichlet: u1 = g1, u2 = g2; neumann: mu1 du1/dn = t1, mu2 du2/dn = t2, n outward.")
          .parameter("g1", &BoundaryParams::g1, "Of kind dirichlet: height of the upper membrane; without it g1 of the data.")
          .parameter("g2", &BoundaryParams::g2, "Of kind dirichlet: height of the lower membrane; without it g2 of the data.")
          .parameter("t1", &BoundaryParams::t1, "Of kind neumann: force per length on the upper membrane; without it 0.")
          .parameter("t2", &BoundaryParams::t2, "Of kind neumann: force per length on the lower membrane; without it 0.");
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
          .parameter("interface", &SceneParams::interface,
                     "Expression whose zero set are the curves across which data jump, a product for several; integrals are exact in the "
                     "cells that it cuts.")
          .blocks("boundary", &SceneParams::boundary, BoundaryParams::schema())
          .check([](const SceneParams& params, core::Problems& problems) {
            if (!params.case_name && problems.given("case")) return;  // a case that does not exist is reported already
            examine(params, [&](const std::string& path, const std::string& sentence) { problems.add(path, sentence); });
          });
  return s;
}

}  // namespace thixis::scene
