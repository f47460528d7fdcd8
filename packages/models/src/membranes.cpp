#include "thixis/models/membranes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "membrane_checks.hpp"
#include "membrane_kkt.hpp"
#include "membrane_problem.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/equilibration/guaranteed_bound.hpp"
#include "thixis/equilibration/published_bound.hpp"

namespace thixis::models {
namespace {

using algebra::Vector;
using method::Coefficients;

void check_size(const output::StoredCheckpoint& stored, const std::string& block, GlobalIndex unknowns) {
  const GlobalIndex saved = stored.size(block);
  if (saved == unknowns) return;
  throw core::InputError(
      fmt::format("The checkpoint '{}' belongs to another model, mesh or method: it holds {}, the deck asks for {}; leave scene/model, "
                  "mesh, method and the kinds of the boundary as they were.",
                  stored.path(), saved < 0 ? fmt::format("no '{}'", block) : fmt::format("{} values of '{}'", saved, block), unknowns));
}

/// Brings coefficients together where those of the upper membrane are below those of the lower one, the first ones: at the mean with the
/// weights share and 1 - share.
void keep_in_order(const Coefficients& upper, const Coefficients& lower, const std::vector<double>& share) {
  const Coefficients theta("thixis::models::share", share.size());
  const auto host = Kokkos::create_mirror_view(theta);
  std::copy(share.begin(), share.end(), host.data());
  Kokkos::deep_copy(theta, host);
  Kokkos::parallel_for(
      "thixis::models::keep_in_order", Kokkos::RangePolicy<>(0, share.size()), KOKKOS_LAMBDA(std::size_t i) {
        if (upper(i) < lower(i)) upper(i) = lower(i) = theta(i) * upper(i) + (1 - theta(i)) * lower(i);
      });
}

class MembraneDiscretization final : public Discretization {
 public:
  MembraneDiscretization(const scene::MembraneScene& scene, const method::SpaceFactory& make_space, const method::MethodParams& method,
                         const algebra::LinearParams& linear, const std::array<scene::FieldPtr, 3>& initial,
                         const mesh::Hierarchy& hierarchy, int level)
      : scene_(scene), initial_(initial), hierarchy_(hierarchy), level_(level) {
    const core::Region region("assembly");
    const mesh::Mesh& mesh = hierarchy.levels[level];
    const Boundary boundary = boundary_of(scene, mesh);
    space_ = make_space(mesh, {boundary.dirichlet, scene.interface_level_set, method});
    for (int alpha = 0; alpha < scene.count; ++alpha) {
      lift_[alpha] = space_->lift(boundary.values[alpha], 0);
      body_[alpha] = Teuchos::rcp(new Vector(space_->map()));
      space_->load(*scene.tension[alpha], *scene.force[alpha], boundary.values[alpha], 0, *body_[alpha]);
    }
    nothing_ = Coefficients("thixis::models::nothing", lift_[0].extent(0));
    // Bernstein coefficients of ordered data need not be ordered
    if (method.nodes == method::Nodes::bernstein && scene.count == 2) keep_in_order(lift_[0], lift_[1], share_of_upper_tension());
    problem_ = std::make_unique<MembraneProblem>(membrane_operator(scene, *space_, method, lift_, body_), linear, space_->coordinates());
    if (scene.count == 1) obstacle_ = space_->complete(*problem_->membranes().obstacle, lift_of_obstacle(boundary));
  }

  complementarity::Problem& problem() override { return *problem_; }

  Sizes sizes() const override { return {problem_->unknowns(), problem_->rows(), problem_->nonzeros()}; }

  Teuchos::RCP<Vector> cold_start() const override {
    Fields x = fields();
    for (int alpha = 0; alpha < scene_.count; ++alpha)
      if (initial_[alpha]) space_->interpolate(*initial_[alpha], 0, *x.u.getVectorNonConst(alpha));
    if (initial_[2]) space_->interpolate_multiplier(*initial_[2], 0, x.lambda);
    return joined(x);
  }

