#include "thixis/flow/two_phase.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "thixis/core/error.hpp"
#include "thixis/core/text.hpp"
#include "thixis/core/timer.hpp"
#include "thixis/fv/host.hpp"
#include "two_phase_balance.hpp"
#include "two_phase_bound.hpp"
#include "two_phase_predictor.hpp"
#include "two_phase_probes.hpp"
#include "two_phase_problem.hpp"
#include "two_phase_verifier.hpp"

namespace thixis::flow {
namespace {

using algebra::Vector;

constexpr double trace_of_gas = 1e-8;  // s_g beyond which a cell counts as two-phase
constexpr double unsettled = 1e-2;     // by which iterates of the rule adaptive may leave the range of a state, in its units

const std::vector<std::string>& names_of_unknowns() {
  static const std::vector<std::string> names = {"s_g", "P", "chi"};
  return names;
}
const std::vector<std::string>& names_of_fields() {
  static const std::vector<std::string> names = {"s_g", "p_l", "p_g", "chi", "phase", "phase_transition"};
  return names;
}

/// Size of the pressures that matter: the largest one at the beginning. Collective.
double reference_pressure(const TwoPhaseOperator& flow, const Vector& X0) {
  const auto x = algebra::host_view(X0);
  double largest = 0;
  for (LocalIndex K = 0; K < flow.grid().owned_cells; ++K) largest = std::max(largest, std::abs(x(unknowns_per_cell * K + pressure)));
  largest = flow.grid().comm.max(largest);
  return largest > 0 ? largest : flow.laws().P_r;
}

/// The estimate over all steps: roots of sums of squares, as long as every step has one.
class BoundSoFar {
 public:
  void add(const std::optional<complementarity::Estimate>& of_step) {
    every_step_ = every_step_ && of_step.has_value();
    if (!every_step_) return;
    const double parts[] = {of_step->total, of_step->discretization, of_step->linearization, of_step->algebraic, of_step->time.value_or(0)};
    for (std::size_t i = 0; i < squares_.size(); ++i) squares_[i] += parts[i] * parts[i];
    any_step_ = true;
  }
  std::optional<complementarity::Estimate> value() const {
    if (!every_step_ || !any_step_) return std::nullopt;
    complementarity::Estimate eta{std::sqrt(squares_[0]), std::sqrt(squares_[1]), std::sqrt(squares_[2]), std::sqrt(squares_[3]), 0, 0};
    eta.time = std::sqrt(squares_[4]);
    return eta;
  }
  bool every_step() const { return every_step_; }
  void save(std::map<std::string, double>& attributes) const {
    attributes["bound_every_step"] = every_step_;
    attributes["bound_any_step"] = any_step_;
    for (std::size_t i = 0; i < squares_.size(); ++i) attributes[names[i]] = squares_[i];
  }
  void restore(const output::StoredCheckpoint& stored) {
    every_step_ = stored.count("bound_every_step", 1) != 0;
    any_step_ = stored.count("bound_any_step", 1) != 0;
    for (std::size_t i = 0; i < squares_.size(); ++i) squares_[i] = stored.number(names[i], 0);
  }

 private:
  static constexpr const char* names[] = {"bound_total", "bound_discretization", "bound_linearization", "bound_algebraic", "bound_time"};
  std::array<double, 5> squares_ = {0, 0, 0, 0, 0};
  bool every_step_ = true, any_step_ = false;
};

class TwoPhaseEvolution final : public models::Evolution {
 public:
  TwoPhaseEvolution(fv::Grid grid, const TwoPhaseScene& scene, const algebra::LinearParams& linear, double seconds_per_unit,
                    const std::vector<models::Probe>& probes, const TwoPhaseBoundParams& bound)
      : bound_params_(bound),
        flow_(std::move(grid), scene, seconds_per_unit),
        initial_(flow_.initial()),
        problem_(flow_, FlowScales(flow_.laws(), reference_pressure(flow_, *initial_)), linear, initial_),
        verifier_(flow_.grid(), scene, seconds_per_unit, problem_.scales().pressure),
        probes_(flow_.grid(), probes),
        owed_("thixis::flow::owed", flow_.grid().owned_cells),
        jumps_(scene.jumps),
        closed_(is_closed(scene)) {
    require_definite_pressure();
  }

