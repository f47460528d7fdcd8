#include "verify/verifier.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "verify/scene_data.hpp"
#include "verify/worst.hpp"

namespace thixis::flow {
namespace {

constexpr int water = 0, hydrogen = 1;
constexpr double infinite = std::numeric_limits<double>::infinity(), epsilon = std::numeric_limits<double>::epsilon();
constexpr double rounding = 64;    // units in the last place of the terms of a balance that are nobody's fault
constexpr double resolved = 1e10;  // units in the last place that must be moved to be the measure of what is missed

}  // namespace

/// What the step is found to be: its states and what crosses the faces.
struct TwoPhaseVerifier::Step {
  double tau;  ///< [s]
  std::vector<VerifiedCell> cells;
  std::vector<Crossing> across;
  std::array<std::vector<double>, 2> sources;
};

/// Of a component in a cell, in shares of a filled one.
struct TwoPhaseVerifier::Balance {
  double defect = 0;
  double nobodys = 0;  ///< what rounding is
};

struct TwoPhaseVerifier::Sums {
  std::vector<double> most = std::vector<double>(4, 0);      ///< in the worst cell: what is moved of water, of hydrogen, and rounding
  std::vector<double> accounts = std::vector<double>(8, 0);  ///< by component: defect, brought, drawn, in place [kg]
};

TwoPhaseVerifier::TwoPhaseVerifier(const fv::Grid& grid, TwoPhaseScene scene, double seconds_per_unit, double P_ref)
    : grid_(grid), on_host_(fv::on_host(grid)), scene_(std::move(scene)), seconds_per_unit_(seconds_per_unit), rock_(scene_, P_ref) {}

std::vector<Crossing> TwoPhaseVerifier::crossings(const std::vector<VerifiedCell>& cells, const BoundaryData& boundary) const {
  std::vector<Crossing> across(grid_.faces);
  for (LocalIndex F = 0; F < grid_.faces; ++F) {
    const VerifiedCell& A = cells[on_host_.face_cells(F, 0)];
    const double d = on_host_.face_distance(F);
    const double down = scene_.gravity[0] * on_host_.face_normal(F, 0) + scene_.gravity[1] * on_host_.face_normal(F, 1);
    if (const LocalIndex B = on_host_.face_cells(F, 1); B >= 0) {
      across[F] = rock_.crossing(A, cells[B], d, down);
    } else if (const int i = boundary.of_face[F]; i >= 0) {
      if (boundary.kind[i] == FlowBoundaryKind::state) across[F] = rock_.crossing(A, rock_.cell(boundary.outside[i]), d, down);
      else across[F] = {{-boundary.entering[i][water], -boundary.entering[i][hydrogen]}, {0, 0}, true};
    }
  }
  return across;
}

void TwoPhaseVerifier::judge_states(const std::vector<State>& after, const std::vector<VerifiedCell>& cells, FlowFindings& found) const {
  double most_gas = 1e-2;
  for (LocalIndex K = 0; K < grid_.owned_cells; ++K) most_gas = std::max(most_gas, std::abs(cells[K].s_g));
  most_gas = grid_.comm.max(most_gas);
  for (LocalIndex K = 0; K < grid_.owned_cells; ++K) {
    const VerifiedCell& U = cells[K];
    const GlobalIndex id = grid_.cell_id[K];
    const double G = rock_.undersaturation(U), gas = U.s_g / most_gas;
    found.undersaturation.push_back(G);
    for (const double value : after[K])
      if (!std::isfinite(value)) see(found.not_finite, infinite, id);
    see(found.negative_gas, -gas, id);
    see(found.supersaturated, -G, id);
    see(found.both_open, std::min(std::abs(gas), std::abs(G)), id);
    see(found.negative_dissolved, -rock_.dissolved(U), id);
    see(found.negative_pressure, -U.P_g / rock_.P_ref(), id);
    see(found.all_dissolved, U.chi - 1, id);
    see(found.dry, U.s_g - rock_.driest(), id);
  }
}

/// l_c(after) - l_c(before) + owed + tau (sum_F ± |F| Phi_c / |K| - Q_c), in every cell and over all of them                (1)
void TwoPhaseVerifier::judge_balances(const Step& step, const std::vector<State>& before, const std::vector<Owed>& owed,
                                      FlowFindings& found) const {
  std::vector<Balances> balances(grid_.owned_cells);
  Sums sums;
  for (LocalIndex K = 0; K < grid_.owned_cells; ++K) {
    const VerifiedCell was = rock_.cell(before[K]);
    for (int c : {water, hydrogen}) balances[K][c] = balance(step, K, c, was, owed.empty() ? 0 : owed[K][c], sums);
  }
  add_boundary(step, sums);
  grid_.comm.max(sums.most);
  grid_.comm.sum(sums.accounts);
  sums.most[water] = std::max(sums.most[water], sums.most[hydrogen]);
  for (int c : {water, hydrogen}) {
    const double* account = &sums.accounts[4 * c];
    found.accounts[c] = {account[0], account[1], account[2], account[3]};
    const double counts = std::min(1.0, std::max(sums.most[c], resolved * sums.most[2 + c]));
    for (LocalIndex K = 0; K < grid_.owned_cells; ++K) {
      const double beyond = std::abs(balances[K][c].defect) - rounding * balances[K][c].nobodys;
      if (!(beyond <= 0)) see(found.unbalanced[c], beyond / counts, grid_.cell_id[K]);
    }
  }
}

TwoPhaseVerifier::Balance TwoPhaseVerifier::balance(const Step& step, LocalIndex K, int c, const VerifiedCell& was, double debt,
                                                    Sums& sums) const {
  const double volume = on_host_.volume(K), source = step.sources[c][K], filled = rock_.filled(c);
  double out = 0, moved = std::abs(source), terms = 0;
  for (LocalIndex f = on_host_.cell_face_begin(K); f < on_host_.cell_face_begin(K + 1); ++f) {
    const LocalIndex F = on_host_.cell_faces(f);
    const double share = on_host_.face_area(F) / volume;
    out += (on_host_.face_cells(F, 0) == K ? share : -share) * step.across[F].mass[c];
    moved += share * std::abs(step.across[F].mass[c]);
    terms += share * step.across[F].terms[c];
  }
  const double is = rock_.mass(step.cells[K], c), change = is - rock_.mass(was, c), net = step.tau * (out - source);
  const Balance of{(change + debt + net) / filled, epsilon * (std::abs(is) + std::abs(debt) + step.tau * (moved + terms)) / filled};
  sums.most[c] = std::max(sums.most[c], step.tau * moved / filled);
  sums.most[2 + c] = std::max(sums.most[2 + c], of.nobodys);
  double* account = &sums.accounts[4 * c];
  account[0] += volume * (change + net);
  account[1] += volume * step.tau * std::max(source, 0.0);
  account[2] += volume * step.tau * std::max(-source, 0.0);
  account[3] += volume * (is + (c == water ? filled : 0));
  return of;
}

/// What comes in there, and what the deck draws.
void TwoPhaseVerifier::add_boundary(const Step& step, Sums& sums) const {
  for (LocalIndex F = 0; F < grid_.faces; ++F) {
    if (on_host_.face_cells(F, 1) >= 0) continue;
    for (int c : {water, hydrogen}) {
      const double mass = step.tau * on_host_.face_area(F) * step.across[F].mass[c];
      sums.accounts[4 * c + 1] += std::max(-mass, 0.0);
      if (step.across[F].given) sums.accounts[4 * c + 2] += std::max(mass, 0.0);
    }
  }
}

FlowFindings TwoPhaseVerifier::operator()(double begin, double end, const std::vector<State>& before, const std::vector<State>& after,
                                          const std::vector<Owed>& owed) const {
  const SceneData data{grid_, on_host_, scene_, seconds_per_unit_};
  Step step{(end - begin) * seconds_per_unit_, {}, {}, data.sources((begin + end) / 2)};
  step.cells.reserve(after.size());
  for (const State& U : after) step.cells.push_back(rock_.cell(U));
  step.across = crossings(step.cells, data.boundary(begin, end));
  FlowFindings found;
  found.dimension = grid_.dimension;
  judge_states(after, step.cells, found);
  judge_balances(step, before, owed, found);
  settle(grid_, on_host_, found);
  return found;
}

}  // namespace thixis::flow
