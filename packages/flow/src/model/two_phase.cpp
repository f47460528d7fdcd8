#include "thixis/flow/two_phase.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/evolution.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/text.hpp"

namespace thixis::flow {
namespace {

class TwoPhaseModel final : public models::UnsteadyModel {
 public:
  TwoPhaseModel(TwoPhaseScene scene, algebra::LinearParams linear, double seconds_per_unit, const TwoPhaseBoundParams& bound)
      : scene_(std::move(scene)), linear_(linear), seconds_per_unit_(seconds_per_unit), bound_(bound) {}

  std::string name() const override { return "two-phase"; }
  std::vector<std::string> point_fields() const override { return {"s_g", "p_l", "p_g", "chi"}; }
  std::string case_name() const override { return scene_.name == "flow" ? "" : scene_.name; }

  std::unique_ptr<models::Evolution> evolve(const mesh::MeshParams& mesh, const core::Comm& comm, const std::string& folder,
                                            const models::Wanted& wanted) const override {
    for (const auto& name : wanted.fields)
      if (std::find(names_of_fields().begin(), names_of_fields().end(), name) == names_of_fields().end())
        throw core::InputError(
            fmt::format("output/fields: there is no field '{}'; write all, none, or some of {}.", name, core::join(names_of_fields())));
    fv::Grid grid = fv::build(mesh, comm, folder);
    if (!wanted.expected.empty()) TwoPhaseProbes(grid, wanted.expected);
    return std::make_unique<TwoPhaseEvolution>(std::move(grid), scene_, linear_, seconds_per_unit_, wanted.probes, bound_);
  }

 private:
  TwoPhaseScene scene_;
  algebra::LinearParams linear_;
  double seconds_per_unit_;
  TwoPhaseBoundParams bound_;
};

}  // namespace

std::unique_ptr<models::UnsteadyModel> two_phase(TwoPhaseScene scene, algebra::LinearParams linear, double seconds_per_unit,
                                                 const TwoPhaseBoundParams& bound) {
  return std::make_unique<TwoPhaseModel>(std::move(scene), linear, seconds_per_unit, bound);
}

}  // namespace thixis::flow
