/// Thixis as a library: a scene of one's own on a mesh of one's own, solved and verified.
#include <Tpetra_Core.hpp>
#include <cstdio>

#include "thixis/complementarity/kkt.hpp"
#include "thixis/core/deck.hpp"
#include "thixis/core/error.hpp"
#include "thixis/drive/stationary.hpp"
#include "thixis/fem/entry.hpp"
#include "thixis/membranes/family.hpp"
#include "thixis/membranes/membranes.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/mesh/mesh.hpp"
#include "thixis/models/catalogue.hpp"

namespace {

constexpr const char* text = R"(
<ParameterList name="thixis">
  <ParameterList name="scene">
    <Parameter name="model" type="string" value="membranes"/>
    <Parameter name="case" type="string" value="disk"/>
  </ParameterList>
  <ParameterList name="mesh">
    <Parameter name="generator" type="string" value="disk"/>
    <Parameter name="rings" type="int" value="4"/>
    <Parameter name="refinements" type="int" value="1"/>
  </ParameterList>
  <ParameterList name="newton"><Parameter name="start" type="string" value="nested"/></ParameterList>
</ParameterList>)";

/// Solves, verifies; whether the verifier accepts the solution, and it is accurate.
bool solve() {
  namespace drive = thixis::drive;
  const auto deck = thixis::core::Deck::from_text(text, "client");
  const thixis::models::Catalogue catalogue({thixis::fem::entry()}, {thixis::membranes::family()});
  const auto params = deck.parse(catalogue.schema());
  auto hierarchy = thixis::mesh::build(params.mesh, thixis::core::Comm(), deck.folder());
  const auto model =
      thixis::membranes::membranes(thixis::membranes::membrane_scene(params.scene), thixis::fem::entry(), params.method, params.linear, {});
  const drive::Outcome outcome = drive::solve_stationary(*model, hierarchy, params, {});

  const auto kkt = thixis::complementarity::verify(outcome.discretization->kkt_data(*outcome.X));
  const double error = outcome.energy_error.value() / outcome.energy_norm;
  std::printf("%lld cells, %d Newton steps, relative energy error %.1e. %s\n", hierarchy.finest().global_cells,
              outcome.at.newton_iterations, error, kkt.sentence(outcome.kkt_tolerance).c_str());
  return outcome.solved && kkt.holds(outcome.kkt_tolerance) && error < 0.2;
}

}  // namespace

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  try {
    return solve() ? 0 : 1;
  } catch (const thixis::core::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.code());
  }
}
