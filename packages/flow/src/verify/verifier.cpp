#include "verify/verifier.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thixis::flow {
namespace {

using Real = long double;  // 1 - S_e is small where gas appears

constexpr int water = 0, hydrogen = 1;
constexpr double infinite = std::numeric_limits<double>::infinity(), epsilon = std::numeric_limits<double>::epsilon();
constexpr double rounding = 64;    // units in the last place of the terms of a balance that are nobody's fault
constexpr double resolved = 1e10;  // units in the last place that must be moved to be the measure of what is missed

/// Values of functions of the scene at places (x, y) of one kind; zero where there is no function.
std::vector<double> at(const scene::FieldPtr& field, const std::vector<std::array<double, 2>>& places, double t) {
  std::vector<double> x, y, values(places.size(), 0);
  for (const auto& place : places) {
    x.push_back(place[0]);
    y.push_back(place[1]);
  }
  if (field && !places.empty()) field->evaluate({places.size(), x.data(), y.data()}, t, values.data());
  return values;
}

void see(FlowFindings::Worst& worst, double violation, GlobalIndex cell) {
  if (!(violation <= infinite)) violation = infinite;
  if (violation > worst.violation) worst = {violation, cell, {0, 0}};
}

}  // namespace

/// A state with its laws.
struct TwoPhaseVerifier::Cell {
  double s_g, P, chi, P_g, k_rl, k_rg;
};

/// Masses that cross a face [kg/(m^2 s)], and the terms whose differences they are.
struct TwoPhaseVerifier::Crossing {
  double mass[2] = {0, 0}, terms[2] = {0, 0};
  bool given = false;  ///< by the deck, whatever the state
};

/// What the scene says of faces on the boundary: states behind them, masses that enter; by face, -1: nothing.
struct TwoPhaseVerifier::Boundary {
  std::vector<int> of_face;
  std::vector<FlowBoundaryKind> kind;
  std::vector<State> outside;
  std::vector<std::array<double, 2>> entering;  ///< [kg/(m^2 s)]
};

TwoPhaseVerifier::TwoPhaseVerifier(const fv::Grid& grid, TwoPhaseScene scene, double seconds_per_unit, double P_ref)
    : grid_(grid), on_host_(fv::on_host(grid)), scene_(std::move(scene)), seconds_per_unit_(seconds_per_unit), P_ref_(P_ref) {
  const auto& rock = scene_.medium;
  H_ = rock.henry * rock.molar_mass_hydrogen;
  beta_l_ = rock.density_water * rock.molar_mass_hydrogen / rock.molar_mass_water;
  beta_g_ = rock.molar_mass_hydrogen / (8.314 * rock.temperature);
  const double span = 1 - rock.S_lr - rock.S_gr;
  P_at_line_ = capillary(rock.S_gr + rock.regularization * span);
  S_e_line_ = 1 - rock.regularization;
  if (scene_.capillary_law != CapillaryLaw::quadratic) return;
  // value and slope of van Genuchten's law at s_g = 0.1
  const double s = 0.1, m = 1 - 1 / rock.n, S_e = 1 - (s - rock.S_gr) / span, P = capillary(s);
  const double slope = P / rock.n / (std::pow(S_e, -1 / m) - 1) * std::pow(S_e, -1 / m - 1) / m / span;
  a_ = 2 * P / s - slope;
  b_ = (slope - P / s) / s;
  meets_at_ = s;
}

/// P_cp(s_g)                                                                                                            (2)
double TwoPhaseVerifier::capillary(double s_g) const {
  const auto& rock = scene_.medium;
  if (s_g < meets_at_) return s_g < 0 ? a_ * s_g : a_ * s_g + b_ * s_g * s_g;
  const Real span = Real(1) - rock.S_lr - rock.S_gr, gas = (Real(s_g) - rock.S_gr) / span, m = 1 - Real(1) / rock.n;
  if (1 - gas > S_e_line_) return static_cast<double>(P_at_line_ * s_g / (rock.S_gr + rock.regularization * span));
  return static_cast<double>(rock.P_r * std::pow(std::pow(1 - std::min(gas, Real(0.99)), -1 / m) - 1, 1 / Real(rock.n)));
}

