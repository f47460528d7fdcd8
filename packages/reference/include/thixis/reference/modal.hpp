#pragma once
#include <array>
#include <vector>

namespace thixis::reference {

/// Barycentric coordinates of the vertices of a part of a triangle: part[i][a] of its vertex i.
using Part = std::array<std::array<double, 3>, 3>;

/// dim P_k.
constexpr int dimension(int degree) { return (degree + 1) * (degree + 2) / 2; }

/// Orthonormal polynomials phi_0, phi_1, … on the reference triangle {(0,0),(1,0),(0,1)}, ∫ phi_k phi_l = delta_kl, phi_0 = √2; the first
/// dim P_j of them span P_j for every j. A function is its vector of **modal coefficients**: the one of its projection on P_j are
/// the first dim P_j. Matrices are flat, row by row; each takes coefficients (columns) to coefficients (rows).
///
/// What cells of a mesh are made of, in reference coordinates x = F(xi), det = det DF = 2|K|:
///
///   density  g on K:  ĝ = det g∘F, so that ∫_K g = ∫ ĝ;   moments (g, q∘F^{-1})_K = ∫ ĝ q;
///   flux     v on K:  v̂ = det DF^{-1} v∘F (Piola), so that div v̂ is the density of div v and ∫_F v·n = ∫ of the reference face;
///            flat [2][dim P_k]: the coefficients of both components;
///   ∫_K v·w = sum_ij G_ij ∫ v̂_i ŵ_j,   G = DF^T DF / det.
class Modal {
 public:
  /// Tables for polynomials of degree up to `degree` <= 6.
  explicit Modal(int degree);

  int degree() const { return degree_; }
  int size() const { return dimension(degree_); }

  /// phi_k at points flat [count][2]: flat [count][size].
  std::vector<double> values(int count, const double* points) const;
  /// (size × size) d/dxi (0), d/deta (1).
  const std::vector<double>& derivative(int direction) const { return derivative_[direction]; }
  /// (size × size) u -> lambda_a u, a = 0, 1, 2, what lies beyond `degree` cut off: exact for u of degree < degree().
  const std::vector<double>& times_barycentric(int a) const { return barycentric_[a]; }
  /// (size × size) u on a triangle -> the same polynomial on a part of it, in the part's own reference coordinates.
  std::vector<double> restriction(const Part& part) const;
  /// (count × size) Legendre moments on face i (opposite vertex i) from vertex i+1 to i+2: ∫_0^1 u(s) L_j(s) ds, L_j orthonormal on [0,1].
  std::vector<double> trace(int face, int count) const;

 private:
  int degree_;
  std::vector<double> derivative_[2], barycentric_[3];
};

/// Normals of the reference faces times their lengths: ∫ over face i of v̂·n = ∫_0^1 v̂·face_normal[i] ds.
constexpr double face_normal[3][2] = {{1, 1}, {-1, 0}, {0, -1}};

/// L_0 … L_count-1 at s: Legendre polynomials orthonormal on [0,1]. L_j(1-s) = (-1)^j L_j(s).
std::vector<double> legendre(int count, double s);

/// The Raviart–Thomas fields RT_q of the reference triangle, as fluxes [2][dim P_{q+1}] in modal coefficients, with given data:
///
///     from_face(i, j):  normal flux L_j on face i (from vertex i+1 to i+2, outward), 0 on the others; divergence constant, ∫ = delta_j0;
///                       orthogonal to all curls of RT_q bubbles: the field of least norm with these data,
///     from_density(k):  normal flux 0 everywhere, divergence phi_k, 1 <= k < dim P_q; the field of least norm,
///     bubble(m):        an orthonormal basis of the divergence-free fields of RT_q without normal flux: curls of lambda_0 lambda_1
///     lambda_2
///                       P_{q-2}; dim P_{q-2} of them.
///
/// Norms are those of the reference triangle. Every RT_q field is a unique combination of these.
class RaviartThomas {
 public:
  explicit RaviartThomas(int q);
  int q() const { return q_; }
  int flux_size() const { return 2 * dimension(q_ + 1); }
  /// Flat [flux_size].
  const std::vector<double>& from_face(int i, int j) const { return face_[i * (q_ + 1) + j]; }
  const std::vector<double>& from_density(int k) const { return density_[k]; }
  const std::vector<double>& bubble(int m) const { return bubble_[m]; }
  int bubbles() const { return static_cast<int>(bubble_.size()); }

 private:
  int q_;
  std::vector<std::vector<double>> face_, density_, bubble_;
};

}  // namespace thixis::reference
