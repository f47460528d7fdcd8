#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "exact_gradient.hpp"
#include "heights.hpp"
#include "membrane_kkt.hpp"
#include "membrane_level.hpp"
#include "thixis/bound/step_bound.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/membranes/parabolic_membranes.hpp"
#include "thixis/mesh/adapt.hpp"
#include "thixis/scene/shifted.hpp"

namespace thixis::membranes {
namespace {

using algebra::Vector;
using method::Coefficients;

constexpr double gauss_point = 0.21132486540518711775;  ///< (1 - 1/sqrt 3)/2: the first of two on [0, 1], both of weight 1/2

constexpr double finest = 1e-4;  ///< relative error in time that a method of first order is not asked to fall below

/// a u + b v.
Coefficients combination(double a, const Coefficients& u, double b, const Coefficients& v) {
  const Coefficients w("thixis::membranes::combination", u.extent(0));
  Kokkos::parallel_for(
      "thixis::membranes::combination", Kokkos::RangePolicy<>(0, u.extent_int(0)), KOKKOS_LAMBDA(int i) { w(i) = a * u(i) + b * v(i); });
  return w;
}

/// Both membranes as functions at one time.
struct Pair {
  Coefficients u[2];
};

class ParabolicEvolution final : public models::Evolution {
 public:
  ParabolicEvolution(const MembraneScene& scene, const method::SpaceFactory& make_space, const method::MethodParams& method,
                     const algebra::LinearParams& linear, mesh::Hierarchy hierarchy, std::optional<double> friedrichs,
                     std::vector<models::Probe> probes)
      : origin_(heights_of(scene, hierarchy.levels.front(), 0).origin()),
        scene_(counted_from(origin_, scene)),
        make_space_(make_space),
        method_(method),
        linear_(linear),
        hierarchy_(std::move(hierarchy)),
        friedrichs_(friedrichs),
        probes_(std::move(probes)) {
    on_mesh_ = make_level();
  }

  const core::Comm& comm() const override { return space().mesh().comm; }
  GlobalIndex cells() const override { return space().mesh().global_cells; }
  models::Sizes sizes() const override {
    const MembraneProblem& problem = on_mesh_->problem();
    return {problem.unknowns(), problem.rows(), problem.nonzeros()};
  }

  Teuchos::RCP<Vector> initial() override {
    on_mesh_->move_to(0);
    auto X = on_mesh_->zero();
    Fields x = on_mesh_->fields(*X);
    for (int alpha = 0; alpha < 2; ++alpha) space().interpolate(*scene_.initial[alpha], 0, *x.u.getVectorNonConst(alpha));
    return X;
  }

  void check(const std::vector<double>& times) const override {
    if (steady_boundary(scene_)) return;
    for (const double t : times) check_boundary(scene_, on_mesh_->boundary(), method_, space().mesh(), t);
  }

  /// F_alpha <- (f_alpha, psi) + (u_alpha^{n-1}, psi)/tau - a_alpha(g, psi) - (g, psi)/tau with the lift g of the boundary values.
  void begin(const models::TimeStep& step, const Vector& before) override {
    const core::Region region("assembly");
    step_ = step;
    open_ = true;
    begun_ = estimated_ = false;
    on_mesh_->move_to(step.begin);
    before_ = at(before);
    on_mesh_->move_to(step.end);
    MembraneProblem& problem = on_mesh_->problem();
    if (1 / step.length() != weight_) {
      weight_ = 1 / step.length();
      problem.set_inertia(space(), weight_);
    }
    Vector part(space().map());
    for (int alpha = 0; alpha < 2; ++alpha) {
      const auto F = problem.membranes().system.load->getVectorNonConst(alpha);
      space().apply_mass(combination(weight_, before_.u[alpha], -weight_, on_mesh_->lift(alpha)), part);
      F->update(1, *on_mesh_->body()[alpha], 1, part, 0);
      space().forces(*scene_.tension[alpha], on_mesh_->lift(alpha), part);
      F->update(-1, part, 1);
    }
    on_mesh_->measure_from(on_mesh_->fields(before).u);
    X_before_ = Teuchos::rcp(new Vector(before, Teuchos::Copy));
    begun_ = true;
  }

