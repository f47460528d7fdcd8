#pragma once
#include <memory>

#include "data/tension_bounds.hpp"
#include "thixis/bound/cell_fields.hpp"
#include "thixis/method/space.hpp"

namespace thixis::bound {

/// mu grad u_h of the polynomials of cells, as a flux: for the patches, and for the distance of fluxes from it.
class Stress {
 public:
  virtual ~Stress() = default;
  /// w(k, [2][dim P_q]): modal coefficients of mu grad u_h (its projection on P_q² where the tension varies) on all patch cells.
  virtual void operator()(const method::Coefficients& u, const CellTable& w) const = 0;
  /// Fluxes on the owned cells, (K, 2 dim P_{q+1}); one of length 0 is 0.
  struct Fluxes {
    ConstCellTable disc, alg, lin;
  };
  struct Norms {
    View<double*> whole;     ///< |mu^{1/2} grad u + mu^{-1/2} (disc + alg + lin)|_K
    View<double*> disc;      ///< |mu^{1/2} grad u + mu^{-1/2} disc|_K
    View<double*> alg, lin;  ///< |mu^{-1/2} alg|_K, |mu^{-1/2} lin|_K, from above
  };
  /// In one pass over the fluxes; w as above, that of u. Overwrites the norms.
  virtual void norms(const method::Coefficients& u, const ConstCellTable& w, const Fluxes& sigma, const Norms& norm) const = 0;
  /// The same with (u + before)/2 in place of u, and change = |mu^{1/2} grad (u - before)|_K; w, w_before: those of u and of `before`.
  virtual void norms_between(const method::Coefficients& u, const ConstCellTable& w, const method::Coefficients& before,
                             const ConstCellTable& w_before, const Fluxes& sigma, const Norms& norm, const View<double*>& change) const = 0;
};

std::unique_ptr<Stress> make_stress(const method::Space& space, int q, const scene::Field& tension, const TensionBounds& bounds);

}  // namespace thixis::bound
