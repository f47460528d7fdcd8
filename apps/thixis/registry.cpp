/// The one file that names every method and every model.
#include "registry.hpp"

#include "thixis/core/error.hpp"
#include "thixis/dg/space.hpp"
#include "thixis/fem/lagrange_space.hpp"
#include "thixis/flow/two_phase.hpp"
#include "thixis/hho/space.hpp"
#include "thixis/membranes/membranes.hpp"
#include "thixis/membranes/parabolic_membranes.hpp"
#include "thixis/scene/membranes.hpp"

namespace thixis {
namespace {

method::SpaceFactory make_method(const method::MethodParams& method) {
  switch (method.name) {
    case method::MethodName::fem:
      return fem::make_lagrange_space;
    case method::MethodName::dg:
      return dg::make_space;
    case method::MethodName::hho:
      return hho::make_space;
    default:
      throw core::InputError("method/name: " + method::to_text(method.name) + " serves two-phase flow alone; write fem, dg or hho.");
  }
}

/// The expressions of newton/initial for u_1 (u over an obstacle), u_2 and lambda, null where none is given.
std::array<scene::FieldPtr, 3> initial_fields(const drive::RunParams& params) {
  const auto& initial = params.newton.initial;
  const bool one = params.scene.model == scene::Model::obstacle;
  const auto field = [&](const char* name, const std::optional<core::Formula>& formula) -> scene::FieldPtr {
    if (!formula) return nullptr;
    const auto& data = params.scene.data;
    return scene::expression(std::string("newton/initial/") + name, formula->text, data ? data->centre : std::vector<double>{0, 0},
                             data ? data->constants : std::map<std::string, double>{});
  };
  return {one ? field("u", initial.u) : field("u1", initial.u1), field("u2", initial.u2), field("lambda", initial.lambda)};
}

std::unique_ptr<models::Model> make_two_phase(const drive::RunParams& params) {
  if (params.method.name != method::MethodName::fv) throw core::InputError("method/name: two-phase flow is served by fv alone; write fv.");
  const drive::TimeParams time = params.time.value_or(drive::TimeParams{});
  auto scene = scene::two_phase_scene(params.scene);
  if (scene.time_unit == "year" && time.unit != drive::TimeUnit::year)
    throw core::InputError("time/unit: the rates of the case '" + scene.name + "' are per year; write year.");
  if (time.unit == drive::TimeUnit::none)
    throw core::InputError("time/unit: viscosities and permeabilities have units, and so has time; write second or year.");
  const double seconds = drive::seconds_in(time.unit);
  flow::TwoPhaseBoundParams bound;
  bound.measure = params.stopping.measure;
  bound.adaptive = params.stopping.rule == complementarity::StoppingRule::adaptive;
  if (params.stopping.time_scale) bound.time_scale = *params.stopping.time_scale * seconds;
  return flow::two_phase(std::move(scene), params.linear, seconds, bound);
}

}  // namespace

std::unique_ptr<models::Model> make_model(const drive::RunParams& params) {
  if (params.scene.model == scene::Model::two_phase) return make_two_phase(params);
  const auto make_space = make_method(params.method);
  const auto check_mesh = params.method.name == method::MethodName::dg ? dg::check_mesh : method::MeshCheck();
  switch (params.scene.model) {
    case scene::Model::membranes:
    case scene::Model::obstacle:
      return membranes::membranes(scene::membrane_scene(params.scene), make_space, params.method, params.linear, initial_fields(params),
                                  check_mesh);
    case scene::Model::parabolic_membranes:
      return membranes::parabolic_membranes(scene::membrane_scene(params.scene), make_space, params.method, params.linear, check_mesh,
                                            params.stopping.friedrichs);
    default:
      throw core::InputError("scene/model: this version does not serve " + scene::to_text(params.scene.model) +
                             "; write membranes, obstacle, parabolic membranes or two-phase.");
  }
}

}  // namespace thixis
