#include "thixis/membranes/family.hpp"

#include <fmt/format.h>

#include "deck/cases.hpp"
#include "deck/examine.hpp"
#include "family/uses.hpp"
#include "thixis/core/error.hpp"
#include "thixis/membranes/membranes.hpp"
#include "thixis/membranes/parabolic_membranes.hpp"
#include "thixis/models/catalogue.hpp"

namespace thixis::membranes {
namespace {

using models::Entry;
using models::RunParams;

/// The expressions of newton/initial for u_1 (u over an obstacle), u_2 and lambda, null where none is given.
std::array<scene::FieldPtr, 3> initial_fields(const RunParams& params) {
  const StartParams& initial = params.newton.own.get<NewtonParams>().initial;
  const DataParams data = of(params.scene).data.value_or(DataParams{});
  const auto field = [&](const char* name, const std::optional<core::Formula>& formula) -> scene::FieldPtr {
    if (!formula) return nullptr;
    return scene::expression(std::string("newton/initial/") + name, formula->text, data.centre, data.constants);
  };
  return {params.scene.model == model::obstacle ? field("u", initial.u) : field("u1", initial.u1), field("u2", initial.u2),
          field("lambda", initial.lambda)};
}

/// What is not known stays unjudged: other mistakes of the scene are told when it is made.
bool lacks_exact(const RunParams& params) {
  try {
    return !membrane_scene(params.scene).exact;
  } catch (const core::InputError&) {
    return false;
  }
}

void judge_in_time(const RunParams& params, std::vector<std::string>& mistakes) {
  if (params.catalogue->method(params).bounded_in_time || !params.estimated()) return;
  std::string bounded;
  for (const method::Method& method : params.catalogue->methods())
    if (method.bounded_in_time) bounded += (bounded.empty() ? "" : " or ") + method.name;
  mistakes.push_back(
      fmt::format("method/name: in time the error of {} is not bounded; write {}, or leave out what needs an estimate (stopping/rule, "
                  "estimate, target, time/adaptive).",
                  params.method.name, bounded));
}

/// Data of a user to begin with: membranes that are pressed together, or on an obstacle.
DataParams some_data(const std::string& name) {
  DataParams data;
  if (name == model::obstacle) {
    data.f = {"-8"};
    data.g = {"0"};
    data.psi = {"-0.25"};
    return data;
  }
  data.f1 = {"-4"};
  data.f2 = {"2"};
  data.g1 = {"0.1"};
  data.g2 = {"-0.1"};
  if (name == model::in_time) data.initial = InitialParams{{"0.1"}, {"-0.1"}};
  return data;
}

void begin(RunParams& params) {
  if (!params.scene.case_name) of(params.scene).data = some_data(params.scene.model);
  else if (on_the_disk(*params.scene.case_name)) params.mesh.generator = mesh::Generator::disk;
}

/// What the three models have in common.
Entry entry(const char* name) {
  Entry entry;
  entry.name = entry.title = name;
  entry.point_fields = {"u1", "u2", "lambda", "gap"};
  entry.cases = cases_of(name);
  entry.uses = {"scene/interface",
                "newton/sweeps",
                "linear/form",
                "stopping/target",
                "stopping/friedrichs constant",
                "adapt",
                "expect/contact area between",
                "expect/force between"};
  entry.accepts = [](const method::Method& method) { return method.make_space != nullptr; };
  entry.examine = examine;
  entry.lacks_exact = lacks_exact;
  entry.begin = begin;
  entry.make = [](const RunParams& params, const method::Method& method) {
    return membranes(membrane_scene(params.scene), method, params.method, params.linear, initial_fields(params));
  };
  return entry;
}

Entry over_obstacle() {
  Entry one = entry(model::obstacle);
  one.fields = 2;
  one.point_fields = {"u", "lambda", "gap"};
  return one;
}

Entry in_time() {
  Entry two = entry(model::in_time);
  two.in_time = true;
  two.judge = judge_in_time;
  two.make = [](const RunParams& params, const method::Method& method) {
    return parabolic_membranes(membrane_scene(params.scene), method, params.method, params.linear, params.stopping.friedrichs);
  };
  return two;
}

}  // namespace

models::Family family() {
  models::Family family;
  family.models = {entry(model::two), over_obstacle(), in_time()};
  family.scene = [](core::Schema<models::SceneParams>& block) { block.with(&models::SceneParams::own, SceneParams::schema()); };
  family.newton = [](core::Schema<complementarity::NewtonParams>& block) {
    block.with(&complementarity::NewtonParams::own, NewtonParams::schema());
  };
  family.uses = add_uses;
  family.beginning = {"newton/initial", "scene/data/initial"};
  return family;
}

}  // namespace thixis::membranes