  const core::Comm& comm() const override { return flow_.grid().comm; }
  GlobalIndex cells() const override { return flow_.grid().global_cells; }
  models::Sizes sizes() const override {
    const GlobalIndex unknowns = unknowns_per_cell * cells();
    return {unknowns, unknowns, problem_.nonzeros()};
  }

  std::vector<double> jumps() const override { return jumps_; }
  Teuchos::RCP<Vector> initial() override { return Teuchos::rcp(new Vector(*initial_, Teuchos::Copy)); }
  /// The first time alone: where a later one is wrong, what was computed before it is kept.
  void check(const std::vector<double>& times) const override {
    if (!times.empty()) flow_.check(times.front());
  }
  void begin(const models::TimeStep& step, const Vector& before) override {
    const core::Region region("assembly");
    FlowStep flow_step = flow_.step(step.begin, step.end, before);
    Kokkos::deep_copy(flow_step.owed, owed_);
    problem_.begin(std::move(flow_step));
    step_ = step;
    found_.reset();
    before_ = Teuchos::rcp(new Vector(before, Teuchos::Copy));
    of_step_.reset();
    bound_begun_ = false;
  }
  complementarity::Problem& problem() override { return problem_; }
  double round_off() const override { return problem_.round_off(); }
  void give_up() override { of_step_.reset(); }
  bool predict(Vector& X) override {
    if (before_last_.is_null()) return start(X);
    Tpetra::deep_copy(X, *predicted(flow_, *before_, *before_last_, problem_.step().length / last_length_));
    return true;
  }

  complementarity::Estimate estimate(const Vector& X) override {
    if (!bound_) bound_ = std::make_unique<TwoPhaseBound>(flow_, problem_.scales(), bound_params_);
    if (!bound_begun_) bound_->begin(problem_.step(), *before_);
    bound_begun_ = true;
    of_step_ = (*bound_)(X, problem_.linearization());
    of_step_->time = bound_->step_errors().time;
    return *of_step_;
  }
  models::CellEstimates cell_estimates() const override {
    if (!bound_) return {};
    const auto copy = [](const fv::View<double*>& values) {
      const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), values);
      return std::vector<double>(host.data(), host.data() + host.extent(0));
    };
    const TwoPhaseBound::Cells& cells = bound_->cells();
    return {copy(cells.discretization), copy(cells.linearization), copy(cells.algebraic)};
  }
  std::optional<models::StepErrors> step_errors() const override {
    if (!of_step_) return std::nullopt;
    return bound_->step_errors();
  }

  models::Objection objection(const Vector& X, double tolerance, bool conditions) override {
    found_ = verified(X);
    std::string why = found_->objection(conditions ? tolerance : std::max(tolerance, unsettled), false);
    if (!why.empty() || !conditions) return {why};
    why = found_->objection(tolerance, true);
    if (why.empty()) why = balance_.objection(*found_, tolerance);
    return {why, !why.empty() && !found_->diverged()};
  }
  void accept(const Vector& X) override {
    balance_.add(found_ ? *found_ : verified(X));
    if (!bound_params_.adaptive) Kokkos::deep_copy(owed_, problem_.left(X));
    bound_so_far_.add(of_step_);
    before_last_ = before_last_.is_null() && closed_ ? in_equilibrium(flow_, *before_).getConst() : before_;  // no jump is extrapolated
    last_length_ = problem_.step().length;
  }
  std::optional<complementarity::Estimate> estimate_so_far() const override { return bound_so_far_.value(); }
  bool every_step_estimated() const override { return bound_so_far_.every_step(); }
  std::string bound_name() const override {
    return bound_params_.measure == complementarity::Measure::residual ? "dual norm of the residuals about" : "estimate of the literature";
  }
  std::vector<models::Balance> balances() const override { return balance_.balances(); }

  complementarity::KktData kkt_data(const Vector& X) const override;

