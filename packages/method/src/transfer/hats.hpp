#pragma once
#include "thixis/method/numbering.hpp"
#include "thixis/method/space.hpp"

namespace thixis::method {

/// The continuous, piecewise linear functions on a mesh that vanish where data are held, in the basis of the hats of its vertices: the
/// coarser functions below any space, whatever its method.
class Hats {
 public:
  /// `dirichlet`: per tag of the mesh, which must outlive this. Collective.
  Hats(const mesh::Mesh& mesh, const std::vector<bool>& dirichlet);

  const mesh::Mesh& mesh() const { return mesh_; }
  const algebra::MapPtr& map() const { return numbering_.rows; }
  const View<const LocalIndex*>& cells() const { return cells_; }  ///< patch cells
  const ElementUnknowns& elements() const { return elements_; }    ///< (patch cell, vertex) -> column, -1 where held
  /// (patch cell, vertex) -> id of its hat, -1 where held.
  std::vector<std::array<GlobalIndex, 3>> ids() const;

 private:
  const mesh::Mesh& mesh_;
  View<const LocalIndex*> cells_;
  Numbering numbering_;
  ElementUnknowns elements_;
};

/// P: the hats of a mesh as functions on the next finer one, or as functions of a scalar space on the same mesh or the next finer one:
/// a polynomial in every child, and of it what Transfer takes. Rows: the unknowns. Collective.
Teuchos::RCP<const algebra::Matrix> in_finer(const Hats& coarse, const Hats& fine);
Teuchos::RCP<const algebra::Matrix> in_finer(const Hats& coarse, const Space& fine);

}  // namespace thixis::method
