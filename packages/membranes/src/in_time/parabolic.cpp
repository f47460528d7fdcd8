#include <fmt/format.h>

#include "checks/membrane_checks.hpp"
#include "in_time/parabolic_evolution.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::membranes {
namespace {

class ParabolicMembranes final : public models::UnsteadyModel {
 public:
  ParabolicMembranes(MembraneScene scene, method::Method by, method::MethodParams method, algebra::LinearParams linear,
                     std::optional<double> friedrichs)
      : scene_(std::move(scene)), by_(std::move(by)), method_(method), linear_(linear), friedrichs_(friedrichs) {
    for (int alpha = 0; alpha < 2; ++alpha)
      if (!scene_.initial[alpha] && scene_.exact) scene_.initial[alpha] = scene_.exact->u[alpha];
  }
  std::string name() const override { return "parabolic membranes"; }
  std::vector<std::string> point_fields() const override { return MembraneLevel::point_fields(scene_); }
  std::string case_name() const override { return scene_.name == "data" ? "" : scene_.name; }

  void check(const mesh::MeshParams& params, const std::vector<double>& times) const override {
    if (!steady_boundary(scene_)) check_boundary(scene_, params, times);
  }

  std::unique_ptr<models::Evolution> evolve(const mesh::MeshParams& params, const core::Comm& comm, const std::string& folder,
                                            const models::Wanted& wanted) const override {
    mesh::Hierarchy hierarchy;
    {
      const core::Region region("mesh");
      hierarchy = mesh::build(params, comm, folder);
    }
    const mesh::Mesh& mesh = hierarchy.finest();
    check_field_names(scene_, wanted.fields);
    place(wanted.expected, mesh);
    place(wanted.probes, mesh);
    for (int alpha = 0; alpha < 2; ++alpha)
      if (!scene_.initial[alpha])
        throw core::InputError(
            fmt::format("scene/data/initial: nothing says where u{} is at time 0; give initial/u{}.", alpha + 1, alpha + 1));
    check_functions(scene_, {scene_.initial[0], scene_.initial[1], nullptr}, method_, mesh);
    check_order({scene_.initial[0], scene_.initial[1]}, method_, mesh);
    if (by_.check_mesh) by_.check_mesh(mesh, {boundary_of(scene_, mesh).dirichlet, scene_.interface_level_set, method_});
    return std::make_unique<ParabolicEvolution>(scene_, by_, method_, linear_, std::move(hierarchy), friedrichs_, wanted.probes);
  }

 private:
  MembraneScene scene_;
  method::Method by_;
  method::MethodParams method_;
  algebra::LinearParams linear_;
  std::optional<double> friedrichs_;
};

}  // namespace

std::unique_ptr<models::UnsteadyModel> parabolic_membranes(MembraneScene scene, method::Method by, method::MethodParams method,
                                                           algebra::LinearParams linear, std::optional<double> friedrichs) {
  return std::make_unique<ParabolicMembranes>(std::move(scene), std::move(by), method, linear, friedrichs);
}

}  // namespace thixis::membranes
