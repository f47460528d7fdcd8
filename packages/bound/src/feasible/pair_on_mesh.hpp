#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "feasible/averages.hpp"
#include "feasible/pressing.hpp"
#include "lift/boundary_lift.hpp"
#include "thixis/bound/feasible.hpp"

namespace thixis::bound {

/// The feasible pair on a mesh at one time of the boundary data.
struct FeasiblePair::Impl {
  Impl(const method::Space& space, const Problem& problem);
  /// The same but for the boundary data.
  Impl(const Impl& other, double time);

  View<double*> at_nodes() const { return View<double*>("thixis::bound::averaged", nodes.entries.size()); }
  /// Set up when it is first asked for. Collective.
  Pressing& pressing();
  /// Gaps below are round-off. Collective.
  double noise(const Continuous& s_c) const;

  const method::Space& space;
  Problem problem;
  ContinuousNodes nodes;
  method::Jumps jumps;  ///< of the obstacle
  Matrix monomials;
  Matrix modal;  ///< (m, l): modal coefficients of basis functions
  Tension tension;
  FeasibleParts kernel;
  View<const double*> data[2];  ///< coefficients on the held boundary; over an obstacle [1] is psi_I
  std::unique_ptr<BoundaryLift> lift;
  std::optional<Averages> averages;
  View<double*> averaged[2];
  std::unique_ptr<Pressing> known_pressing;

 private:
  void set_tensions();
  void set_kernel();
  /// `other`: a lift at another time.
  void set_boundary(const BoundaryLift* other);
  /// Bernstein coefficients of ordered data need not be ordered.
  void bring_in_order(std::vector<double> (&held)[2]) const;
  /// `psi`: psi_I, `g`: the boundary data.
  void set_obstacle(const std::vector<double>& psi, const std::vector<double>& g);
  /// Vertices of cells in which the obstacle jumps: there s lies on a majorant.
  std::vector<bool> of_jumps() const;
};

}  // namespace thixis::bound