  Teuchos::RCP<Vector> nested_start(const Discretization& coarse_level, const Vector& coarse_X) const override {
    const auto& coarse = dynamic_cast<const MembraneDiscretization&>(coarse_level);
    Fields coarse_x = coarse.fields(coarse_X), x = fields();
    coarse.problem_->settle(coarse_x);
    for (int alpha = 0; alpha < scene_.count; ++alpha) {
      Coefficients u = coarse.membrane(coarse_x, alpha);
      if (scene_.count == 1) u = difference(u, coarse.obstacle_);  // the gap: where it is closed it stays so
      space_->prolongate(*coarse.space_, u, *x.u.getVectorNonConst(alpha));
    }
    if (scene_.count == 1) x.u.update(1, *problem_->membranes().obstacle, 1);
    space_->prolongate_multiplier(*coarse.space_, coarse_x.lambda, x.lambda);
    // moments come with noise of both signs
    if (space_->nodal_multiplier()) problem_->make_complementary(x);
    return joined(x);
  }

  std::vector<output::CheckpointBlock> save(const Vector& X) const override {
    const Fields x = fields(X);
    std::vector<output::CheckpointBlock> blocks;
    const auto ids = space_->unknown_ids();
    const auto add = [&](const std::string& name, const Vector& v) {
      const auto values = algebra::host_view(v);
      const auto count = static_cast<std::ptrdiff_t>(values.extent(0));
      blocks.push_back({name, {ids.begin(), ids.begin() + count}, {values.data(), values.data() + count}});
    };
    for (int alpha = 0; alpha < scene_.count; ++alpha) add(displacement(alpha), *x.u.getVector(alpha));
    add("lambda", x.lambda);
    return blocks;
  }

  Teuchos::RCP<Vector> restore(const output::StoredCheckpoint& stored) const override {
    Fields x = fields();
    const auto ids = space_->unknown_ids();
    const auto fetch = [&](const std::string& name, Vector& v) {
      check_size(stored, name, static_cast<GlobalIndex>(v.getGlobalLength()));
      const auto values = stored.fetch(name, {ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(v.getLocalLength())});
      const auto out = algebra::host_overwrite(v);
      std::copy(values.begin(), values.end(), out.data());
    };
    for (int alpha = 0; alpha < scene_.count; ++alpha) fetch(displacement(alpha), *x.u.getVectorNonConst(alpha));
    fetch("lambda", x.lambda);
    return joined(x);
  }

  std::optional<double> energy_error(const Vector& X) const override {
    if (!scene_.exact) return std::nullopt;
    const Fields x = fields(X);
    double sum = 0;
    for (int alpha = 0; alpha < scene_.count; ++alpha)
      sum += space_->energy_error(*scene_.tension[alpha], membrane(x, alpha), scene_.exact->gradient[alpha], 0);
    return std::sqrt(sum);
  }

  double energy_norm(const Vector& X) const override {
    const Fields x = fields(X);
    double sum = 0;
    for (int alpha = 0; alpha < scene_.count; ++alpha) sum += space_->energy(*scene_.tension[alpha], membrane(x, alpha));
    return std::sqrt(sum);
  }

  complementarity::Estimate estimate(const Vector& X) override {
    if (!bound_) {
      const core::Region region("estimate set-up");
      bound_ = std::make_unique<equilibration::GuaranteedBound>(polynomials(), contact_problem(), hierarchy_, level_);
    }
    const Seen seen(*this, X);
    return (*bound_)(seen.iterate);
  }

  CellEstimates cell_estimates() const override {
    CellEstimates of_cells;
    if (!bound_) return of_cells;
    const auto copy = [](const mesh::View<double*>& values) {
      const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), values);
      return std::vector<double>(host.data(), host.data() + host.extent(0));
    };
    const auto& parts = bound_->cells();
    return {copy(parts.discretization), copy(parts.linearization), copy(parts.algebraic)};
  }

  std::size_t bytes_of_estimate() const override { return bound_ ? bound_->bytes() : 0; }

