#include "thixis/drive/run.hpp"

namespace thixis::drive {
namespace {

using scene::Model;

/// The scene of a name: a case with its model, or a model alone.
std::optional<scene::SceneParams> scene_of(const std::string& name) {
  scene::SceneParams params;
  for (const auto& known : scene::cases())
    if (known.name == name) {
      params.model = known.model;
      params.case_name = name;
      return params;
    }
  for (const Model model : {Model::membranes, Model::obstacle, Model::parabolic_membranes, Model::two_phase})
    if (scene::to_text(model) == name) {
      params.model = model;
      return params;
    }
  return std::nullopt;
}

/// Data of a user to begin with: membranes that are pressed together, or on an obstacle.
scene::DataParams some_data(Model model) {
  scene::DataParams data;
  if (model == Model::obstacle) {
    data.f = {"-8"};
    data.g = {"0"};
    data.psi = {"-0.25"};
    return data;
  }
  data.f1 = {"-4"};
  data.f2 = {"2"};
  data.g1 = {"0.1"};
  data.g2 = {"-0.1"};
  if (model == Model::parabolic_membranes) data.initial = scene::InitialParams{{"0.1"}, {"-0.1"}};
  return data;
}

/// Rock of 200 m for the injection of gas, a column of 20 m, or a slab of 200 m x 20 m.
mesh::MeshParams rock(const std::string& case_name) {
  mesh::MeshParams mesh;
  const bool slab = case_name == "gas injection 2d", column = case_name == "closed column";
  mesh.generator = slab ? mesh::Generator::tensor : mesh::Generator::interval;
  mesh.lower = slab ? std::vector<double>{0, 0} : std::vector<double>{0};
  mesh.upper = slab ? std::vector<double>{200, 20} : std::vector<double>{column ? 20. : 200.};
  mesh.cells = slab ? std::vector<int>{50, 8} : std::vector<int>{100};
  return mesh;
}

TimeParams some_time(Model model) {
  TimeParams time;
  if (model != Model::two_phase) return time;
  time.unit = TimeUnit::year;
  time.step = 1e4;
  time.end = 1e5;
  return time;
}

bool on_the_disk(const std::optional<std::string>& case_name) {
  return case_name && (*case_name == "disk" || *case_name == "disk b" || *case_name == "radial obstacle" || *case_name == "rings");
}

}  // namespace

std::optional<RunParams> starting(const std::string& name) {
  const auto scene = scene_of(name);
  if (!scene) return std::nullopt;
  RunParams params;
  params.scene = *scene;
  const bool flow = scene->model == Model::two_phase;
  if (flow && !scene->case_name) params.scene.case_name = "gas injection";
  if (!flow && !scene->case_name) params.scene.data = some_data(scene->model);
  if (flow) {
    params.method.name = method::MethodName::fv;
    params.mesh = rock(*params.scene.case_name);
  }
  if (on_the_disk(params.scene.case_name)) params.mesh.generator = mesh::Generator::disk;
  if (flow || scene->model == Model::parabolic_membranes) params.time = some_time(scene->model);
  return params;
}

}  // namespace thixis::drive
