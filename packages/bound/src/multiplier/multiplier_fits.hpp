#pragma once
#include "multiplier/vertex_patches.hpp"
#include "thixis/bound/cell_fields.hpp"
#include "thixis/method/space.hpp"

namespace thixis::bound {

constexpr int most_coefficients = 10;  ///< dim P_3

/// How moments become a polynomial of degree p - 1 on the patch of each vertex, for all patches one after the other.
struct Fits {
  View<LocalIndex*> node_offset;  ///< free functions inside patch a: node_offset(a) … node_offset(a+1)-1
  View<LocalIndex*> node;         ///< entry
  View<double*> hat;              ///< c_l: psi_a = sum_l c_l psi_l
  View<LocalIndex*> fit_offset;   ///< into `fit`
  View<double*> fit;              ///< (coefficient, node): moments -> scaled monomials around the vertex; nothing where they do not suffice
  View<double*> weight;           ///< sum_l c_l (psi_l, 1) over the free functions; 0 where there is none
  View<bool*> free;               ///< whether no function inside the patch is held: then the moment of psi_a is to be kept
  View<double*> diameter;         ///< of the patch: the scale of the monomials
  View<double* [2]> place;        ///< of the vertex
};

/// x^i y^j, i + j <= degree <= 3.
KOKKOS_INLINE_FUNCTION void monomials(int degree, double x, double y, double* value) {
  const double px[4] = {1, x, x * x, x * x * x}, py[4] = {1, y, y * y, y * y * y};
  int b = 0;
  for (int total = 0; total <= degree; ++total)
    for (int j = 0; j <= total; ++j) value[b++] = px[total - j] * py[j];
}

/// For the free functions of the space. `metric`: of its patch cells.
Fits multiplier_fits(const method::Space& space, const VertexPatches& patches, const Metrics& metric);

}  // namespace thixis::bound
