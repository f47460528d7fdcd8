#pragma once
#include <vector>

#include "thixis/method/space.hpp"

namespace thixis::hho {

using method::View;
using Moments = Kokkos::View<double**, Kokkos::LayoutRight>;

struct Face {
  LocalIndex face = -1;   ///< of the mesh
  LocalIndex entry = -1;  ///< of the scalar space, the first of p; component i of c: c (entry + j) + i
};

/// The faces of the patch cells, in the order of their entries.
std::vector<Face> faces_of(const method::Space& space);

/// Some of the faces of a space, with the coefficients of the projection of a function.
struct Projected {
  View<const LocalIndex*> number;  ///< among the faces
  View<const LocalIndex*> face, entry;
  View<double*> length;
  Moments coefficient;  ///< (e, j): ∫ of g L_j over [0,1] along the face

  LocalIndex size() const { return face.extent_int(0); }
};
/// The projection of g(·, t) to the polynomials on the faces at the positions `wanted` of `faces`. Throws on this rank only.
Projected project(const method::Space& space, const std::vector<Face>& faces, const std::vector<LocalIndex>& wanted, const scene::Field& g,
                  double t);

/// Positions of the faces of which wanted(Face) is true.
template <class Wanted>
std::vector<LocalIndex> select(const std::vector<Face>& faces, Wanted wanted) {
  std::vector<LocalIndex> found;
  for (std::size_t k = 0; k < faces.size(); ++k)
    if (wanted(faces[k])) found.push_back(static_cast<LocalIndex>(k));
  return found;
}

}  // namespace thixis::hho
