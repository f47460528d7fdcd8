#pragma once
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "level/membrane_kkt.hpp"

namespace thixis::membranes {

/// Both membranes, or the one over an obstacle, as functions at one time.
struct Pair {
  method::Coefficients u[2];
};

/// sum_alpha ∫ mu_alpha |grad u_alpha|², and the same of the exact solution at time t less u.
double squared_energy(const MembraneLevel& level, const Pair& now);
double squared_energy_error(const MembraneLevel& level, const Pair& now, double t);

/// The bound of each owned cell of this rank.
template <class Parts>
models::CellEstimates cells_of(const Parts& parts) {
  return models::cell_estimates(parts.discretization, parts.linearization, parts.algebraic);
}

/// What membranes at rest and in time have in common on a mesh. `Scene`: models::Discretization or models::Evolution.
template <class Scene>
class MembranesOnMesh : public Scene {
 public:
  const core::Comm& comm() const override { return space().mesh().comm; }
  GlobalIndex cells() const override { return space().mesh().global_cells; }
  models::Sizes sizes() const override {
    const MembraneProblem& problem = on_mesh_->problem();
    return {problem.unknowns(), problem.rows(), problem.nonzeros()};
  }
  complementarity::Problem& problem() override { return on_mesh_->problem(); }

  double energy_norm(const algebra::Vector& X) const override { return std::sqrt(squared_energy(*on_mesh_, at(X))); }
  std::optional<models::Contact> contact(const algebra::Vector& X) const override { return on_mesh_->contact(X); }
  std::vector<double> values_at(const std::vector<models::Probe>& probes, const algebra::Vector& X) const override {
    return on_mesh_->values_at(probes, X);
  }
  output::Grid grid() const override { return space().display(); }
  std::vector<output::FieldData> fields(const algebra::Vector& X, const complementarity::ActiveSet& active,
                                        const std::vector<std::string>& names) const override {
    return on_mesh_->shown(X, active, names);
  }

 protected:
  const method::Space& space() const { return on_mesh_->space(); }
  /// With the boundary values of the time of the data.
  Pair at(const algebra::Vector& X) const {
    const Fields x = on_mesh_->fields(X);
    Pair now;
    for (int alpha = 0; alpha < on_mesh_->count(); ++alpha) now.u[alpha] = on_mesh_->membrane(x, alpha);
    return now;
  }
  /// What the verifier judges, but for what changes in time.
  MembraneSolution solution(const algebra::Vector& X) const {
    MembraneSolution solution{*on_mesh_, on_mesh_->fields(X)};
    for (int alpha = 0; alpha < on_mesh_->count(); ++alpha) solution.u[alpha] = on_mesh_->membrane(solution.x, alpha);
    return solution;
  }

  std::unique_ptr<MembraneLevel> on_mesh_;
};

}  // namespace thixis::membranes
