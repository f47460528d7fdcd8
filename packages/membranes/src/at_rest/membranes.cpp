#include "thixis/membranes/membranes.hpp"

#include <algorithm>
#include <cmath>

#include "checks/membrane_checks.hpp"
#include "checks/membrane_pieces.hpp"
#include "level/membranes_on_mesh.hpp"
#include "scene/heights.hpp"
#include "thixis/bound/guaranteed_bound.hpp"
#include "thixis/bound/published_bound.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/scene/shifted.hpp"

namespace thixis::membranes {
namespace {

using algebra::Vector;
using method::Coefficients;

class MembraneDiscretization final : public MembranesOnMesh<models::Discretization> {
 public:
  MembraneDiscretization(const MembraneScene& scene, double origin, const std::shared_ptr<method::Levels>& levels, int level,
                         const algebra::LinearParams& linear, const std::array<scene::FieldPtr, 3>& initial)
      : scene_(scene), initial_(initial) {
    const core::Region region("assembly");
    on_mesh_ = std::make_unique<MembraneLevel>(scene, origin, levels, level, linear);
  }

  int sweeps() const override { return on_mesh_->forms()[0]->symmetric() ? 10 : 0; }

  Teuchos::RCP<Vector> cold_start() const override {
    const auto X = on_mesh_->zero();
    Fields x = on_mesh_->fields(*X);
    for (int alpha = 0; alpha < scene_.count; ++alpha)
      if (initial_[alpha]) space().interpolate(*initial_[alpha], 0, *x.u.getVectorNonConst(alpha));
    if (initial_[2]) space().interpolate_multiplier(*initial_[2], 0, x.lambda);
    on_mesh_->start_from(x.u);
    return X;
  }

  Teuchos::RCP<Vector> nested_start(const models::Discretization& coarse_level, const Vector& coarse_X) const override {
    const auto& coarse = dynamic_cast<const MembraneDiscretization&>(coarse_level);
    auto X = on_mesh_->from_coarse(*coarse.on_mesh_, coarse_X);
    on_mesh_->levels().keep_from(on_mesh_->level());
    // moments come with noise of both signs
    if (space().nodal_multiplier()) on_mesh_->problem().make_complementary(*X);
    return X;
  }

  models::State save(const Vector& X) const override { return {on_mesh_->save(X), {}}; }
  Teuchos::RCP<Vector> restore(const output::StoredCheckpoint& stored) override { return on_mesh_->restore(stored); }

  std::optional<double> energy_error(const Vector& X) const override {
    if (!scene_.exact) return std::nullopt;
    return std::sqrt(squared_energy_error(*on_mesh_, at(X), 0));
  }

  complementarity::Estimate estimate(const Vector& X) override {
    if (!bound_) {
      const core::Region region("estimate set-up");
      bound_ = std::make_unique<bound::GuaranteedBound>(space(), on_mesh_->contact_problem(), hierarchy(), on_mesh_->level());
    }
    const MembraneIterate seen(*on_mesh_, X);
    return (*bound_)(seen.iterate);
  }

  std::vector<std::string> doubts() const override { return bound_ ? bound_->doubts() : std::vector<std::string>(); }

  models::CellEstimates cell_estimates() const override { return bound_ ? cells_of(bound_->cells()) : models::CellEstimates(); }
  std::size_t bytes_of_estimate() const override { return bound_ ? bound_->bytes() : 0; }

  std::optional<models::PublishedEstimate> published_estimate(const Vector& X, std::optional<double> friedrichs) override {
    if (!space().conforming()) return std::nullopt;
    const auto& dirichlet = on_mesh_->boundary().dirichlet;
    const bool held = std::all_of(dirichlet.begin(), dirichlet.end(), [](bool kind) { return kind; });
    if (!friedrichs && !held) return std::nullopt;
    const double C = friedrichs ? *friedrichs : bound::friedrichs_of_box(space().mesh());
    const MembraneIterate seen(*on_mesh_, X);
    const Coefficients gap = difference(seen.iterate.u[0], scene_.count == 2 ? seen.iterate.u[1] : on_mesh_->obstacle());
    const auto bound = bound::published_bound(space(), on_mesh_->contact_problem(), hierarchy(), on_mesh_->level(), seen.iterate, gap, C);
    return models::PublishedEstimate{bound.parts,
                                     {{"flux", bound.flux},
                                      {"residual", bound.residual},
                                      {"contact", bound.contact},
                                      {"nonconformity_1", bound.nonconformity[0]},
                                      {"nonconformity_2", bound.nonconformity[1]},
                                      {"nonconformity_3", bound.nonconformity[2]}}};
  }

