#include <array>
#include <cmath>

#include "polynomial_kernels.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/method/space.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::method {
namespace {

/// Points of the face f of the reference cell, from vertex f+1 to f+2, at t.
std::array<double, 2> on_face(int f, double t) {
  constexpr double corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  const double* const a = corner[(f + 1) % 3];
  const double* const b = corner[(f + 2) % 3];
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
}

/// The basis functions at the points of a line rule on each face of the reference cell.
std::array<reference::Tabulation, 3> face_tables(const reference::CellBasis& basis, const reference::Quadrature& rule) {
  std::array<reference::Tabulation, 3> tables;
  for (int f = 0; f < 3; ++f) {
    std::vector<double> at;
    for (const double s : rule.point)
      for (const double coordinate : on_face(f, s)) at.push_back(coordinate);
    tables[f] = basis.tabulate(rule.size(), at.data());
  }
  return tables;
}

/// The faces with a tag, as faces of patch cells, with the points of a line rule on them, from vertex f+1 to f+2 of the cell.
struct TaggedFaces {
  std::vector<std::array<LocalIndex, 2>> faces;  ///< patch position, local face
  std::vector<double> length, x, y;
};

TaggedFaces with_tag(const Space& space, LocalIndex tag, const reference::Quadrature& rule) {
  const mesh::HostMesh& mesh = space.host();
  TaggedFaces found;
  for (LocalIndex F = 0; F < space.mesh().faces; ++F) {
    if (mesh.face_tag(F) != tag) continue;
    const LocalIndex K = mesh::first_cell(mesh.face_cells, F);
    if (space.position(K) < 0) continue;
    const int f = mesh::local_face(mesh.cell_faces, K, F);
    const LocalIndex a = mesh.cell_vertices(K, (f + 1) % 3), b = mesh.cell_vertices(K, (f + 2) % 3);
    const double dx = mesh.coordinates(b, 0) - mesh.coordinates(a, 0), dy = mesh.coordinates(b, 1) - mesh.coordinates(a, 1);
    found.faces.push_back({space.position(K), f});
    found.length.push_back(std::hypot(dx, dy));
    for (const double s : rule.point) {
      found.x.push_back(mesh.coordinates(a, 0) + s * dx);
      found.y.push_back(mesh.coordinates(a, 1) + s * dy);
    }
  }
  return found;
}

}  // namespace

void Space::add_moments(const Function& f, double t, algebra::Vector& F) const {
  THIXIS_ASSERT_EQ(f.components(), components(), "a function for each component");
  const View<double*> values("thixis::method::force", quadrature_.largest_block);
  const Block2 local("thixis::method::loads", std::min(quadrature_.block_cells, quadrature_.cells()), components() * basis_.size());
  const CellFunctions basis = cell_functions(basis_);
  for_each_block(quadrature_, [&](const QuadratureBlock& block) {
    const Block2 part = Kokkos::subview(local, std::pair(0, block.cells), Kokkos::ALL);
    for (int i = 0; i < components(); ++i) {
      evaluate(f[i], t, block, values);
      moments(basis, block, values, {components(), i}, part);
    }
    scatter(elements_, block.first, part, F);
  });
}

void Layout::add_traces(const Space& space, const std::vector<scene::FieldPtr>& by_tag, double t, algebra::Vector& F) const {
  const auto rule = reference::line_quadrature(space.options().params.order());
  const int n = space.basis().size(), points = rule.size(), components = space.components();
  const auto trace = face_tables(space.basis(), rule);
  const auto columns = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.elements());
  const auto out = algebra::host_view(F);
  for (std::size_t at = 0; at < by_tag.size(); ++at) {
    if (!by_tag[at]) continue;
    const int component = static_cast<int>(at) % components;
    const TaggedFaces on = with_tag(space, static_cast<LocalIndex>(at) / components, rule);
    std::vector<double> traction(on.x.size());
    by_tag[at]->evaluate({on.x.size(), on.x.data(), on.y.data()}, t, traction.data());
    for (std::size_t k = 0; k < on.faces.size(); ++k)
      for (int l = 0; l < n; ++l) {
        const LocalIndex row = columns(on.faces[k][0], components * l + component);
        if (row < 0 || row >= static_cast<LocalIndex>(out.extent(0))) continue;
        for (int q = 0; q < points; ++q)
          out(row) += on.length[k] * rule.weight[q] * traction[k * points + q] * trace[on.faces[k][1]].value[q * n + l];
      }
  }
}

}  // namespace thixis::method
