#include "cell_form.hpp"

#include <vector>

#include "cells.hpp"
#include "thixis/method/cell_functions.hpp"
#include "thixis/method/gradient_form.hpp"

namespace thixis::hho {
namespace {

using Table = Kokkos::View<const double**, Kokkos::LayoutRight>;

constexpr int most_gradients = 10;  // dim P_3

/// Of the angle at vertex a, -2|K| grad(lambda_a+1)·grad(lambda_a+2).
KOKKOS_INLINE_FUNCTION double cotangent(const mesh::CellGeometry& K, int a) {
  const double* const b = K.gradient[(a + 1) % 3];
  const double* const c = K.gradient[(a + 2) % 3];
  return -2 * K.area * (b[0] * c[0] + b[1] * c[1]);
}

/// As sum_f grad(lambda_f) = 0, a_K = mu sum_a cot(angle_a) |(G_a+1 - G_a+2) v|² + mu sum_f kappa |F|/h |R_f v|².
struct ConstantTension {
  Cells cells;
  Table Q;  ///< (0 … 2, i n + j): the first three squares, (3 … 5, i n + j): the others
  double mu;
  LocalIndex first;
  method::LocalMatrices A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const mesh::CellGeometry K = cells.geometry(first + e);
    double sign[most_unknowns], cot[3], weight[3];
    cells.signs(first + e, sign);
    cells.stabilization(K, weight);
    for (int a = 0; a < 3; ++a) cot[a] = cotangent(K, a);
    const int n = A.extent_int(1);
    for (int i = 0; i < n; ++i) {
      double* __restrict__ row = &A(e, i, 0);
      const double* q[6];
      for (int a = 0; a < 6; ++a) q[a] = &Q(a, i * n);
      const double scale = mu * sign[i];
      for (int j = 0; j < n; ++j)
        row[j] = scale * sign[j] *
                 (cot[0] * q[0][j] + cot[1] * q[1][j] + cot[2] * q[2][j] + weight[0] * q[3][j] + weight[1] * q[4][j] + weight[2] * q[5][j]);
    }
  }
};

/// a_K = 2|K| sum_d (G^d v)·M (G^d v) + mu_K sum_f kappa |F|/h |R_f v|²,  G^d = sum_f dlambda_f/dx_d G_f,  M_kl = (mu B_k, B_l).
struct VaryingTension {
  Cells cells;
  method::CellQuadrature quadrature;
  View<const double*> mu;
  reference::Bernstein B;
  Table G;  ///< (f m + k, i)
  Table Q;  ///< (f, i n + j): squares of R_f
  LocalIndex first;
  method::LocalMatrices A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const LocalIndex k = first + e;
    const mesh::CellGeometry K = cells.geometry(k);
    double sign[most_unknowns], weight[3], M[most_gradients][most_gradients];
    cells.signs(k, sign);
    cells.stabilization(K, weight);
    const double mean = weighted_mass(k, M);
    const int n = A.extent_int(1), m = B.size;
    for (int i = 0; i < n; ++i)
      for (int j = i; j < n; ++j)
        A(e, i, j) = mean * (weight[0] * Q(0, i * n + j) + weight[1] * Q(1, i * n + j) + weight[2] * Q(2, i * n + j));
    double gradient[most_gradients][most_unknowns], moment[most_unknowns];
    for (int d = 0; d < 2; ++d) {
      for (int r = 0; r < m; ++r)
        for (int i = 0; i < n; ++i)
          gradient[r][i] = K.gradient[0][d] * G(r, i) + K.gradient[1][d] * G(m + r, i) + K.gradient[2][d] * G(2 * m + r, i);
      for (int r = 0; r < m; ++r) {
        for (int i = 0; i < n; ++i) moment[i] = 0;
        for (int s = 0; s < m; ++s)
          for (int i = 0; i < n; ++i) moment[i] += 2 * K.area * M[r][s] * gradient[s][i];
        for (int i = 0; i < n; ++i) {
          double* __restrict__ row = &A(e, i, 0);
          const double factor = gradient[r][i];
          for (int j = i; j < n; ++j) row[j] += factor * moment[j];
        }
      }
    }
    for (int i = 0; i < n; ++i)
      for (int j = i; j < n; ++j) A(e, j, i) = A(e, i, j) *= sign[i] * sign[j];
  }

