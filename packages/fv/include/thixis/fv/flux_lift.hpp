#pragma once
#include <memory>
#include <vector>

#include "thixis/fv/grid.hpp"

namespace thixis::fv {

/// Fluxes of RT_0 with a given divergence (docs/methods/two_phase_estimates.md, 4): with the two-point fluxes of rho,
///
///     sigma·n_F = (rho_K - rho_L)/d_F inside,   rho_K/d_F on held faces,   0 on the others,       div sigma + c rho = r in each cell,
///
/// c = 0 if some face is held, else c = 1/D², D the diagonal of the box around the domain. Among all sigma with this divergence it is the
/// smallest in the norm { sum_F |F| d_F (sigma·n_F)² }^{1/2}. In one dimension, with a held end, there is no other one.
class FluxLift {
 public:
  /// `held`: per local face. The matrix is factored here, once. Collective.
  FluxLift(const Grid& grid, const std::vector<bool>& held);
  ~FluxLift();
  FluxLift(const FluxLift&) = delete;
  FluxLift& operator=(const FluxLift&) = delete;

  /// sigma(F, j), in the direction of the face's normal, from r(K, j) of the owned cells; rest(K, j) = c |K| rho_K². Both overwritten.
  /// Collective.
  void operator()(const View<const double**>& r, const View<double**>& sigma, const View<double**>& rest) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace thixis::fv
