/// The one file that names every method and every model.
#include "registry.hpp"

#include "thixis/core/error.hpp"
#include "thixis/dg/space.hpp"
#include "thixis/fem/lagrange_space.hpp"
#include "thixis/hho/space.hpp"
#include "thixis/models/membranes.hpp"
#include "thixis/models/parabolic_membranes.hpp"
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
      throw core::InputError("method/name: this version serves no scene by " + method::to_text(method.name) + "; write fem, dg or hho.");
  }
}

/// The expressions of newton/initial for u_1 (u over an obstacle), u_2 and lambda, null where none is given.
std::array<scene::FieldPtr, 3> initial_fields(const drive::RunParams& params) {
  const auto& initial = params.newton.initial;
  const bool one = params.scene.model == scene::Model::obstacle;
  const auto refuse = [](const char* name, const std::optional<core::Formula>& formula, const char* sentence) {
    if (formula) throw core::InputError(std::string("newton/initial/") + name + ": " + sentence);
  };
  for (const auto& [name, formula] : {std::pair("u1", initial.u1), std::pair("u2", initial.u2)})
    if (one) refuse(name, formula, "there is one membrane; write u in its place.");
  if (!one) refuse("u", initial.u, "there are two membranes; write u1 and u2 in its place.");

  const auto field = [&](const char* name, const std::optional<core::Formula>& formula) -> scene::FieldPtr {
    if (!formula) return nullptr;
    const auto& data = params.scene.data;
    return scene::expression(std::string("newton/initial/") + name, formula->text, data ? data->centre : std::vector<double>{0, 0},
                             data ? data->constants : std::map<std::string, double>{});
  };
  return {one ? field("u", initial.u) : field("u1", initial.u1), field("u2", initial.u2), field("lambda", initial.lambda)};
}

}  // namespace

std::unique_ptr<models::Model> make_model(const drive::RunParams& params) {
  const auto make_space = make_method(params.method);
  const auto check_mesh = params.method.name == method::MethodName::dg ? dg::check_mesh : method::MeshCheck();
  switch (params.scene.model) {
    case scene::Model::membranes:
    case scene::Model::obstacle:
      return models::membranes(scene::membrane_scene(params.scene), make_space, params.method, params.linear, initial_fields(params),
                               check_mesh);
    case scene::Model::parabolic_membranes:
      return models::parabolic_membranes(scene::membrane_scene(params.scene), make_space, params.method, params.linear, check_mesh);
    default:
      throw core::InputError("scene/model: this version serves membranes, obstacle and parabolic membranes only; write one of them.");
  }
}

}  // namespace thixis
