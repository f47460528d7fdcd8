#pragma once
#include <array>
#include <vector>

#include "thixis/fv/host.hpp"
#include "verify/findings.hpp"
#include "verify/rock.hpp"
#include "verify/scene_data.hpp"

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
  struct Step;
  struct Balance;
  struct Sums;
  using Balances = std::array<Balance, 2>;
  std::vector<Crossing> crossings(const std::vector<VerifiedCell>& cells, const BoundaryData& boundary) const;
  void judge_states(const std::vector<State>& after, const std::vector<VerifiedCell>& cells, FlowFindings& found) const;
  void judge_balances(const Step& step, const std::vector<State>& before, const std::vector<Owed>& owed, FlowFindings& found) const;
  Balance balance(const Step& step, LocalIndex K, int component, const VerifiedCell& was, double debt, Sums& sums) const;
  void add_boundary(const Step& step, Sums& sums) const;

  const fv::Grid& grid_;
  fv::HostGrid on_host_;
  TwoPhaseScene scene_;
  double seconds_per_unit_;
  VerifiedRock rock_;
};

}  // namespace thixis::flow
