#pragma once
#include <array>
#include <vector>

#include "thixis/flow/scene.hpp"
#include "thixis/fv/host.hpp"
#include "verify/findings.hpp"

namespace thixis::flow {

/// Judges a step of two-phase flow by docs/methods/two_phase.md, 1 to 3, and by the data of the scene. Laws, masses, fluxes and sources are
/// its own: it shares no kernel with the solver, so that a mistake there shows here.
class TwoPhaseVerifier {
 public:
  /// s_g, P, chi of a cell or of what lies behind a face.
  using State = std::array<double, 3>;
  /// Masses per volume that are owed to a cell: more in place than has come in, before the step [kg/m^3].
  using Owed = std::array<double, 2>;

  /// `P_ref`: size of the pressures [Pa].
  TwoPhaseVerifier(const fv::Grid& grid, TwoPhaseScene scene, double seconds_per_unit, double P_ref);

  /// The step ]begin, end] (units of the deck). `before`, `after`: of all local cells, ghosts included; `owed`: of the owned cells, empty:
  /// nothing. Collective.
  FlowFindings operator()(double begin, double end, const std::vector<State>& before, const std::vector<State>& after,
                          const std::vector<Owed>& owed) const;

 private:
  struct Cell;
  struct Crossing;
  struct Boundary;
  double capillary(double s_g) const;
  Cell cell(const State& U) const;
  Crossing crossing(const Cell& A, const Cell& B, double distance, double down) const;
  Boundary boundary(double begin, double end) const;
  std::vector<Crossing> crossings(const std::vector<Cell>& cells, const Boundary& boundary) const;
  std::array<std::vector<double>, 2> sources(double middle) const;
  void judge_states(const std::vector<State>& after, const std::vector<Cell>& cells, FlowFindings& found) const;
  void judge_balances(double tau, const std::vector<State>& before, const std::vector<Cell>& cells, const std::vector<Crossing>& across,
                      const std::array<std::vector<double>, 2>& sources, const std::vector<Owed>& owed, FlowFindings& found) const;
  void settle(FlowFindings& found) const;

  const fv::Grid& grid_;
  fv::HostGrid on_host_;
  TwoPhaseScene scene_;
  double seconds_per_unit_, P_ref_;
  double H_, beta_l_, beta_g_;           ///< of the document
  double S_e_line_ = 1, P_at_line_ = 0;  ///< P_cp is a line from there to s_g = 0
  double a_ = 0, b_ = 0, meets_at_ = 0;  ///< of the quadratic law, up to this s_g
};

}  // namespace thixis::flow
