#pragma once
#include <vector>

#include "thixis/method/space.hpp"
#include "thixis/reference/modal.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::hho {

struct Face {
  LocalIndex face = -1;   ///< of the mesh
  LocalIndex entry = -1;  ///< of the scalar space, the first of p; component i of c: c (entry + j) + i
};

/// The faces of the patch cells, in the order of their entries.
inline std::vector<Face> faces_of(const method::Space& space) {
  const int p = space.basis().degree(), n = space.basis().size(), c = space.components();
  const LocalIndex cell_entries = space.coefficients().cell_entries / c;
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.coefficients().element_entries);
  const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.cells());
  std::vector<Face> faces((space.coefficients().entries.size() / c - cell_entries) / p);
  for (int k = 0; k < cells.extent_int(0); ++k)
    for (int f = 0; f < 3; ++f) {
      const LocalIndex entry = entries(k, c * (n + f * p)) / c;
      faces[(entry - cell_entries) / p] = {space.host().cell_faces(cells(k), f), entry};
    }
  return faces;
}

/// set(F, j, integral of g L_j over [0,1] along F) for those of the faces that are wanted. Throws on this rank only.
template <class Wanted, class Set>
void project(const method::Space& space, const std::vector<Face>& faces, const scene::Field& g, double t, Wanted wanted, Set set) {
  const mesh::HostMesh& mesh = space.host();
  const int p = space.basis().degree();
  const auto rule = reference::line_quadrature(space.options().params.order());
  std::vector<const Face*> on;
  std::vector<double> x, y;
  for (const Face& F : faces) {
    if (!wanted(F)) continue;
    on.push_back(&F);
    const LocalIndex a = mesh.face_vertices(F.face, 0), b = mesh.face_vertices(F.face, 1);
    for (const double s : rule.point) {
      x.push_back((1 - s) * mesh.coordinates(a, 0) + s * mesh.coordinates(b, 0));
      y.push_back((1 - s) * mesh.coordinates(a, 1) + s * mesh.coordinates(b, 1));
    }
  }
  std::vector<double> values(x.size()), weighted(rule.size() * p);
  g.evaluate({x.size(), x.data(), y.data()}, t, values.data());
  for (int q = 0; q < rule.size(); ++q) {
    const auto L = reference::legendre(p, rule.point[q]);
    for (int j = 0; j < p; ++j) weighted[q * p + j] = rule.weight[q] * L[j];
  }
  for (std::size_t k = 0; k < on.size(); ++k)
    for (int j = 0; j < p; ++j) {
      double integral = 0;
      for (int q = 0; q < rule.size(); ++q) integral += weighted[q * p + j] * values[k * rule.size() + q];
      set(*on[k], j, integral);
    }
}

}  // namespace thixis::hho