  void give_up() override {
    if (open_) on_mesh_->move_to(step_.begin);
    begun_ = open_ = estimated_ = false;
  }

  /// X^{n-1} + ratio (X^{n-1} - X^{n-2}), made complementary point by point.
  bool predict(Vector& X) override {
    if (before_last_.is_null()) return false;
    const double ratio = step_.length() / last_length_;
    X.update(1 + ratio, *X_before_, -ratio, *before_last_, 0);
    on_mesh_->problem().make_admissible(*X_before_, X);
    return true;
  }

  complementarity::Problem& problem() override { return on_mesh_->problem(); }

  complementarity::Estimate estimate(const Vector& X) override {
    if (!bound_) {
      bound_ = make_bound(step_.end);
      if (!restored_bound_.empty()) bound_->restore(restored_bound_);
    }
    if (!estimated_) {
      if (step_.begin == 0) {
        bound_->start(0, before_.u, {scene_.initial[0], scene_.initial[1]});
        bounded_ = true;
      }
      bound_->begin(step_.begin, step_.end, before_.u);
      estimated_ = true;
    }
    const MembraneIterate seen(*on_mesh_, X);
    for (int alpha = 0; alpha < 2; ++alpha) seen_.u[alpha] = seen.iterate.u[alpha];
    return (*bound_)(seen.iterate);
  }
  models::CellEstimates cell_estimates() const override {
    if (!bound_) return {};
    const auto copy = [](const mesh::View<double*>& values) {
      const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), values);
      return std::vector<double>(host.data(), host.data() + host.extent(0));
    };
    const auto& parts = bound_->cells();
    return {copy(parts.discretization), copy(parts.linearization), copy(parts.algebraic)};
  }
  std::optional<models::StepErrors> step_errors() const override {
    if (!estimated_) return std::nullopt;
    const auto errors = bound_->errors();
    double energy = 0;
    for (int alpha = 0; alpha < 2; ++alpha) energy += space().energy(*scene_.tension[alpha], seen_.u[alpha]);
    return models::StepErrors{errors.time, errors.space, finest * std::sqrt(step_.length() * energy)};
  }

  std::vector<std::string> doubts() const override { return bound_ ? bound_->doubts() : std::vector<std::string>(); }
  std::string remark() const override {
    if (!estimated_ || bound_->resolved()) return {};
    return fmt::format(
        "between t = {:.6g} and {:.6g} a force changes in a way that the rule in time of the bound does not see: the bound takes in what "
        "32 "
        "parts of the step show. Take shorter steps (time/step, time/adaptive), or let one end where data jump (time/also).",
        step_.begin, step_.end);
  }

  void accept(const Vector& X) override {
    if (scene_.exact) squared_error_ += step_error(at(X));
    if (estimated_) bound_->accept();
    else bounded_ = false;
    before_last_ = X_before_;
    last_length_ = step_.length();
    open_ = false;
  }

  std::optional<double> energy_error() const override {
    if (!scene_.exact) return std::nullopt;
    return std::sqrt(squared_error_);
  }

  std::optional<double> step_energy_error(const Vector& X) const override {
    if (!scene_.exact) return std::nullopt;
    return std::sqrt(step_error(at(X)));
  }

  double energy_norm(const Vector& X) const override {
    const Pair now = at(X);
    double square = 0;
    for (int alpha = 0; alpha < 2; ++alpha) square += space().energy(*scene_.tension[alpha], now.u[alpha]);
    return std::sqrt(square);
  }

  /// Nothing before the first step and after one that was not estimated.
  std::optional<complementarity::Estimate> estimate_so_far() const override {
    if (!bounded_ || !bound_) return std::nullopt;
    return bound_->so_far();
  }