TwoPhaseVerifier::Cell TwoPhaseVerifier::cell(const State& U) const {
  const auto& rock = scene_.medium;
  Cell of{U[0], U[1], U[2], U[1] + capillary(U[0]), 1, 0};
  const Real gas = (Real(U[0]) - rock.S_gr) / (Real(1) - rock.S_lr - rock.S_gr);
  if (gas <= 0) return of;
  const Real m = 1 - Real(1) / rock.n;
  const auto liquid = [&](Real S_e) { return std::sqrt(S_e) * std::pow(1 - std::pow(1 - std::pow(S_e, 1 / m), m), Real(2)); };
  const Real S_e = 1 - std::min(gas, Real(0.99)), line = 1 - Real(rock.regularization);
  of.k_rl = static_cast<double>(S_e > line ? 1 - (1 - liquid(line)) * gas / rock.regularization : liquid(S_e));
  of.k_rg = static_cast<double>(std::sqrt(1 - S_e) * std::pow(1 - std::pow(S_e, 1 / m), 2 * m));
  return of;
}

/// From A to B; `down`: gravity in that direction                                                                        (3)
TwoPhaseVerifier::Crossing TwoPhaseVerifier::crossing(const Cell& A, const Cell& B, double distance, double down) const {
  const auto& rock = scene_.medium;
  const double liquid_falls = A.P - B.P + rock.density_water * down * distance;
  const double gas_falls = A.P_g - B.P_g + 0.5 * beta_g_ * (A.P_g + B.P_g) * down * distance;
  const Cell &liquid = liquid_falls >= 0 ? A : B, &gas = gas_falls >= 0 ? A : B;
  const double through_liquid = rock.permeability * liquid.k_rl / rock.viscosity_water / distance;
  const double through_gas = rock.permeability * gas.k_rg / rock.viscosity_hydrogen / distance * beta_g_ * gas.P_g;
  const double diffusing = rock.porosity * beta_l_ * rock.diffusion * (1 - A.s_g + 1 - B.s_g) / 2 / distance;
  const double J = diffusing * (A.chi - B.chi);
  Crossing of;
  of.mass[water] = rock.density_water * through_liquid * liquid_falls - J;
  of.mass[hydrogen] = beta_l_ * liquid.chi * through_liquid * liquid_falls + through_gas * gas_falls + J;
  const double P = std::max(std::abs(A.P), std::abs(B.P)), P_g = std::max(std::abs(A.P_g), std::abs(B.P_g));
  const double diffuses = std::abs(diffusing) * std::max(std::abs(A.chi), std::abs(B.chi));
  of.terms[water] = rock.density_water * through_liquid * P + diffuses;
  of.terms[hydrogen] = beta_l_ * std::abs(liquid.chi) * through_liquid * P + std::abs(through_gas) * P_g + diffuses;
  return of;
}

/// Rates at the middle of the step, states at its end.
TwoPhaseVerifier::Boundary TwoPhaseVerifier::boundary(double begin, double end) const {
  Boundary found;
  found.of_face.assign(grid_.faces, -1);
  for (const auto& [tag, part] : scene_.boundary) {
    if (part.kind == FlowBoundaryKind::no_flow) continue;
    std::vector<std::array<double, 2>> places;
    const int first = static_cast<int>(found.kind.size());
    for (LocalIndex F = 0; F < grid_.faces; ++F) {
      if (on_host_.face_tag(F) < 0 || grid_.tags[on_host_.face_tag(F)] != tag) continue;
      found.of_face[F] = first + static_cast<int>(places.size());
      places.push_back({on_host_.face_centre(F, 0), on_host_.face_centre(F, 1)});
    }
    const bool held = part.kind == FlowBoundaryKind::state;
    const auto s_g = at(held ? part.state.s_g : nullptr, places, end), P = at(held ? part.state.P : nullptr, places, end),
               chi = at(held ? part.state.chi : nullptr, places, end);
    const double middle = (begin + end) / 2;
    const auto w = at(held ? nullptr : part.water, places, middle), h = at(held ? nullptr : part.hydrogen, places, middle);
    for (std::size_t i = 0; i < places.size(); ++i) {
      found.kind.push_back(part.kind);
      found.outside.push_back({s_g[i], P[i], chi[i]});
      found.entering.push_back({w[i] / seconds_per_unit_, h[i] / seconds_per_unit_});
    }
  }
  return found;
}