  std::optional<PublishedEstimate> published_estimate(const Vector& X, std::optional<double> friedrichs) override {
    if (!polynomials().conforming()) return std::nullopt;
    const Boundary boundary = boundary_of(scene_, space_->mesh());
    const bool held = std::all_of(boundary.dirichlet.begin(), boundary.dirichlet.end(), [](bool dirichlet) { return dirichlet; });
    if (!friedrichs && !held) return std::nullopt;
    const double C = friedrichs ? *friedrichs : equilibration::friedrichs_of_box(space_->mesh());
    const Seen seen(*this, X);
    const Coefficients gap = difference(seen.iterate.u[0], scene_.count == 2 ? seen.iterate.u[1] : obstacle_);
    const auto bound = equilibration::published_bound(polynomials(), contact_problem(), hierarchy_, level_, seen.iterate, gap, C);
    return PublishedEstimate{bound.parts,
                             {{"flux", bound.flux},
                              {"residual", bound.residual},
                              {"contact", bound.contact},
                              {"nonconformity_1", bound.nonconformity[0]},
                              {"nonconformity_2", bound.nonconformity[1]},
                              {"nonconformity_3", bound.nonconformity[2]}}};
  }

  complementarity::KktData kkt_data(const Vector& X) const override {
    MembraneSolution solution{scene_, *space_, *problem_, body_, fields(X), {}};
    for (int alpha = 0; alpha < scene_.count; ++alpha) solution.u[alpha] = membrane(solution.x, alpha);
    return models::kkt_data(solution);
  }

  output::Grid grid() const override { return space_->display(); }

  std::vector<output::FieldData> fields(const Vector& X, const complementarity::ActiveSet& active,
                                        const std::vector<std::string>& names) const override {
    const Fields x = fields(X);
    std::vector<output::FieldData> shown;
    const auto add = [&](const std::string& name, auto values) {
      if (names.empty() || std::find(names.begin(), names.end(), name) != names.end())
        shown.push_back({name, output::Centre::vertex, values()});
    };
    for (int alpha = 0; alpha < scene_.count; ++alpha) add(displacement(alpha), [&] { return space_->shown(membrane(x, alpha)); });
    add("lambda", [&] { return space_->shown(space_->multiplier(x.lambda)); });
    add("gap", [&] {
      auto gap = space_->shown(membrane(x, 0));
      const auto below = scene_.count == 2 ? space_->shown(membrane(x, 1)) : at_points(*scene_.obstacle);
      for (std::size_t i = 0; i < gap.size(); ++i) gap[i] -= below[i];
      return gap;
    });
    add("active", [&] {
      Vector flag(space_->map());
      {
        const auto out = algebra::host_view(flag);
        for (std::size_t l = 0; l < active.flags().size(); ++l) out(l) = active.flags()[l];
      }
      return space_->coefficients_shown(space_->complete(flag, nothing_));
    });
    return shown;
  }

 private:
  std::string displacement(int alpha) const { return scene_.count == 1 ? "u" : alpha == 0 ? "u1" : "u2"; }
  Fields fields() const { return Fields(problem_->membranes()); }
  Fields fields(const Vector& X) const { return Fields(problem_->membranes(), X); }
  Coefficients membrane(const Fields& x, int alpha) const { return space_->complete(*x.u.getVector(alpha), lift_[alpha]); }

  /// X with what the bounds read of it.
  struct Seen {
    Fields x, r;
    Vector gap_l;
    Teuchos::RCP<const Vector> residual[2];
    equilibration::Iterate iterate;

    Seen(const MembraneDiscretization& of, const Vector& X) : x(of.fields(X)), r(of.fields()), gap_l(of.problem_->points()) {
      Vector R(of.problem_->map());
      of.problem_->equations(X, R);
      split(R, r);
      r.u.scale(-1);
      gap(of.problem_->membranes(), x.u, gap_l);
      iterate.lambda = &x.lambda;
      iterate.gap = &gap_l;
      for (int alpha = 0; alpha < of.scene_.count; ++alpha) {
        iterate.u[alpha] = of.membrane(x, alpha);
        residual[alpha] = r.u.getVector(alpha);
        iterate.residual[alpha] = residual[alpha].get();
      }
    }
    Seen(const Seen&) = delete;
    Seen& operator=(const Seen&) = delete;
  };

  const method::PolynomialSpace& polynomials() const { return dynamic_cast<const method::PolynomialSpace&>(*space_); }

  equilibration::ContactProblem contact_problem() const {
    const Boundary boundary = boundary_of(scene_, space_->mesh());
    equilibration::ContactProblem contact;
    contact.count = scene_.count;
    contact.obstacle = scene_.obstacle;
    contact.interface = scene_.interface_level_set;
    for (int alpha = 0; alpha < scene_.count; ++alpha) {
      contact.tension[alpha] = scene_.tension[alpha];
      contact.force[alpha] = scene_.force[alpha];
      contact.boundary[alpha] = boundary.values[alpha];
    }
    return contact;
  }

