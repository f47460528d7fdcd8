#pragma once
#include <vector>

#include "patch_data.hpp"

namespace thixis::equilibration {

/// sigma_a of PatchFlux from the textbook: a mixed saddle point problem in physical coordinates, dense, solved by elimination with
/// pivoting. On each cell all of RT_q; divergence, continuity across spokes and given normal fluxes by multipliers.
class SaddlePoint {
 public:
  /// The patch of vertex a. Throws std::runtime_error where the matrix is singular.
  SaddlePoint(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, const std::vector<bool>& held, int q, const PatchData& data,
              LocalIndex a);
  /// Patch cells (positions in `cells`) around a.
  const std::vector<LocalIndex>& around() const { return around_; }
  /// The physical flux on the m-th of them at reference coordinates: sigma_a(F(xi)).
  std::vector<double> value(int m, const double* xi) const;

 private:
  struct Affine {
    double origin[2], DF[2][2], det, centre[2], h;
    std::vector<double> at(const double* xi) const;
  };
  std::vector<double> basis(const Affine& K, const std::vector<double>& x) const;
  std::vector<double> divergence(const Affine& K, const std::vector<double>& x) const;

  int q_, size_;
  std::vector<LocalIndex> around_;
  std::vector<Affine> affine_;
  std::vector<double> solution_;
};

}  // namespace thixis::equilibration