  complementarity::KktData kkt_data(const Vector& X) const override { return membranes::kkt_data(solution(X)); }
  models::Rounding rounding(const Vector& X) const override { return on_mesh_->rounding(X); }

 private:
  const mesh::Hierarchy& hierarchy() const { return on_mesh_->levels().hierarchy(); }

  const MembraneScene& scene_;
  const std::array<scene::FieldPtr, 3>& initial_;
  std::unique_ptr<bound::GuaranteedBound> bound_;  ///< made when an estimate is first asked for
};

class Membranes final : public models::StationaryModel {
 public:
  Membranes(MembraneScene scene, method::Method by, method::MethodParams method, algebra::LinearParams linear,
            std::array<scene::FieldPtr, 3> initial)
      : scene_(std::move(scene)), by_(std::move(by)), method_(method), linear_(linear), initial_(std::move(initial)) {
    for (int field = 0; field < 3; ++field)
      if (!initial_[field]) initial_[field] = scene_.initial[field];
  }
  std::string name() const override { return scene_.count == 1 ? "obstacle" : "membranes"; }
  std::string case_name() const override { return scene_.name == "data" ? "" : scene_.name; }
  std::vector<std::string> point_fields() const override { return MembraneLevel::point_fields(scene_); }
  void check(const mesh::Mesh& mesh, const models::Wanted& wanted) const override {
    check_field_names(scene_, wanted.fields);
    place(wanted.expected, mesh);
    place(wanted.probes, mesh);
    const Boundary boundary = boundary_of(scene_, mesh);
    check_held(scene_, boundary);
    check_functions(scene_, initial_, method_, mesh);
    check_pieces(scene_, boundary, mesh);
    if (by_.check_mesh) by_.check_mesh(mesh, {boundary.dirichlet, scene_.interface_level_set, method_});
  }
  std::unique_ptr<models::Discretization> discretize(const mesh::Hierarchy& hierarchy, int level) const override {
    if (!counted_) count_from(heights_of(scene_, hierarchy.levels.front(), 0).origin());
    const auto levels = levels_on(hierarchy);
    levels->keep_to(level);
    return std::make_unique<MembraneDiscretization>(counted_->scene, counted_->origin, levels, level, linear_, counted_->initial);
  }

 private:
  /// The functions with heights counted from `origin`, where the membranes are held.
  struct Counted {
    double origin;
    MembraneScene scene;
    std::array<scene::FieldPtr, 3> initial;
  };
  void count_from(double origin) const {
    counted_ = Counted{origin, counted_from(origin, scene_), initial_};
    for (int alpha = 0; alpha < scene_.count; ++alpha) counted_->initial[alpha] = scene::shifted(initial_[alpha], -origin);
  }

  /// They live as long as a discretization of theirs, and so does the hierarchy.
  std::shared_ptr<method::Levels> levels_on(const mesh::Hierarchy& hierarchy) const {
    auto levels = levels_.lock();
    if (!levels || &levels->hierarchy() != &hierarchy) levels_ = levels = levels_of(counted_->scene, by_, method_, hierarchy);
    return levels;
  }

  MembraneScene scene_;
  mutable std::optional<Counted> counted_;  ///< since the first mesh
  mutable std::weak_ptr<method::Levels> levels_;
  method::Method by_;
  method::MethodParams method_;
  algebra::LinearParams linear_;
  std::array<scene::FieldPtr, 3> initial_;
};

}  // namespace

std::unique_ptr<models::StationaryModel> membranes(MembraneScene scene, method::Method by, method::MethodParams method,
                                                   algebra::LinearParams linear, std::array<scene::FieldPtr, 3> initial) {
  return std::make_unique<Membranes>(std::move(scene), std::move(by), method, linear, std::move(initial));
}

}  // namespace thixis::membranes
