#pragma once
#include "thixis/method/cell_functions.hpp"
#include "thixis/method/form.hpp"

namespace thixis::fem {

/// Products of the reference derivatives, integrated over the reference triangle: (i n + j, 2 a + b): ∫ ∂_a psi_i ∂_b psi_j.
using ReferenceProducts = Kokkos::View<const double* [4], Kokkos::LayoutRight>;

/// With G_ab(l, m) = ∫_K w ∂_a psi_l ∂_b psi_m, w = mu or lambda, function l in the direction i against m in the direction j is
///
///     mu (delta_ij (G_00 + G_11) + G_ji) + lambda G_ij,
///
/// since 2 eps(u):eps(v) = grad u:grad v + grad uᵀ:grad v.
KOKKOS_INLINE_FUNCTION void add_elasticity(const double (&G)[2][2], double mu, double lambda, const method::LocalMatrices& A, int e, int l,
                                           int m) {
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) A(e, 2 * l + i, 2 * m + j) += mu * ((i == j ? G[0][0] + G[1][1] : 0) + G[j][i]) + lambda * G[i][j];
}

struct ConstantElasticity {
  mesh::View<double* [2]> x;
  mesh::View<LocalIndex* [3]> vertices;
  mesh::View<const LocalIndex*> cells;
  ReferenceProducts Q;
  int functions;
  double mu, lambda;
  LocalIndex first;
  method::LocalMatrices A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const mesh::CellGeometry K = mesh::cell_geometry(x, vertices, cells(first + e));
    for (int l = 0; l < functions; ++l)
      for (int m = 0; m < functions; ++m) {
        double G[2][2] = {};
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2; ++j) {
            for (int a = 0; a < 2; ++a)
              for (int b = 0; b < 2; ++b) G[i][j] += K.gradient[a + 1][i] * K.gradient[b + 1][j] * Q(l * functions + m, 2 * a + b);
            G[i][j] *= 2 * K.area;
            A(e, 2 * l + i, 2 * m + j) = 0;
          }
        add_elasticity(G, mu, lambda, A, e, l, m);
      }
  }
};

struct VaryingElasticity {
  method::CellQuadrature quadrature;
  method::CellFunctions functions;
  mesh::View<const double*> mu, lambda;  ///< at all points of the quadrature
  LocalIndex first;
  method::LocalMatrices A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const method::CellQuadrature& Q = quadrature;
    const LocalIndex k = first + e, rule = Q.own_rule(k);
    const mesh::CellGeometry K = mesh::cell_geometry(Q.coordinates, Q.cell_vertices, Q.cell(k));
    const int n = functions.size(), points = static_cast<int>(Q.offset(k + 1) - Q.offset(k));
    for (int i = 0; i < 2 * n; ++i)
      for (int j = 0; j < 2 * n; ++j) A(e, i, j) = 0;
    for (int q = 0; q < points; ++q) {
      const GlobalIndex at = rule < 0 ? q : Q.own_offset(rule) + q;
      const double xi = rule < 0 ? Q.rule_xi(at, 0) : Q.own_xi(at, 0), eta = rule < 0 ? Q.rule_xi(at, 1) : Q.own_xi(at, 1);
      const double weight = 2 * K.area * (rule < 0 ? Q.rule_weight(at) : Q.own_weight(at));
      const double barycentric[3] = {1 - xi - eta, xi, eta};
      double g[reference::max_functions][2];
      functions.gradients(K, barycentric, g);
      for (int l = 0; l < n; ++l)
        for (int m = 0; m < n; ++m) {
          double G[2][2];
          for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j) G[i][j] = weight * g[l][i] * g[m][j];
          add_elasticity(G, mu(Q.offset(k) + q), lambda(Q.offset(k) + q), A, e, l, m);
        }
    }
  }
};

/// Sum over cells of a block of ∫_K 2 mu |eps(u - u_h)|² + lambda |div(u - u_h)|².
struct ElasticEnergy {
  method::CellFunctions functions;
  mesh::View<double* [2]> x;
  mesh::View<LocalIndex* [3]> vertices;
  method::QuadratureBlock block;
  mesh::View<const double*> mu, lambda;
  mesh::View<const double* [2][2]> gradient;  ///< (q, i, d): of a known u; of length 0: none
  method::ElementEntries entries;
  method::Coefficients uh;

  KOKKOS_FUNCTION void operator()(int e, double& sum) const {
    const int n = functions.size();
    const mesh::CellGeometry K = mesh::cell_geometry(x, vertices, block.cell(e));
    double local[reference::max_functions], c[2][reference::max_functions];
    for (int i = 0; i < 2; ++i) {
      for (int l = 0; l < n; ++l) local[l] = uh(entries(block.first + e, 2 * l + i));
      functions.to_bernstein(local, c[i]);
    }
    for (int q = block.offset(e); q < block.offset(e + 1); ++q) {
      const double xi = block.xi(q, 0), eta = block.xi(q, 1), barycentric[3] = {1 - xi - eta, xi, eta};
      double D[2][2];
      for (int i = 0; i < 2; ++i) {
        double slope[3];
        functions.B.gradient(c[i], barycentric, slope);
        for (int d = 0; d < 2; ++d) {
          D[i][d] = gradient.extent(0) > 0 ? -gradient(q, i, d) : 0;
          for (int a = 0; a < 3; ++a) D[i][d] += slope[a] * K.gradient[a][d];
        }
      }
      const double shear = 0.5 * (D[0][1] + D[1][0]), divergence = D[0][0] + D[1][1];
      const double strain = D[0][0] * D[0][0] + D[1][1] * D[1][1] + 2 * shear * shear;
      sum += block.weight(q) * (2 * mu(q) * strain + lambda(q) * divergence * divergence);
    }
  }
};

}  // namespace thixis::fem