  /// M on the reference cell; returns the mean of mu.
  KOKKOS_FUNCTION double weighted_mass(LocalIndex k, double (&M)[most_gradients][most_gradients]) const {
    const method::CellQuadrature& rule = quadrature;
    const LocalIndex own = rule.own_rule(k);
    const int m = B.size, points = static_cast<int>(rule.offset(k + 1) - rule.offset(k));
    for (int r = 0; r < m; ++r)
      for (int s = 0; s < m; ++s) M[r][s] = 0;
    double integral = 0, area = 0, value[reference::max_functions];
    for (int q = 0; q < points; ++q) {
      const GlobalIndex at = own < 0 ? q : rule.own_offset(own) + q;
      const double xi = own < 0 ? rule.rule_xi(at, 0) : rule.own_xi(at, 0), eta = own < 0 ? rule.rule_xi(at, 1) : rule.own_xi(at, 1);
      const double weight = own < 0 ? rule.rule_weight(at) : rule.own_weight(at), weighted = weight * mu(rule.offset(k) + q);
      const double lambda[3] = {1 - xi - eta, xi, eta};
      B.values(lambda, value);
      area += weight;
      integral += weighted;
      for (int r = 0; r < m; ++r)
        for (int s = 0; s < m; ++s) M[r][s] += weighted * value[r] * value[s];
    }
    return integral / area;
  }
};

/// += D^T M D for D with `rows` rows; M empty: the identity.
void add_square(const std::vector<double>& D, const std::vector<double>& M, int rows, int n, double* out) {
  for (int r = 0; r < rows; ++r)
    for (int s = 0; s < rows; ++s) {
      const double m = M.empty() ? static_cast<double>(r == s) : M[r * rows + s];
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) out[i * n + j] += m * D[r * n + i] * D[s * n + j];
    }
}

class ConstantForm final : public method::ElementForm {
 public:
  ConstantForm(const Cells& cells, const ReferenceCell& reference, double mu) : cells_(cells), mu_(mu) {
    const int n = reference.unknowns, m = reference.B.size;
    std::vector<double> Q(6 * n * n, 0.0);
    for (int a = 0; a < 3; ++a) {
      std::vector<double> difference(m * n);
      for (int ki = 0; ki < m * n; ++ki) difference[ki] = reference.G[(a + 1) % 3][ki] - reference.G[(a + 2) % 3][ki];
      add_square(difference, reference.mass, m, n, &Q[a * n * n]);
      add_square(reference.R[a], {}, reference.degree, n, &Q[(3 + a) * n * n]);
    }
    Q_ = method::matrix_view("thixis::hho::reference_squares", 6, n * n, Q);
  }
  void matrices(LocalIndex first, const method::LocalMatrices& A) const override {
    Kokkos::parallel_for("thixis::hho::cell_form", Kokkos::RangePolicy<>(0, A.extent_int(0)), ConstantTension{cells_, Q_, mu_, first, A});
  }

 private:
  Cells cells_;
  Table Q_;
  double mu_;
};

class VaryingForm final : public method::ElementForm {
 public:
  VaryingForm(const Cells& cells, const ReferenceCell& reference, const method::CellQuadrature& quadrature, const View<const double*>& mu)
      : cells_(cells), quadrature_(quadrature), mu_(mu), B_(reference.B) {
    const int n = reference.unknowns, m = B_.size;
    std::vector<double> G, Q(3 * n * n, 0.0);
    for (int f = 0; f < 3; ++f) {
      G.insert(G.end(), reference.G[f].begin(), reference.G[f].end());
      add_square(reference.R[f], {}, reference.degree, n, &Q[f * n * n]);
    }
    G_ = method::matrix_view("thixis::hho::reference_gradients", 3 * m, n, G);
    Q_ = method::matrix_view("thixis::hho::reference_squares", 3, n * n, Q);
  }
  void matrices(LocalIndex first, const method::LocalMatrices& A) const override {
    VaryingTension kernel;
    kernel.cells = cells_;
    kernel.quadrature = quadrature_;
    kernel.mu = mu_;
    kernel.B = B_;
    kernel.G = G_;
    kernel.Q = Q_;
    kernel.first = first;
    kernel.A = A;
    Kokkos::parallel_for("thixis::hho::cell_form_varying", Kokkos::RangePolicy<>(0, A.extent_int(0)), kernel);
  }

 private:
  Cells cells_;
  method::CellQuadrature quadrature_;
  View<const double*> mu_;
  reference::Bernstein B_;
  Table G_, Q_;
};

}  // namespace

std::shared_ptr<const method::ElementForm> cell_form(const mesh::Mesh& mesh, const method::CellQuadrature& quadrature,
                                                     const ReferenceCell& reference, const method::MethodParams& params,
                                                     const scene::Field& tension) {
  const Cells cells = cells_of(mesh, quadrature.cell, reference, params);
  if (const double* mu = tension.constant()) return std::make_shared<ConstantForm>(cells, reference, *mu);
  return std::make_shared<VaryingForm>(cells, reference, quadrature, method::tension_at_points(mesh, quadrature, tension));
}

}  // namespace thixis::hho