  /// The right end of the gas: where the cells with gas end, or the left end of the domain if there is none.
  double front(const Vector& X) const {
    const auto grid = fv::on_host(flow_.grid());
    const auto x = algebra::host_view(X);
    double left = std::numeric_limits<double>::infinity(), right = -left;
    for (LocalIndex K = 0; K < flow_.grid().owned_cells; ++K)
      for (int i = 0; i < flow_.grid().corners(); ++i) {
        const double at = grid.vertex(grid.cell_vertices(K, i), 0);
        left = std::min(left, at);
        if (x(unknowns_per_cell * K + gas_saturation) > trace_of_gas) right = std::max(right, at);
      }
    left = comm().min(left);
    return std::max(left, comm().max(right));
  }

  std::vector<models::Expectation> expectations(const models::ExpectParams& expect, const Vector& X) const override {
    const ExpectParams& own = expect.own.get<ExpectParams>();
    std::vector<models::Expectation> all;
    for (const models::Balance& balance : balances())
      if (const auto& most = balance.name == "water" ? own.water_balance_at_most : own.hydrogen_balance_at_most)
        all.push_back({"defect of the " + balance.name + " balance", balance.worst_step, {}, most});
    if (const auto& bounds = own.front_between) all.push_back({"front", front(X), bounds->at(0), bounds->at(1)});
    return all;
  }
  std::vector<output::SummaryEntry> summary(const Vector& X) const override {
    output::SummaryEntry masses{"mass_balance", {}, {}};
    for (const models::Balance& balance : balances()) masses.parts.emplace_back(balance.name, balance.worst_step);
    for (const models::Balance& balance : balances()) masses.parts.emplace_back(balance.name + "_total", balance.total);
    return {masses, {"front", front(X), {}}};
  }

  std::vector<std::string> series_names() const override {
    std::vector<std::string> names;
    for (int i = 0; i < probes_.count(); ++i)
      for (const char* name : {"s_g", "p_l", "p_g"}) names.push_back(i == 0 ? name : fmt::format("{}_{}", name, i + 1));
    return names;
  }
  std::vector<double> series(const Vector& X) const override {
    std::vector<double> values;
    for (const auto& at : probes_(X)) {
      const PhaseState state = flow_.laws().state(at[gas_saturation], at[pressure], at[dissolved]);
      values.insert(values.end(), {state.s_g, state.P, state.P_g.value});
    }
    return values;
  }

  std::vector<double> values_at(const std::vector<models::Probe>& probes, const Vector& X) const override {
    std::vector<double> values;
    if (probes.empty()) return values;
    for (const auto& at : TwoPhaseProbes(flow_.grid(), probes)(X)) {
      const PhaseState state = flow_.laws().state(at[gas_saturation], at[pressure], at[dissolved]);
      values.insert(values.end(), {state.s_g, state.P, state.P_g.value, state.chi});
    }
    return values;
  }

  output::Grid grid() const override { return fv::display(flow_.grid()); }
  std::vector<output::FieldData> fields(const Vector& X, const complementarity::ActiveSet& active,
                                        const std::vector<std::string>& names) const override;

  models::State save(const Vector& X) const override {
    models::State state{{}, balance_.save()};
    bound_so_far_.save(state.attributes);
    state.attributes["last_length"] = last_length_;
    add_blocks("", X, state.blocks);
    if (!before_last_.is_null()) add_blocks(of_before, *before_last_, state.blocks);
    add_owed(state.blocks);
    return state;
  }

  Teuchos::RCP<Vector> restore(const output::StoredCheckpoint& stored) override {
    for (const std::string& name : names_of_unknowns())
      if (stored.size(name) != cells())
        throw core::InputError(fmt::format(
            "The checkpoint '{}' belongs to another model or mesh: it holds {}, the deck asks for {} cells; "
            "leave scene and mesh as they were.",
            stored.path(), stored.size(name) < 0 ? fmt::format("no '{}'", name) : fmt::format("{} values of '{}'", stored.size(name), name),
            cells()));
    balance_.restore(stored);
    bound_so_far_.restore(stored);
    last_length_ = stored.number("last_length", 0);
    if (last_length_ > 0) before_last_ = fetched(of_before, stored);
    fetch_owed(stored);
    return fetched("", stored);
  }

