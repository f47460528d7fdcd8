#pragma once
#include <memory>

#include "thixis/equilibration/cell_fields.hpp"
#include "thixis/method/polynomial_space.hpp"

namespace thixis::equilibration {

/// mu grad u_h of the polynomials of cells, as a flux: for the patches, and for the distance of fluxes from it.
class Stress {
 public:
  virtual ~Stress() = default;
  /// w(k, [2][dim P_q]): modal coefficients of mu grad u_h (its projection on P_q² where the tension varies) on all patch cells.
  virtual void operator()(const method::Coefficients& u, const CellTable& w) const = 0;
  /// |mu^{1/2} grad u + mu^{-1/2} sigma|_K on the owned cells; sigma (K, 2 dim P_{q+1}), w as above.
  virtual void distance(const method::Coefficients& u, const ConstCellTable& w, const ConstCellTable& sigma,
                        const View<double*>& norm) const = 0;
  /// |mu^{-1/2} sigma|_K, from above.
  virtual void size(const ConstCellTable& sigma, const View<double*>& norm) const = 0;
};

/// `least`: of the tension in each owned cell.
std::unique_ptr<Stress> make_stress(const method::PolynomialSpace& space, int q, const scene::Field& tension,
                                    const std::vector<double>& least);

}  // namespace thixis::equilibration