  bool every_step_estimated() const override { return bounded_ || on_mesh_->time() == 0; }

  /// At X^0, and where a run is taken up again, the equations say nothing: the multiplier is judged by its sign alone.
  complementarity::KktData kkt_data(const Vector& X) const override {
    MembraneSolution solution{scene_, space(), on_mesh_->problem(), on_mesh_->body(), on_mesh_->fields(X)};
    solution.t = on_mesh_->time();
    for (int alpha = 0; alpha < 2; ++alpha) {
      solution.u[alpha] = on_mesh_->membrane(solution.x, alpha);
      if (begun_) solution.rate[alpha] = combination(weight_, solution.u[alpha], -weight_, before_.u[alpha]);
    }
    auto data = membranes::kkt_data(solution);
    if (!begun_) {
      data.equilibrium = {data.claimed};
      data.unbalanced = 0;
    }
    return data;
  }

  std::vector<std::string> series_names() const override {
    std::vector<std::string> names = {"contact_area", "contact_force", "largest_gap"};
    if (scene_.exact) names.insert(names.end(), {"energy_error", "l2_error_u1", "l2_error_u2"});
    for (std::size_t i = 0; i < probes_.size(); ++i)
      for (const auto& field : MembraneLevel::point_fields(scene_)) names.push_back(i == 0 ? field : fmt::format("{}_{}", field, i + 1));
    return names;
  }

  /// (contact area and force, max_l gap_l; of the errors at this time the energy norm and the L² norms; the fields at the probes).
  std::vector<double> series(const Vector& X) const override {
    const models::Contact contact = on_mesh_->contact(X);
    std::vector<double> values = {contact.area, contact.force, on_mesh_->largest_gap(X)};
    if (scene_.exact) {
      const Pair now = at(X);
      const double t = on_mesh_->time();
      values.push_back(std::sqrt(squared_energy_error(now, t)));
      for (int alpha = 0; alpha < 2; ++alpha) values.push_back(std::sqrt(space().l2_error(now.u[alpha], *scene_.exact->u[alpha], t)));
    }
    if (!probes_.empty())
      for (const double value : on_mesh_->values_at(probes_, X)) values.push_back(value);
    return values;
  }
  std::optional<models::Contact> contact(const Vector& X) const override { return on_mesh_->contact(X); }
  std::vector<double> values_at(const std::vector<models::Probe>& probes, const Vector& X) const override {
    return on_mesh_->values_at(probes, X);
  }

  output::Grid grid() const override { return space().display(); }
  std::vector<output::FieldData> fields(const Vector& X, const complementarity::ActiveSet& active,
                                        const std::vector<std::string>& names) const override {
    return on_mesh_->shown(X, active, names);
  }

  models::EvolutionState save(const Vector& X) const override {
    std::map<std::string, double> sums = {{"data_time", on_mesh_->time()},
                                          {"squared_energy_error", squared_error_},
                                          {"bounded", bounded_},
                                          {"last_length", before_last_.is_null() ? 0 : last_length_}};
    if (bounded_) sums.merge(bound_ ? bound_->sums() : std::map<std::string, double>(restored_bound_));
    auto blocks = on_mesh_->save(X);
    if (!before_last_.is_null())
      for (auto& block : on_mesh_->save(*before_last_, of_before)) blocks.push_back(std::move(block));
    for (const auto& [level, marked] : marked_) blocks.push_back(output::list_block(marks_of(level), marked, comm().root()));
    return {std::move(blocks), sums};
  }
  Teuchos::RCP<Vector> restore(const output::StoredCheckpoint& stored) override {
    replay(stored);
    auto X = on_mesh_->restore(stored);
    last_length_ = stored.number("last_length", 0);
    before_last_ = last_length_ > 0 ? on_mesh_->restore(stored, of_before) : Teuchos::null;
    on_mesh_->move_to(stored.number("data_time", 0));
    squared_error_ = stored.number("squared_energy_error", 0);
    begun_ = open_ = estimated_ = false;
    bounded_ = stored.count("bounded", 1) != 0;
    restored_bound_.clear();
    for (const std::string& name : bound::StepBound::names_of_sums())
      if (bounded_) restored_bound_[name] = stored.number(name);
    if (bound_ && bounded_) bound_->restore(restored_bound_);
    return X;
  }

