#include "thixis/membranes/scene.hpp"

#include "deck/cases.hpp"
#include "deck/examine.hpp"
#include "thixis/core/error.hpp"

namespace thixis::membranes {
namespace {

using scene::constant;
using scene::expression;
using scene::FieldPtr;

/// Reads the expressions of one deck.
struct Reader {
  const DataParams& data;

  FieldPtr operator()(const std::string& path, const core::Formula& formula) const {
    if (formula.empty()) return nullptr;
    return expression("scene/" + path, formula.text, data.centre, data.constants, data.degree);
  }
  /// The exact solution: what the deck says of the data is not said of it.
  FieldPtr exact(const std::string& path, const core::Formula& formula) const {
    return formula.empty() ? nullptr : expression("scene/" + path, formula.text, data.centre, data.constants);
  }
  FieldPtr operator()(const std::string& path, const core::Formula& formula, const FieldPtr& otherwise) const {
    return formula.empty() ? otherwise : (*this)(path, formula);
  }
  std::array<FieldPtr, 2> gradient(const std::string& path, const core::Formula& in_x, const core::Formula& in_y) const {
    return {exact(path + "_x", in_x), exact(path + "_y", in_y)};
  }
};

/// The functions of membrane alpha, whose place in the deck is `m`. Reads the exact solution if the scene has one.
void read_membrane(const Reader& read, const SceneParams& params, const MembraneEntries& m, int alpha, MembraneScene& scene) {
  const DataParams& data = read.data;
  scene.tension[alpha] = read("data/mu" + m.index, data.*m.mu, constant(1));
  scene.force[alpha] = read("data/f" + m.index, data.*m.f, constant(0));
  FieldPtr trace;
  if (scene.exact) {
    trace = scene.exact->u[alpha] = read.exact("data/u" + m.index, data.*m.u);
    scene.exact->gradient[alpha] = read.gradient("data/u" + m.index, data.*m.u_x, data.*m.u_y);
  }
  const FieldPtr rest = scene.default_boundary.value[alpha] = read("data/g" + m.index, data.*m.g, trace);
  for (const auto& [tag, part] : params.boundary) {
    BoundaryCondition& condition = scene.boundary[tag];
    condition.kind = part.kind;
    const std::string path = "boundary/" + tag;
    condition.value[alpha] = part.kind == BoundaryKind::dirichlet ? read(path + "/g" + m.index, part.*m.g_here, rest)
                                                                  : read(path + "/t" + m.index, part.*m.t_here, constant(0));
  }
}

MembraneScene from_data(const std::string& model, const SceneParams& params) {
  const DataParams& data = *params.data;
  const Reader read{data};
  const auto membranes = membranes_of(model);
  MembraneScene scene;
  scene.name = "data";
  scene.count = static_cast<int>(membranes.size());
  scene.sentence = scene.count == 1 ? "A membrane over an obstacle with the data of the deck." : "Two membranes with the data of the deck.";
  scene.obstacle = read("data/psi", data.psi);
  scene.interface_level_set = read("interface", params.interface);
  if (!(data.*membranes[0].u).empty()) {
    scene.exact.emplace();
    scene.exact->multiplier = read.exact("data/lambda", data.lambda);
  }
  for (int alpha = 0; alpha < scene.count; ++alpha) read_membrane(read, params, membranes[alpha], alpha, scene);
  if (data.initial) {
    scene.initial[0] = read("data/initial/u1", data.initial->u1);
    scene.initial[1] = read("data/initial/u2", data.initial->u2);
  }
  return scene;
}

MembraneScene from_case(const std::string& name, const SceneParams& params) {
  CatalogueEntry entry = catalogue(name);
  if (!params.interface.empty())
    entry.scene.interface_level_set = expression("scene/interface", params.interface.text, entry.centre, entry.constants);
  return entry.scene;
}

}  // namespace

MembraneScene membrane_scene(const models::SceneParams& params) {
  if (membranes_of(params.model).empty())
    throw core::InputError("scene/model: this scene is about membranes; write 'membranes', 'obstacle' or 'parabolic membranes'.");
  models::require_right(params, examine);
  return of(params).data ? from_data(params.model, of(params)) : from_case(*params.case_name, of(params));
}

}  // namespace thixis::membranes