std::vector<TwoPhaseVerifier::Crossing> TwoPhaseVerifier::crossings(const std::vector<Cell>& cells, const Boundary& boundary) const {
  std::vector<Crossing> across(grid_.faces);
  for (LocalIndex F = 0; F < grid_.faces; ++F) {
    const Cell& A = cells[on_host_.face_cells(F, 0)];
    const double d = on_host_.face_distance(F);
    const double down = scene_.gravity[0] * on_host_.face_normal(F, 0) + scene_.gravity[1] * on_host_.face_normal(F, 1);
    if (const LocalIndex B = on_host_.face_cells(F, 1); B >= 0) {
      across[F] = crossing(A, cells[B], d, down);
    } else if (const int i = boundary.of_face[F]; i >= 0) {
      if (boundary.kind[i] == FlowBoundaryKind::state) across[F] = crossing(A, cell(boundary.outside[i]), d, down);
      else across[F] = {{-boundary.entering[i][water], -boundary.entering[i][hydrogen]}, {0, 0}, true};
    }
  }
  return across;
}

/// Water and hydrogen that are made in the owned cells [kg/(m^3 s)].
std::array<std::vector<double>, 2> TwoPhaseVerifier::sources(double middle) const {
  std::array<std::vector<double>, 2> made = {std::vector<double>(grid_.owned_cells, 0), std::vector<double>(grid_.owned_cells, 0)};
  if (!scene_.water_source && !scene_.hydrogen_source) return made;
  std::vector<std::array<double, 2>> places;
  for (LocalIndex K = 0; K < grid_.owned_cells; ++K) places.push_back({on_host_.centre(K, 0), on_host_.centre(K, 1)});
  made = {at(scene_.water_source, places, middle), at(scene_.hydrogen_source, places, middle)};
  for (auto& of : made)
    for (double& rate : of) rate /= seconds_per_unit_;
  return made;
}

void TwoPhaseVerifier::judge_states(const std::vector<State>& after, const std::vector<Cell>& cells, FlowFindings& found) const {
  const auto& rock = scene_.medium;
  const double driest = rock.S_gr + 0.99 * (1 - rock.S_lr - rock.S_gr), content = H_ * P_ref_;
  double most_gas = 1e-2;
  for (LocalIndex K = 0; K < grid_.owned_cells; ++K) most_gas = std::max(most_gas, std::abs(cells[K].s_g));
  most_gas = grid_.comm.max(most_gas);
  for (LocalIndex K = 0; K < grid_.owned_cells; ++K) {
    const Cell& U = cells[K];
    const GlobalIndex id = grid_.cell_id[K];
    const double G = (H_ * U.P_g - beta_l_ * U.chi) / content, gas = U.s_g / most_gas;
    found.undersaturation.push_back(G);
    for (const double value : after[K])
      if (!std::isfinite(value)) see(found.not_finite, infinite, id);
    see(found.negative_gas, -gas, id);
    see(found.supersaturated, -G, id);
    see(found.both_open, std::min(std::abs(gas), std::abs(G)), id);
    see(found.negative_dissolved, -U.chi * beta_l_ / content, id);
    see(found.negative_pressure, -U.P_g / P_ref_, id);
    see(found.all_dissolved, U.chi - 1, id);
    see(found.dry, U.s_g - driest, id);
  }
}

