#pragma once
#include <vector>

#include "deviation/deviation_points.hpp"
#include "lift/boundary_lift.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/mesh/to_view.hpp"

namespace thixis::bound {

/// What is read of a block of points.
struct BlockOnHost {
  mesh::ConstHostView<const LocalIndex*> cell;
  mesh::ConstHostView<const int*> offset;
  mesh::ConstHostView<const double* [2]> xi;
  explicit BlockOnHost(const method::QuadratureBlock& block);
};

/// D = L_1 + psi_I - psi, cell by cell.
class OverObstacle {
 public:
  /// All that is given must outlive it. Collective.
  OverObstacle(const method::Space& space, const BoundaryLift& lift, const ContinuousNodes& nodes, const scene::FieldPtr& obstacle,
               const std::vector<double>& psi, const method::Jumps& jumps);
  /// Collective.
  Deviation operator()(const std::vector<bool>& dirichlet);

 private:
  /// Bernstein coefficients of psi_I.
  void polynomial(LocalIndex K, double* c) const {
    double local[reference::max_functions];
    for (int l = 0; l < space_.basis().size(); ++l) local[l] = psi_[of_cells_(K, l)];
    space_.basis().to_bernstein(local, c);
  }
  double known_as(LocalIndex K) const;
  /// |psi - psi_I| at the points of cell k of a block; the largest.
  double most(const BlockOnHost& block, LocalIndex k, const mesh::HostView<double*>& value) const;
  /// Positions of the cells with a deviation; sets `deviates_`.
  std::vector<LocalIndex> find();
  /// offset: of the quadrature, on the host.
  void tabulate(const method::QuadratureBlock& block, const mesh::ConstHostView<const GlobalIndex*>& offset,
                const std::vector<LocalIndex>& positions);
  void mark(const std::vector<LocalIndex>& positions, const std::vector<bool>& dirichlet) const;

  const method::Space& space_;
  const mesh::Mesh& mesh_;
  mesh::HostMesh host_;
  const BoundaryLift& lift_;
  mesh::ConstHostView<const LocalIndex**> of_cells_;
  const scene::FieldPtr& obstacle_;
  const std::vector<double>& psi_;
  const method::Jumps& jumps_;
  const reference::Bernstein& B_;
  std::vector<LocalIndex> in_layer_;
  double size_;  ///< of psi on all ranks
  method::Gradient slope_;
  bool deviates_ = false;

  method::CellQuadrature quadrature_;
  DeviationOnHost out_;
};

}  // namespace thixis::bound
