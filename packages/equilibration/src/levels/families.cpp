#include "levels/families.hpp"

#include <algorithm>
#include <array>

#include "thixis/equilibration/cut.hpp"
#include "thixis/mesh/to_view.hpp"

namespace thixis::equilibration {
namespace {

using ChildrenOf = std::vector<std::array<LocalIndex, most_children>>;
using Shapes = std::vector<mesh::ChildShape>;

Matrix by_columns(const std::string& label, int rows, int columns, const std::vector<double>& values) {
  const Kokkos::View<double**, Kokkos::LayoutRight> matrix(label, columns, rows);
  const auto host = Kokkos::create_mirror_view(matrix);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) host(j, i) = values.empty() ? 0 : values[i * columns + j];
  Kokkos::deep_copy(matrix, host);
  return matrix;
}

CutMatrices matrices(const Cut& cut, int q) {
  const int n = reference::dimension(q), flux = 2 * reference::dimension(q + 1), c = cut.children;
  CutMatrices of;
  of.children = c;
  of.sum = by_columns("thixis::equilibration::sum", n, c * n, cut.sum);
  of.share = by_columns("thixis::equilibration::share", c * n, n, cut.share);
  of.lift = by_columns("thixis::equilibration::lift", c * flux, c * n, cut.lift);
  of.restrict = by_columns("thixis::equilibration::restrict", c * flux, flux, cut.restrict);
  return of;
}

ChildrenOf children_of(std::size_t cells, const std::vector<LocalIndex>& parent) {
  ChildrenOf children(cells, {-1, -1, -1, -1});
  for (std::size_t c = 0; c < parent.size(); ++c) {
    auto& of_parent = children[parent[c]];
    *std::find(of_parent.begin(), of_parent.end(), -1) = static_cast<LocalIndex>(c);
  }
  return children;
}

/// Sorts the children of each cell by their shapes, and the cells by these; cells of other ranks are left out.
std::map<Shapes, std::vector<LocalIndex>> sort_by_shape(ChildrenOf& children, const std::vector<mesh::ChildShape>& shape) {
  std::map<Shapes, std::vector<LocalIndex>> alike;
  Shapes shapes;
  for (std::size_t K = 0; K < children.size(); ++K) {
    auto& of_parent = children[K];
    const auto end = std::find(of_parent.begin(), of_parent.end(), -1);
    if (end == of_parent.begin()) continue;
    std::sort(of_parent.begin(), end, [&](LocalIndex a, LocalIndex b) { return shape[a] < shape[b]; });
    shapes.clear();
    for (auto c = of_parent.begin(); c != end; ++c) shapes.push_back(shape[*c]);
    alike[shapes].push_back(static_cast<LocalIndex>(K));
  }
  return alike;
}

}  // namespace

std::vector<Family> Families::operator()(std::size_t cells, const mesh::Ancestry::Level& level, const std::vector<LocalIndex>& place) {
  ChildrenOf children = children_of(cells, level.parent);
  std::vector<Family> found;
  for (const auto& [shapes, parents] : sort_by_shape(children, level.shape)) {
    if (known_.count(shapes) == 0) known_.emplace(shapes, matrices(cut(shapes, q_), q_));
    Family family{known_.at(shapes), mesh::to_view("thixis::equilibration::parent", parents),
                  Children("thixis::equilibration::children", parents.size())};
    const auto child_host = Kokkos::create_mirror_view(family.child);
    for (std::size_t e = 0; e < parents.size(); ++e)
      for (int c = 0; c < most_children; ++c) {
        const LocalIndex child = children[parents[e]][c];
        child_host(e, c) = child >= 0 && !place.empty() ? place[child] : child;
      }
    Kokkos::deep_copy(family.child, child_host);
    found.push_back(family);
  }
  return found;
}

}  // namespace thixis::equilibration