 private:
  static constexpr const char* of_before = " before";
  static constexpr const char* names_of_owed[components] = {"owed water", "owed hydrogen"};

  static bool is_closed(const TwoPhaseScene& scene) {
    return std::none_of(scene.boundary.begin(), scene.boundary.end(),
                        [](const auto& part) { return part.second.kind == FlowBoundaryKind::state; });
  }

  /// The first step. Gas beside water that could dissolve it would leave at once for Newton's method, which takes the smaller of s_g and G
  /// for zero; without gas the pressure in a closed domain has no level, and the system is singular.
  bool start(Vector& X) const {
    if (!closed_) return false;
    Tpetra::deep_copy(X, *in_equilibrium(flow_, *before_));
    return true;
  }

  /// Without gas and without a part of the boundary where it is given, the pressure of incompressible water has no level. Collective.
  void require_definite_pressure() const {
    if (!closed_) return;
    double most = 0;
    {
      const auto x = algebra::host_view(std::as_const(*initial_));
      for (LocalIndex K = 0; K < flow_.grid().owned_cells; ++K) most = std::max(most, x(unknowns_per_cell * K + gas_saturation));
    }
    if (comm().max(most) > 0) return;
    throw core::InputError(
        "scene/flow/boundary: no part has kind = state and there is no gas in the beginning, so nothing says what the pressure is; write "
        "kind = state somewhere, or initial/s_g above 0 in some place.");
  }

  void add_blocks(const std::string& suffix, const Vector& X, std::vector<output::CheckpointBlock>& blocks) const {
    const auto x = algebra::host_view(X);
    for (int u = 0; u < unknowns_per_cell; ++u) {
      output::CheckpointBlock block{names_of_unknowns()[u] + suffix, owned_ids(), {}};
      for (LocalIndex K = 0; K < flow_.grid().owned_cells; ++K) block.values.push_back(x(unknowns_per_cell * K + u));
      blocks.push_back(std::move(block));
    }
  }
  Teuchos::RCP<Vector> fetched(const std::string& suffix, const output::StoredCheckpoint& stored) const {
    const auto X = Teuchos::rcp(new Vector(flow_.map()));
    const auto x = algebra::host_overwrite(*X);
    for (int u = 0; u < unknowns_per_cell; ++u) {
      const auto values = stored.fetch_finite(names_of_unknowns()[u] + suffix, owned_ids());
      for (LocalIndex K = 0; K < flow_.grid().owned_cells; ++K) x(unknowns_per_cell * K + u) = values[K];
    }
    return X;
  }

  void add_owed(std::vector<output::CheckpointBlock>& blocks) const {
    const auto owed = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), owed_);
    for (int c = 0; c < components; ++c) {
      output::CheckpointBlock block{names_of_owed[c], owned_ids(), {}};
      for (LocalIndex K = 0; K < flow_.grid().owned_cells; ++K) block.values.push_back(owed(K, c));
      blocks.push_back(std::move(block));
    }
  }
  void fetch_owed(const output::StoredCheckpoint& stored) const {
    const auto owed = Kokkos::create_mirror_view(owed_);
    for (int c = 0; c < components; ++c) {
      if (stored.size(names_of_owed[c]) != cells()) return;
      const auto values = stored.fetch(names_of_owed[c], owned_ids());
      for (LocalIndex K = 0; K < flow_.grid().owned_cells; ++K) owed(K, c) = values[K];
    }
    Kokkos::deep_copy(owed_, owed);
  }

  /// What the verifier finds at the end of the step begun. Collective.
  FlowFindings verified(const Vector& X) const {
    const auto owed = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), problem_.step().owed);
    std::vector<TwoPhaseVerifier::Owed> debts(owed.extent(0));
    for (std::size_t K = 0; K < debts.size(); ++K) debts[K] = {owed(K, water), owed(K, hydrogen)};
    return verifier_(step_.begin, step_.end, of_cells(before_.is_null() ? X : *before_), of_cells(X), debts);
  }
  std::vector<TwoPhaseVerifier::State> of_cells(const Vector& X) const {
    const Vector all = flow_.with_ghosts(X);
    const auto x = algebra::host_view(all);
    std::vector<TwoPhaseVerifier::State> states(flow_.grid().cells);
    for (LocalIndex K = 0; K < flow_.grid().cells; ++K)
      for (int u = 0; u < unknowns_per_cell; ++u) states[K][u] = x(unknowns_per_cell * K + u);
    return states;
  }

  std::vector<GlobalIndex> owned_ids() const {
    const auto& ids = flow_.grid().cell_id;
    return {ids.begin(), ids.begin() + flow_.grid().owned_cells};
  }

  TwoPhaseBoundParams bound_params_;
  TwoPhaseOperator flow_;
  Teuchos::RCP<Vector> initial_;
  TwoPhaseProblem problem_;
  TwoPhaseVerifier verifier_;
  TwoPhaseBalance balance_;
  TwoPhaseProbes probes_;
  fv::View<double* [components]> owed_;  ///< what the last step accepted has left of the balances of the owned cells [kg/m^3]
  models::TimeStep step_;                ///< the one begun
  std::optional<FlowFindings> found_;    ///< at the X of the step begun that was judged last
  std::vector<double> jumps_;
  bool closed_;                             ///< no part of the boundary says what the pressure is
  Teuchos::RCP<const Vector> before_;       ///< X^{n-1} of the step begun
  Teuchos::RCP<const Vector> before_last_;  ///< at the beginning of the last step accepted, whose length is last_length_ [s]; null: none
  double last_length_ = 0;
  std::unique_ptr<TwoPhaseBound> bound_;
  bool bound_begun_ = false;                          ///< it knows of the step begun
  std::optional<complementarity::Estimate> of_step_;  ///< its last estimate in this step
  BoundSoFar bound_so_far_;
};

