#pragma once
#include "patches/patch_factors.hpp"
#include "thixis/equilibration/patch_flux.hpp"

/// Kernels of PatchFlux, in the order in which an evaluation runs them (docs/methods/estimates.md, 3). Moments of a spoke are those of
/// the counter-clockwise normal flux from the vertex outwards.
namespace thixis::equilibration {

using Moments = View<double**>;  ///< (spoke, j)

/// Moments of spokes with a given flux.
template <int Q>
struct GivenFlux {
  View<GivenSpoke*> given;
  ConstCellTable traction;
  Moments moments;  ///< out

  KOKKOS_FUNCTION void operator()(int g) const {
    const GivenSpoke s = given(g);
    for (int j = 0; j <= Q; ++j) {
      const double sign = s.end == 1 && j % 2 == 1 ? -s.out : s.out;
      moments(s.spoke, j) = traction.extent(0) > 0 ? sign * traction(s.face, s.end * (Q + 1) + j) : 0;
    }
  }
};

/// A flux through the spokes that balances the densities: L_0 only, summed up around the vertex from a given flux or from 0.
template <int Q>
struct Sweep {
  Patches patches;
  ConstCellTable density;
  Moments moments;  ///< (·, 0): in for spokes with a given flux, out

  KOKKOS_FUNCTION void operator()(int p) const {
    const Patch P = patches.patch(p);
    if (P.given_last && !P.given_first) {
      for (int m = P.cells - 1; m >= 0; --m) moments(P.spoke + m, 0) = moments(P.spoke + m + 1, 0) - total(P.corner + m);
      return;
    }
    double through = P.given_first ? moments(P.spoke, 0) : 0;
    moments(P.spoke, 0) = through;
    for (int m = 0; m + 1 < P.spokes; ++m) {
      through += total(P.corner + m);
      moments(P.spoke + m + 1, 0) = through;
    }
  }
  /// The integral over the cell: that of phi_0 is 1/√2.
  KOKKOS_INLINE_FUNCTION double total(LocalIndex at) const {
    const int corner = patches.corner(at);
    return 0.70710678118654752440 * density(corner / 3, (corner % 3) * reference::dimension(Q));
  }
};

/// r(k, i tests + t) = -(v - psi_a w, test_t)_K, v the particular flux of corner i, bubbles eliminated.
template <int Q>
struct Residual {
  using T = PatchTables<Q>;
  CellForm<Q> form;
  Patches patches;
  PatchFlux::Data data;
  Moments moments;
  CellTable residual;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int k) const {
    double w[T::length];
    for (int l = 0; l < T::length; ++l) w[l] = -data.target(k, l);
    for (int i = 0; i < 3; ++i) {
      const LocalIndex before = patches.spoke(k, i, 0), after = patches.spoke(k, i, 1);
      if (before < 0) continue;
      double v[T::length] = {};
      for (int m = 0; m < T::density; ++m)
        for (int l = 0; l < T::density; ++l) {
          v[l] += w[m] * form.tables.hat(i, m, l);
          v[T::density + l] += w[T::density + m] * form.tables.hat(i, m, l);
        }
      for (int m = 1; m < T::density; ++m) {
        const double g = data.density(k, i * T::density + m);
        for (int l = 0; l < T::length; ++l) v[l] += g * form.tables.from_density(m, l);
      }
      add_spoke(before, (i + 2) % 3, false, v);
      add_spoke(after, (i + 1) % 3, true, v);
      double r[T::tests];
      form.test(k, i, v, r);
      for (int t = 0; t < T::tests; ++t) residual(k, i * T::tests + t) = -r[t];
    }
  }
  KOKKOS_INLINE_FUNCTION void add_spoke(LocalIndex s, int face, bool after, double* v) const {
    const int count = patches.given(s) ? Q + 1 : 1;
    for (int j = 0; j < count; ++j) {
      const double moment = after ? (j % 2 == 0 ? 1 : -1) * moments(s, j) : -moments(s, j);
      for (int l = 0; l < T::length; ++l) v[l] += moment * form.tables.face(face, j, l);
    }
  }
};

/// Solves on each patch; the moments of its spokes are complete then.
template <int Q>
struct SolvePatch {
  using T = PatchTables<Q>;
  Patches patches;
  View<double*> factor;
  CellTable residual;
  View<double*> unknowns;  ///< out, overwritten
  Moments moments;         ///< in: the particular flux; out

  KOKKOS_FUNCTION void operator()(int p) const {
    const Patch P = patches.patch(p);
    const int n = P.size(Q);
    double* const x = unknowns.data() + P.unknowns;
    for (int e = 0; e < n; ++e) x[e] = 0;
    for (int m = 0; m < P.cells; ++m) {
      const int corner = patches.corner(P.corner + m);
      const double* const r = &residual(corner / 3, (corner % 3) * T::tests);
      for (int t = 0; t < T::tests; ++t) {
        const int row = unknown<Q>(P, m, t);
        if (row >= 0) x[row] += r[t];
      }
    }
    solve_packed(n, factor.data() + P.factor, x);
    for (int s = 0; s < P.free; ++s)
      for (int j = 0; j < Q; ++j) moments(P.spoke + P.first_free + s, j + 1) = x[s * Q + j];
    if (n > Q * P.free)
      for (int s = 0; s < P.spokes; ++s) moments(P.spoke + s, 0) += x[n - 1];
  }
};

/// The sum of the fluxes of the three vertices, with the bubbles that make the norm of sum_a sigma_a - w = sum_a (sigma_a - psi_a w) least.
template <int Q>
struct Assemble {
  using T = PatchTables<Q>;
  CellForm<Q> form;
  Patches patches;
  PatchFlux::Data data;
  Moments moments;
  CellTable sigma;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int k) const {
    double c[T::given], v[T::flux] = {};
    for (int f = 0; f < 3; ++f) {
      const LocalIndex from_first = patches.spoke(k, (f + 1) % 3, 0), from_second = patches.spoke(k, (f + 2) % 3, 1);
      for (int j = 0; j <= Q; ++j) c[f * (Q + 1) + j] = (j % 2 == 0 ? 1 : -1) * moments(from_second, j) - moments(from_first, j);
    }
    for (int m = 1; m < T::density; ++m)
      c[3 * (Q + 1) + m - 1] = data.density(k, m) + data.density(k, T::density + m) + data.density(k, 2 * T::density + m);
    for (int e = 0; e < T::given; ++e)
      for (int l = 0; l < T::flux; ++l) v[l] += c[e] * form.tables.field(e, l);
    if constexpr (T::bubbles > 0) {
      double distance[T::length], y[T::stored_bubbles];
      for (int l = 0; l < T::density; ++l)
        for (int d = 0; d < 2; ++d) distance[d * T::density + l] = v[d * (T::flux / 2) + l] - data.target(k, d * T::density + l);
      form.nearest(k, distance, y);
      for (int m = 0; m < T::bubbles; ++m)
        for (int l = 0; l < T::flux; ++l) v[l] -= y[m] * form.tables.field(T::given + m, l);
    }
    for (int l = 0; l < T::flux; ++l) sigma(k, l) = v[l];
  }
};

}  // namespace thixis::equilibration