  Coefficients lift_of_obstacle(const Boundary& boundary) const {
    method::BoundaryValues psi = boundary.values[0];
    for (auto& value : psi.dirichlet)
      if (value) value = scene_.obstacle;
    return space_->lift(psi, 0);
  }

  /// Values at the points of the grid.
  std::vector<double> at_points(const scene::Field& field) const {
    const auto points = space_->display().points;
    std::vector<double> x, y, values(points.size());
    for (const auto& point : points) {
      x.push_back(point[0]);
      y.push_back(point[1]);
    }
    space_->mesh().comm.together([&] { field.evaluate({points.size(), x.data(), y.data()}, 0, values.data()); });
    return values;
  }

  /// mu_1 / (mu_1 + mu_2) at the points of the grid: the stiffer membrane gives way less.
  std::vector<double> share_of_upper_tension() const {
    auto share = at_points(*scene_.tension[0]);
    const auto lower = at_points(*scene_.tension[1]);
    for (std::size_t i = 0; i < share.size(); ++i) {
      const double both = share[i] + lower[i];
      share[i] = both > 0 ? std::clamp(share[i] / both, 0.0, 1.0) : 0.5;
    }
    return share;
  }

  Teuchos::RCP<Vector> joined(const Fields& x) const {
    auto X = Teuchos::rcp(new Vector(problem_->map()));
    join(x, *X);
    return X;
  }

  const scene::MembraneScene& scene_;
  const std::array<scene::FieldPtr, 3>& initial_;
  const mesh::Hierarchy& hierarchy_;
  int level_;
  std::unique_ptr<method::Space> space_;
  Coefficients nothing_;  ///< no boundary values
  Coefficients lift_[2];
  Coefficients obstacle_;         ///< the interpolant of psi, for count = 1
  Teuchos::RCP<Vector> body_[2];  ///< loads, before the lifts are moved to the right
  std::unique_ptr<MembraneProblem> problem_;
  std::unique_ptr<equilibration::GuaranteedBound> bound_;  ///< made when an estimate is first asked for
};

class Membranes final : public StationaryModel {
 public:
  Membranes(scene::MembraneScene scene, method::SpaceFactory make_space, method::MethodParams method, algebra::LinearParams linear,
            std::array<scene::FieldPtr, 3> initial, method::MeshCheck check_mesh)
      : scene_(std::move(scene)),
        make_space_(std::move(make_space)),
        check_mesh_(std::move(check_mesh)),
        method_(method),
        linear_(linear),
        initial_(std::move(initial)) {
    for (int field = 0; field < 3; ++field)
      if (!initial_[field]) initial_[field] = scene_.initial[field];
  }
  std::string name() const override { return scene_.count == 1 ? "obstacle" : "membranes"; }
  std::string case_name() const override { return scene_.name == "data" ? "" : scene_.name; }
  void check(const mesh::Mesh& mesh, const std::vector<std::string>& field_names) const override {
    check_field_names(scene_, field_names);
    check_functions(scene_, initial_, method_, mesh);
    if (check_mesh_) check_mesh_(mesh, {boundary_of(scene_, mesh).dirichlet, scene_.interface_level_set, method_});
  }
  std::unique_ptr<Discretization> discretize(const mesh::Hierarchy& hierarchy, int level) const override {
    return std::make_unique<MembraneDiscretization>(scene_, make_space_, method_, linear_, initial_, hierarchy, level);
  }

 private:
  scene::MembraneScene scene_;
  method::SpaceFactory make_space_;
  method::MeshCheck check_mesh_;
  method::MethodParams method_;
  algebra::LinearParams linear_;
  std::array<scene::FieldPtr, 3> initial_;
};

}  // namespace

std::unique_ptr<StationaryModel> membranes(scene::MembraneScene scene, method::SpaceFactory make_space, method::MethodParams method,
                                 algebra::LinearParams linear, std::array<scene::FieldPtr, 3> initial, method::MeshCheck check_mesh) {
  return std::make_unique<Membranes>(std::move(scene), std::move(make_space), method, linear, std::move(initial), std::move(check_mesh));
}

}  // namespace thixis::models
