#include "thixis/scene/membranes.hpp"

#include "cases.hpp"
#include "params.hpp"
#include "thixis/core/error.hpp"

namespace thixis::scene {
namespace {

constexpr double difference_step = 1e-6;  // round-off 2e-10 |u|; 1e-6 times a jump of second derivatives within 3e-6 of the interface

/// Reads the expressions of one deck.
struct Reader {
  const DataParams& data;

  FieldPtr operator()(const std::string& path, const core::Formula& formula) const {
    if (formula.empty()) return nullptr;
    return expression("scene/" + path, formula.text, data.centre, data.constants);
  }
  FieldPtr operator()(const std::string& path, const core::Formula& formula, const FieldPtr& otherwise) const {
    return formula.empty() ? otherwise : (*this)(path, formula);
  }
  std::array<FieldPtr, 2> gradient(const std::string& path, const core::Formula& in_x, const core::Formula& in_y, const FieldPtr& u) const {
    if (in_x.empty()) return difference_gradient(u, difference_step);
    return {(*this)(path + "_x", in_x), (*this)(path + "_y", in_y)};
  }
};

MembraneScene from_data(const SceneParams& params) {
  const DataParams& data = *params.data;
  const Reader read{data};
  MembraneScene scene;
  scene.name = "data";
  scene.sentence = "Two membranes with the data of the deck.";
  scene.tension[0] = read("data/mu1", data.mu1, constant(1));
  scene.tension[1] = read("data/mu2", data.mu2, constant(1));
  scene.force[0] = read("data/f1", data.f1, constant(0));
  scene.force[1] = read("data/f2", data.f2, constant(0));
  if (!data.u1.empty()) {
    ExactMembranes exact;
    exact.u[0] = read("data/u1", data.u1);
    exact.u[1] = read("data/u2", data.u2);
    exact.gradient[0] = read.gradient("data/u1", data.u1_x, data.u1_y, exact.u[0]);
    exact.gradient[1] = read.gradient("data/u2", data.u2_x, data.u2_y, exact.u[1]);
    exact.multiplier = read("data/lambda", data.lambda);
    scene.exact = exact;
  }
  scene.interface_level_set = read("interface", params.interface);

  BoundaryCondition& rest = scene.default_boundary;
  rest.value[0] = read("data/g1", data.g1, scene.exact ? scene.exact->u[0] : nullptr);
  rest.value[1] = read("data/g2", data.g2, scene.exact ? scene.exact->u[1] : nullptr);
  for (const auto& [tag, part] : params.boundary) {
    const bool dirichlet = part.kind == BoundaryKind::dirichlet;
    const std::string path = "boundary/" + tag + (dirichlet ? "/g" : "/t");
    BoundaryCondition& condition = scene.boundary[tag];
    condition.kind = part.kind;
    condition.value[0] = dirichlet ? read(path + "1", part.g1, rest.value[0]) : read(path + "1", part.t1, constant(0));
    condition.value[1] = dirichlet ? read(path + "2", part.g2, rest.value[1]) : read(path + "2", part.t2, constant(0));
  }
  return scene;
}

MembraneScene from_case(const SceneParams& params) {
  CatalogueEntry entry = catalogue(*params.case_name);
  if (!params.interface.empty())
    entry.scene.interface_level_set = expression("scene/interface", params.interface.text, entry.centre, entry.constants);
  return entry.scene;
}

}  // namespace

MembraneScene membrane_scene(const SceneParams& params) {
  if (params.model != Model::membranes)
    throw core::InputError("scene/model: only the stationary two membranes can be solved as yet; write 'membranes'.");
  std::string mistakes;
  examine(params, [&](const std::string& path, const std::string& sentence) {
    mistakes += (mistakes.empty() ? "scene" : "\nscene") + (path.empty() ? "" : "/" + path) + ": " + sentence;
  });
  if (!mistakes.empty()) throw core::InputError(mistakes);
  return params.data ? from_data(params) : from_case(params);
}

}  // namespace thixis::scene