/// The multiplier is G/(H P_ref), the gap s_g; both are of size 1 where they matter, but for saturations of a small gas zone. What the
/// multiplier is compared with, and the balances, are the verifier's.
complementarity::KktData TwoPhaseEvolution::kkt_data(const Vector& X) const {
  const auto gap = Teuchos::rcp(new Vector(flow_.cells())), claimed = Teuchos::rcp(new Vector(flow_.cells())),
             recomputed = Teuchos::rcp(new Vector(flow_.cells()));
  problem_.arguments(X, *gap, *claimed);
  claimed->scale(1 / (flow_.laws().H * problem_.scales().pressure));
  const FlowFindings found = verified(X);
  {
    const auto out = algebra::host_overwrite(*recomputed);
    std::copy(found.undersaturation.begin(), found.undersaturation.end(), out.data());
  }
  complementarity::KktData data;
  data.gap = gap;
  data.claimed = claimed;
  data.equilibrium = {recomputed};
  data.unbalanced = std::max(found.unbalanced[water].violation, found.unbalanced[hydrogen].violation);
  data.gap_scale = std::max(gap->normInf(), 1e-2);
  return data;
}

std::vector<output::FieldData> TwoPhaseEvolution::fields(const Vector& X, const complementarity::ActiveSet&,
                                                         const std::vector<std::string>& names) const {
  const auto states = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), flow_.states(X));
  std::vector<output::FieldData> shown;
  const auto add = [&](const std::string& name, auto value) {
    if (!names.empty() && std::find(names.begin(), names.end(), name) == names.end()) return;
    output::FieldData field{name, output::Centre::cell, {}};
    for (LocalIndex K = 0; K < flow_.grid().owned_cells; ++K) field.values.push_back(value(states(K)));
    shown.push_back(std::move(field));
  };
  add("s_g", [](const PhaseState& U) { return U.s_g; });
  add("p_l", [](const PhaseState& U) { return U.P; });
  add("p_g", [](const PhaseState& U) { return U.P_g.value; });
  add("chi", [](const PhaseState& U) { return U.chi; });
  if (of_step_ && (names.empty() || std::find(names.begin(), names.end(), "phase_transition") != names.end())) {
    const auto values = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), bound_->cells().phase_transition);
    shown.push_back({"phase_transition", output::Centre::cell, {values.data(), values.data() + values.extent(0)}});
  }
  add("phase", [](const PhaseState& U) { return U.s_g > trace_of_gas ? 1.0 : 0.0; });
  return shown;
}

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