  const mesh::Hierarchy* hierarchy() const override { return &hierarchy_; }

  /// During a step begun X is what it began with, else the X at its end. The functions in the cells are the same on the finer mesh, but for
  /// boundary values: those are the interpolant of the data there.
  Teuchos::RCP<Vector> refine(const std::vector<GlobalIndex>& marked, const Vector& X) override {
    const double t = open_ ? step_.begin : on_mesh_->time();
    on_mesh_->move_to(t);
    const Pair coarse_u = at(X);
    append(marked);
    const auto on_coarse = std::move(on_mesh_);
    const auto coarse_bound = std::move(bound_);
    go_to_finest();
    on_mesh_->move_to(t);
    restored_bound_.clear();
    const auto fine_X = on_mesh_->from_coarse(*on_coarse, X);
    bounded_ = bounded_ && coarse_bound;
    if (bounded_) {
      bound_ = make_bound(t);
      bound_->take_over(*coarse_bound, t, coarse_u.u, at(*fine_X).u);
    }
    return fine_X;
  }

 private:
  static constexpr const char* of_before = " before";
  static std::string marks_of(int level) { return fmt::format("marked for level {}", level); }

  const method::Space& space() const { return on_mesh_->space(); }

  /// A level of the hierarchy from the finest one and the ids of its cells to be refined.
  void append(const std::vector<GlobalIndex>& marked) {
    const core::Region region("mesh");
    const std::unordered_set<GlobalIndex> ids(marked.begin(), marked.end());
    const mesh::Mesh& coarse = hierarchy_.finest();
    std::vector<LocalIndex> cells;
    for (LocalIndex K = 0; K < coarse.owned_cells; ++K)
      if (ids.count(coarse.cell_id[K]) > 0) cells.push_back(K);
    mesh::adapt(hierarchy_, cells);
    marked_[static_cast<int>(hierarchy_.levels.size()) - 1] = marked;
  }

  /// Nothing of the mesh before is kept.
  void go_to_finest() {
    on_mesh_ = make_level();
    bound_.reset();
    X_before_ = before_last_ = Teuchos::null;
    weight_ = 0;
    begun_ = open_ = estimated_ = false;
  }

  /// The meshes that refinement had added when the checkpoint was written.
  void replay(const output::StoredCheckpoint& stored) {
    const auto have = hierarchy_.levels.size();
    for (int level = static_cast<int>(have); stored.size(marks_of(level)) >= 0; ++level) append(stored.fetch_list(marks_of(level)));
    if (hierarchy_.levels.size() > have) go_to_finest();
  }

  std::unique_ptr<MembraneLevel> make_level() const {
    const core::Region region("assembly");
    return std::make_unique<MembraneLevel>(scene_, origin_, make_space_, method_, linear_, hierarchy_.finest());
  }

  std::unique_ptr<bound::StepBound> make_bound(double time) const {
    const core::Region region("estimate set-up");
    auto contact = on_mesh_->contact_problem();
    contact.time = time;
    return std::make_unique<bound::StepBound>(on_mesh_->polynomials(), contact, hierarchy_, static_cast<int>(hierarchy_.levels.size()) - 1,
                                              friedrichs_);
  }

  /// With the boundary values of the time of the data.
  Pair at(const Vector& X) const {
    const Fields x = on_mesh_->fields(X);
    return {{on_mesh_->membrane(x, 0), on_mesh_->membrane(x, 1)}};
  }

