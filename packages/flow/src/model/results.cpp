#include <fmt/format.h>

#include <algorithm>

#include "model/evolution.hpp"
#include "step/extremes.hpp"

namespace thixis::flow {
namespace {

constexpr double trace_of_gas = 1e-8;  // s_g beyond which a cell counts as two-phase

}  // namespace

using algebra::Vector;

const std::vector<std::string>& names_of_fields() {
  static const std::vector<std::string> names = {"s_g", "p_l", "p_g", "chi", "phase", "phase_transition"};
  return names;
}

std::string TwoPhaseEvolution::bound_name() const {
  return bound_params_.measure == complementarity::Measure::residual ? "dual norm of the residuals about" : "estimate of the literature";
}

/// The right end of the gas: where the cells with gas end, or the left end of the domain if there is none.
double TwoPhaseEvolution::front(const Vector& X) const { return right_end_of_gas(flow_, X, trace_of_gas); }

std::vector<models::Expectation> TwoPhaseEvolution::expectations(const models::ExpectParams& expect, const Vector& X) const {
  const ExpectParams& own = expect.own.get<ExpectParams>();
  std::vector<models::Expectation> all;
  for (const models::Balance& balance : balances())
    if (const auto& most = balance.name == "water" ? own.water_balance_at_most : own.hydrogen_balance_at_most)
      all.push_back({"defect of the " + balance.name + " balance", balance.worst_step, {}, most});
  if (const auto& bounds = own.front_between) all.push_back({"front", front(X), bounds->at(0), bounds->at(1)});
  return all;
}

std::vector<output::SummaryEntry> TwoPhaseEvolution::summary(const Vector& X) const {
  output::SummaryEntry masses{"mass_balance", {}, {}};
  for (const models::Balance& balance : balances()) masses.parts.emplace_back(balance.name, balance.worst_step);
  for (const models::Balance& balance : balances()) masses.parts.emplace_back(balance.name + "_total", balance.total);
  return {masses, {"front", front(X), {}}};
}

std::vector<std::string> TwoPhaseEvolution::series_names() const {
  std::vector<std::string> names;
  for (int i = 0; i < probes_.count(); ++i)
    for (const char* name : {"s_g", "p_l", "p_g"}) names.push_back(i == 0 ? name : fmt::format("{}_{}", name, i + 1));
  return names;
}

std::vector<double> TwoPhaseEvolution::series(const Vector& X) const {
  std::vector<double> values;
  for (const auto& at : probes_(X)) {
    const PhaseState state = flow_.laws().state(at[gas_saturation], at[pressure], at[dissolved]);
    values.insert(values.end(), {state.s_g, state.P, state.P_g.value});
  }
  return values;
}

std::vector<double> TwoPhaseEvolution::values_at(const std::vector<models::Probe>& probes, const Vector& X) const {
  std::vector<double> values;
  if (probes.empty()) return values;
  for (const auto& at : TwoPhaseProbes(flow_.grid(), probes)(X)) {
    const PhaseState state = flow_.laws().state(at[gas_saturation], at[pressure], at[dissolved]);
    values.insert(values.end(), {state.s_g, state.P, state.P_g.value, state.chi});
  }
  return values;
}

output::Grid TwoPhaseEvolution::grid() const { return fv::display(flow_.grid()); }

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

}  // namespace thixis::flow
