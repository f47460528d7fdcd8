#pragma once
#include "thixis/equilibration/cell_fields.hpp"

namespace thixis::equilibration {

/// Reference fields of RT_q (reference::RaviartThomas) as the kernels read them. Fields are tested with divergence-free fields of RT_q
/// only, which are polynomials of degree q: it is enough to keep the first dim P_q modes of both components, a **short** field.
template <int Q>
struct PatchTables {
  static constexpr int density = reference::dimension(Q);           ///< dim P_q
  static constexpr int length = 2 * density;                        ///< of a short field
  static constexpr int flux = 2 * reference::dimension(Q + 1);      ///< of a field
  static constexpr int bubbles = Q < 2 ? 0 : Q * (Q - 1) / 2;       ///< dim P_{q-2}
  static constexpr int stored_bubbles = bubbles > 0 ? bubbles : 1;  ///< Views have no empty fixed extents
  static constexpr int tests = 2 * Q + 1;                           ///< see `test`
  static constexpr int given = 3 * (Q + 1) + density - 1;           ///< face moments and densities
  static constexpr int fields = given + bubbles;                    ///< dim RT_q

  View<double[3][Q + 1][length]> face;         ///< from_face(f, j), short
  View<double[density][length]> from_density;  ///< short; 0 for the first
  View<double[3][density][density]> hat;       ///< u -> projection of lambda_i u on P_q; symmetric
  View<double[stored_bubbles][length]> bubble;
  View<double[length][stored_bubbles]> bubble_transposed;
  /// (i, ·, t): the divergence-free fields of a corner i, without their bubble part. The moments of the counter-clockwise normal flux, from
  /// the vertex outwards, are L_{t+1} on the spoke before for t < q, L_{t-q+1} on the spoke after for q <= t < 2q, and L_0 on both for 2q.
  View<double[3][length][tests]> test;
  /// from_face(f, j), from_density(1, …), bubble(m), whole.
  View<double[fields][flux]> field;

  static PatchTables make();
};

}  // namespace thixis::equilibration