  double squared_energy_error(const Pair& now, double t) const {
    double sum = 0;
    for (int alpha = 0; alpha < 2; ++alpha)
      sum += space().energy_error(*scene_.tension[alpha], now.u[alpha], exact_gradient(*scene_.exact, alpha, space().mesh()), t);
    return sum;
  }

  /// ∫ |||u - u_htau|||² over the step, u_htau affine in time: two Gauss points.
  double step_error(const Pair& end) const {
    double sum = 0;
    for (const double s : {gauss_point, 1 - gauss_point}) {
      Pair between;
      for (int alpha = 0; alpha < 2; ++alpha) between.u[alpha] = combination(1 - s, before_.u[alpha], s, end.u[alpha]);
      sum += squared_energy_error(between, step_.begin + s * step_.length());
    }
    return step_.length() * sum / 2;
  }

  double origin_;              ///< of heights: where the membranes are held at the beginning
  const MembraneScene scene_;  ///< with heights counted from there
  const method::SpaceFactory& make_space_;
  method::MethodParams method_;
  algebra::LinearParams linear_;
  mesh::Hierarchy hierarchy_;
  std::optional<double> friedrichs_;                ///< given in the deck
  std::vector<models::Probe> probes_;               ///< of series.csv
  std::map<int, std::vector<GlobalIndex>> marked_;  ///< cells whose refinement made this level
  std::unique_ptr<MembraneLevel> on_mesh_;
  double weight_ = 0;  ///< 1/tau in the matrices; 0: none yet
  models::TimeStep step_;
  bool begun_ = false;                      ///< step_ and before_ are those of the X at its end
  bool open_ = false;                       ///< … and it has not been accepted
  Pair before_;                             ///< u^{n-1}
  Pair seen_;                               ///< u of the last estimate
  Teuchos::RCP<const Vector> X_before_;     ///< X^{n-1} of the step begun
  Teuchos::RCP<const Vector> before_last_;  ///< at the begin of the last step accepted, whose length is last_length_; null: none
  double last_length_ = 0;
  double squared_error_ = 0;
  std::unique_ptr<bound::StepBound> bound_;       ///< made when an estimate is first asked for
  bool estimated_ = false;                        ///< in the step begun
  bool bounded_ = false;                          ///< every step so far was estimated
  std::map<std::string, double> restored_bound_;  ///< sums of a checkpoint
};

class ParabolicMembranes final : public models::UnsteadyModel {
 public:
  ParabolicMembranes(MembraneScene scene, method::SpaceFactory make_space, method::MethodParams method, algebra::LinearParams linear,
                     method::MeshCheck check_mesh, std::optional<double> friedrichs)
      : scene_(std::move(scene)),
        make_space_(std::move(make_space)),
        check_mesh_(std::move(check_mesh)),
        method_(method),
        linear_(linear),
        friedrichs_(friedrichs) {
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
    if (check_mesh_) check_mesh_(mesh, {boundary_of(scene_, mesh).dirichlet, scene_.interface_level_set, method_});
    return std::make_unique<ParabolicEvolution>(scene_, make_space_, method_, linear_, std::move(hierarchy), friedrichs_, wanted.probes);
  }

 private:
  MembraneScene scene_;
  method::SpaceFactory make_space_;
  method::MeshCheck check_mesh_;
  method::MethodParams method_;
  algebra::LinearParams linear_;
  std::optional<double> friedrichs_;
};

}  // namespace

std::unique_ptr<models::UnsteadyModel> parabolic_membranes(MembraneScene scene, method::SpaceFactory make_space,
                                                           method::MethodParams method, algebra::LinearParams linear,
                                                           method::MeshCheck check_mesh, std::optional<double> friedrichs) {
  return std::make_unique<ParabolicMembranes>(std::move(scene), std::move(make_space), method, linear, std::move(check_mesh), friedrichs);
}

}  // namespace thixis::membranes
