#pragma once
#include <map>
#include <vector>

#include "thixis/equilibration/cell_fields.hpp"
#include "thixis/mesh/ancestry.hpp"

namespace thixis::equilibration {

constexpr int most_children = 4;
using Children = View<LocalIndex* [most_children]>;

/// The matrices of a Cut by columns, for kernels.
struct CutMatrices {
  int children;
  Matrix sum, share, lift, restrict;  ///< transposed
};

/// The cells of one level that are cut alike, with their children.
struct Family {
  CutMatrices cut;
  View<LocalIndex*> parent;
  Children child;
};

/// The families of one degree, which know the matrices of all cuts met so far.
class Families {
 public:
  explicit Families(int q) : q_(q) {}
  /// Between a level with so many cells and the one below it, `level`. `place`: where fluxes and densities of its cells are; empty: under
  /// their own numbers.
  std::vector<Family> operator()(std::size_t cells, const mesh::Ancestry::Level& level, const std::vector<LocalIndex>& place);

 private:
  int q_;
  std::map<std::vector<mesh::ChildShape>, CutMatrices> known_;
};

}  // namespace thixis::equilibration
