#pragma once
#include <cstddef>
#include <vector>

#include "thixis/equilibration/cell_fields.hpp"

namespace thixis::equilibration {

/// The cells around a vertex a, counter-clockwise: cell m lies between the spokes m and m+1, the faces that contain a; the last cell of an
/// interior vertex lies between the last spoke and spoke 0. A **corner** 3k + i is vertex i of patch cell k.
struct Patch {
  LocalIndex corner = 0;  ///< its corners are Patches::corner(corner + m), m < cells
  LocalIndex spoke = 0;   ///< its spokes have the numbers spoke + m, m < spokes
  int cells = 0, spokes = 0;
  int first_free = 0, free = 0;  ///< spokes whose normal flux is not given: m = first_free … first_free + free - 1
  bool given_first = false;      ///< spoke 0 has a given flux,
  bool given_last = false;       ///< the last spoke has
  LocalIndex unknowns = 0;       ///< where its unknowns begin: q for each free spoke, then one if all are free
  GlobalIndex factor = 0;        ///< where its factor begins
  KOKKOS_INLINE_FUNCTION bool closed() const { return spokes == cells; }
  KOKKOS_INLINE_FUNCTION int size(int q) const { return q * free + (free == spokes ? 1 : 0); }
};

/// A spoke on the boundary whose normal flux is given.
struct GivenSpoke {
  LocalIndex spoke, face;
  int end;     ///< a is end 0 or 1 of the face
  double out;  ///< the domain's outward flux is `out` times the counter-clockwise one
};

/// The patches of all vertices of owned cells.
struct Patches {
  View<Patch*> patch;
  View<LocalIndex*> corner;
  View<LocalIndex* [3][2]>
      spoke;          ///< (patch cell k, i, ·): the spokes before and after the cell in the patch of its vertex i; -1: no patch
  View<bool*> given;  ///< per spoke
  View<GivenSpoke*> given_spokes;
  LocalIndex spokes = 0, unknowns = 0;
  GlobalIndex factors = 0;  ///< entries of all factors: lower triangles row by row
};

/// `cells`, `held`: as in PatchFlux. Interior patches begin at the cell of lowest id, so that all ranks go around them alike.
Patches make_patches(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, const std::vector<bool>& held, int q);

}  // namespace thixis::equilibration