/// l_c(after) - l_c(before) + owed + tau (sum_F ± |F| Phi_c / |K| - Q_c), in every cell and over all of them                (1)
void TwoPhaseVerifier::judge_balances(double tau, const std::vector<State>& before, const std::vector<Cell>& cells,
                                      const std::vector<Crossing>& across, const std::array<std::vector<double>, 2>& sources,
                                      const std::vector<Owed>& owed, FlowFindings& found) const {
  const auto& rock = scene_.medium;
  const double filled[] = {rock.porosity * rock.density_water, rock.porosity * H_ * P_ref_};
  // water is counted from full pores: no digits are lost
  const auto mass = [&](const Cell& U, int c) {
    return rock.porosity * (c == water ? -rock.density_water * U.s_g : beta_l_ * U.chi * (1 - U.s_g) + beta_g_ * U.P_g * U.s_g);
  };
  std::vector<std::array<double, 2>> defects(grid_.owned_cells), nobodys(grid_.owned_cells);
  std::vector<double> most(4, 0);  // what is moved, and rounding, in the worst cell
  std::vector<double> sums(8, 0);
  for (LocalIndex K = 0; K < grid_.owned_cells; ++K) {
    const double volume = on_host_.volume(K);
    const Cell was = cell(before[K]);
    for (int c : {water, hydrogen}) {
      double out = 0, moved = std::abs(sources[c][K]), terms = 0;
      for (LocalIndex f = on_host_.cell_face_begin(K); f < on_host_.cell_face_begin(K + 1); ++f) {
        const LocalIndex F = on_host_.cell_faces(f);
        const double share = on_host_.face_area(F) / volume;
        out += (on_host_.face_cells(F, 0) == K ? share : -share) * across[F].mass[c];
        moved += share * std::abs(across[F].mass[c]);
        terms += share * across[F].terms[c];
      }
      const double is = mass(cells[K], c), change = is - mass(was, c), net = tau * (out - sources[c][K]);
      const double debt = owed.empty() ? 0 : owed[K][c];
      defects[K][c] = (change + debt + net) / filled[c];
      nobodys[K][c] = epsilon * (std::abs(is) + std::abs(debt) + tau * (moved + terms)) / filled[c];
      most[c] = std::max(most[c], tau * moved / filled[c]);
      most[2 + c] = std::max(most[2 + c], nobodys[K][c]);
      sums[3 * c] += volume * (change + net);
      sums[3 * c + 1] += volume * tau * std::max(sources[c][K], 0.0);
      sums[6 + c] += volume * tau * std::max(-sources[c][K], 0.0);
      sums[3 * c + 2] += volume * (is + (c == water ? filled[water] : 0));
    }
  }
  for (LocalIndex F = 0; F < grid_.faces; ++F)
    if (on_host_.face_cells(F, 1) < 0)
      for (int c : {water, hydrogen}) {
        sums[3 * c + 1] += tau * on_host_.face_area(F) * std::max(-across[F].mass[c], 0.0);
        if (across[F].given) sums[6 + c] += tau * on_host_.face_area(F) * std::max(across[F].mass[c], 0.0);
      }
  grid_.comm.max(most);
  grid_.comm.sum(sums);
  most[water] = std::max(most[water], most[hydrogen]);
  for (int c : {water, hydrogen}) {
    found.accounts[c] = {sums[3 * c], sums[3 * c + 1], sums[6 + c], sums[3 * c + 2]};
    const double counts = std::min(1.0, std::max(most[c], resolved * most[2 + c]));
    for (LocalIndex K = 0; K < grid_.owned_cells; ++K) {
      const double beyond = std::abs(defects[K][c]) - rounding * nobodys[K][c];
      if (!(beyond <= 0)) see(found.unbalanced[c], beyond / counts, grid_.cell_id[K]);
    }
  }
}

/// The worst cells of all ranks, the first of them where several are as bad.
void TwoPhaseVerifier::settle(FlowFindings& found) const {
  FlowFindings::Worst* const all[] = {&found.unbalanced[water],
                                      &found.unbalanced[hydrogen],
                                      &found.negative_gas,
                                      &found.supersaturated,
                                      &found.both_open,
                                      &found.negative_dissolved,
                                      &found.negative_pressure,
                                      &found.all_dissolved,
                                      &found.dry,
                                      &found.not_finite};
  std::vector<double> worst, minus_id, centres;
  for (const auto* of : all) worst.push_back(of->violation);
  grid_.comm.max(worst);
  for (std::size_t i = 0; i < worst.size(); ++i)
    minus_id.push_back(all[i]->cell >= 0 && all[i]->violation == worst[i] ? -static_cast<double>(all[i]->cell) : -infinite);
  std::vector<double> chosen = minus_id;
  grid_.comm.max(chosen);
  for (std::size_t i = 0; i < worst.size(); ++i) {
    const bool here = all[i]->cell >= 0 && minus_id[i] == chosen[i];
    LocalIndex K = 0;
    while (here && grid_.cell_id[K] != all[i]->cell) ++K;
    for (int k = 0; k < 2; ++k) centres.push_back(here ? on_host_.centre(K, k) : 0);
  }
  grid_.comm.sum(centres);
  for (std::size_t i = 0; i < worst.size(); ++i)
    *all[i] = {worst[i], std::isfinite(chosen[i]) ? static_cast<GlobalIndex>(-chosen[i]) : -1, {centres[2 * i], centres[2 * i + 1]}};
}

FlowFindings TwoPhaseVerifier::operator()(double begin, double end, const std::vector<State>& before, const std::vector<State>& after,
                                          const std::vector<Owed>& owed) const {
  std::vector<Cell> cells;
  cells.reserve(after.size());
  for (const State& U : after) cells.push_back(cell(U));
  FlowFindings found;
  found.dimension = grid_.dimension;
  judge_states(after, cells, found);
  judge_balances((end - begin) * seconds_per_unit_, before, cells, crossings(cells, boundary(begin, end)), sources((begin + end) / 2), owed,
                 found);
  settle(found);
  return found;
}

}  // namespace thixis::flow
