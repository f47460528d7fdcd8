#include "two_phase_balance.hpp"

#include <algorithm>
#include <cmath>

#include "thixis/fv/host.hpp"

namespace thixis::models {
namespace {

const std::array<const char*, components> names = {"water", "hydrogen"};

}  // namespace

void TwoPhaseBalance::add(const FlowStep& step, const algebra::Vector& X) {
  const fv::Grid& grid = flow_.grid();
  const TwoPhaseLaws& laws = flow_.laws();
  const auto host = [](const auto& view) { return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view); };
  const auto states = flow_.states(X);
  const auto at = host(states);
  const auto fluxes = host(flow_.fluxes(states, step));
  const auto before = host(step.before), source = host(step.source);
  const auto of_grid = fv::on_host(grid);

  // sums over this rank: change, source, inflow, outflow, in place, of water, then of hydrogen
  enum { change, sources, inflow, outflow, in_place, sums };
  std::vector<double> sum(components * sums, 0);
  for (LocalIndex K = 0; K < grid.owned_cells; ++K) {
    const double volume = of_grid.volume(K);
    const Masses l = laws.masses(at(K));
    for (int c = 0; c < components; ++c) {
      double* of = &sum[c * sums];
      of[change] += volume * (l.value[c] - before(K, c));
      of[sources] += volume * source(K, c) * step.length;
      of[in_place] += volume * (l.value[c] + (c == water ? laws.porosity * laws.rho_w : 0));
      of[inflow] += volume * std::max(source(K, c), 0.0) * step.length;
    }
  }
  for (LocalIndex F = 0; F < grid.faces; ++F) {
    if (of_grid.face_cells(F, 1) >= 0) continue;
    for (int c = 0; c < components; ++c) {
      const double out = of_grid.face_area(F) * fluxes(F).value[c] * step.length;
      sum[c * sums + outflow] += out;
      sum[c * sums + inflow] += std::max(-out, 0.0);
    }
  }
  grid.comm.sum(sum);
  for (int c = 0; c < components; ++c) {
    const double* of = &sum[c * sums];
    Account& account = accounts_[c];
    account.defect = of[change] - of[sources] + of[outflow];
    account.total += account.defect;
    account.brought += of[inflow];
    account.in_place = of[in_place];
    account.worst = std::max(account.worst, std::abs(account.defect) / reference(c));
  }
}

double TwoPhaseBalance::reference(int component) const {
  const Account& account = accounts_[component];
  const double wanted = component == hydrogen && account.brought > 0 ? account.brought : account.in_place;
  return wanted > 0 ? wanted : 1;
}

std::vector<Balance> TwoPhaseBalance::balances() const {
  std::vector<Balance> all;
  for (int c = 0; c < components; ++c) {
    const Account& account = accounts_[c];
    all.push_back({names[c], std::abs(account.defect) / reference(c), account.worst, std::abs(account.total) / reference(c)});
  }
  return all;
}

std::map<std::string, double> TwoPhaseBalance::save() const {
  std::map<std::string, double> saved;
  for (int c = 0; c < components; ++c) {
    const Account& account = accounts_[c];
    const std::string name = names[c];
    saved[name + "_defect"] = account.defect;
    saved[name + "_worst"] = account.worst;
    saved[name + "_total"] = account.total;
    saved[name + "_brought"] = account.brought;
    saved[name + "_in_place"] = account.in_place;
  }
  return saved;
}

void TwoPhaseBalance::restore(const output::StoredCheckpoint& stored) {
  for (int c = 0; c < components; ++c) {
    const auto read = [&](const char* what) { return stored.number(std::string(names[c]) + "_" + what); };
    accounts_[c] = {read("defect"), read("worst"), read("total"), read("brought"), read("in_place")};
  }
}

}  // namespace thixis::models
