#include "patch_saddle_point.hpp"

#include <cmath>
#include <stdexcept>

#include "thixis/reference/quadrature.hpp"

namespace thixis::equilibration {
namespace {

constexpr double corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};

/// Solves A x = b, flat, row by row; both are overwritten.
std::vector<double> solve(int n, std::vector<double>& A, std::vector<double>& b) {
  for (int c = 0; c < n; ++c) {
    int pivot = c;
    for (int r = c + 1; r < n; ++r)
      if (std::abs(A[r * n + c]) > std::abs(A[pivot * n + c])) pivot = r;
    if (std::abs(A[pivot * n + c]) < 1e-11) throw std::runtime_error("the saddle point problem of a patch is singular");
    for (int k = 0; k < n && pivot != c; ++k) std::swap(A[c * n + k], A[pivot * n + k]);
    std::swap(b[c], b[pivot]);
    for (int r = c + 1; r < n; ++r) {
      const double factor = A[r * n + c] / A[c * n + c];
      if (factor == 0) continue;
      for (int k = c; k < n; ++k) A[r * n + k] -= factor * A[c * n + k];
      b[r] -= factor * b[c];
    }
  }
  for (int r = n - 1; r >= 0; --r) {
    for (int k = r + 1; k < n; ++k) b[r] -= A[r * n + k] * b[k];
    b[r] /= A[r * n + r];
  }
  return b;
}

/// One linear condition on the coefficients of all cells.
struct Condition {
  std::vector<double> row;
  double value;
};

}  // namespace

std::vector<double> SaddlePoint::Affine::at(const double* xi) const {
  return {origin[0] + DF[0][0] * xi[0] + DF[0][1] * xi[1], origin[1] + DF[1][0] * xi[0] + DF[1][1] * xi[1]};
}

/// X^m Y^n e_d, m + n <= q, and (X, Y) X^m Y^n, m + n = q, in X = (x - centre)/h and Y alike.
std::vector<double> SaddlePoint::basis(const Affine& K, const std::vector<double>& x) const {
  const double X = (x[0] - K.centre[0]) / K.h, Y = (x[1] - K.centre[1]) / K.h;
  std::vector<double> values;
  for (int m = 0; m <= q_; ++m)
    for (int n = 0; m + n <= q_; ++n) {
      const double p = std::pow(X, m) * std::pow(Y, n);
      values.insert(values.end(), {p, 0, 0, p});
      if (m + n == q_) values.insert(values.end(), {X * p, Y * p});
    }
  return values;
}

std::vector<double> SaddlePoint::divergence(const Affine& K, const std::vector<double>& x) const {
  const double X = (x[0] - K.centre[0]) / K.h, Y = (x[1] - K.centre[1]) / K.h;
  std::vector<double> values;
  for (int m = 0; m <= q_; ++m)
    for (int n = 0; m + n <= q_; ++n) {
      values.push_back(m == 0 ? 0 : m * std::pow(X, m - 1) * std::pow(Y, n) / K.h);
      values.push_back(n == 0 ? 0 : n * std::pow(X, m) * std::pow(Y, n - 1) / K.h);
      if (m + n == q_) values.push_back((q_ + 2) * std::pow(X, m) * std::pow(Y, n) / K.h);
    }
  return values;
}

SaddlePoint::SaddlePoint(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, const std::vector<bool>& held, int q,
                         const PatchData& data, LocalIndex a)
    : q_(q), size_((q + 1) * (q + 3)) {
  const auto host = mesh::on_host(mesh);
  const int P = reference::dimension(q);
  const reference::Modal modal(q);
  std::vector<int> vertex;
  for (LocalIndex k = 0; k < cells.extent_int(0); ++k)
    for (int i = 0; i < 3; ++i)
      if (host.cell_vertices(cells(k), i) == a) around_.push_back(k), vertex.push_back(i);
  const int count = static_cast<int>(around_.size()), unknowns = count * size_;

  std::vector<double> mass(unknowns * unknowns, 0.0), rhs(unknowns, 0.0);
  std::vector<Condition> conditions;
  const auto rule = reference::triangle_quadrature(2 * q + 4);
  const auto phi = modal.values(rule.size(), rule.point.data());
  for (int m = 0; m < count; ++m) {
    const LocalIndex k = around_[m], K = cells(k);
    Affine map{};
    for (int d = 0; d < 2; ++d) {
      map.origin[d] = host.coordinates(host.cell_vertices(K, 0), d);
      for (int e = 0; e < 2; ++e) map.DF[d][e] = host.coordinates(host.cell_vertices(K, e + 1), d) - map.origin[d];
    }
    map.det = map.DF[0][0] * map.DF[1][1] - map.DF[0][1] * map.DF[1][0];
    for (int d = 0; d < 2; ++d) map.centre[d] = map.origin[d] + (map.DF[d][0] + map.DF[d][1]) / 3;
    map.h = std::sqrt(map.det) / 2;
    affine_.push_back(map);

    std::vector<Condition> balance(P, {std::vector<double>(unknowns, 0.0), 0.0});
    for (int l = 0; l < P; ++l) balance[l].value = data.density(k, vertex[m] * P + l);
    for (int p = 0; p < rule.size(); ++p) {
      const double* xi = &rule.point[2 * p];
      const double lambda[3] = {1 - xi[0] - xi[1], xi[0], xi[1]}, weight = rule.weight[p] * map.det;
      const auto v = basis(map, map.at(xi)), divergences = divergence(map, map.at(xi));
      double reference_target[2] = {0, 0}, target[2] = {0, 0};
      for (int d = 0; d < 2; ++d)
        for (int l = 0; l < P; ++l) reference_target[d] += data.target(k, d * P + l) * phi[p * P + l];
      for (int d = 0; d < 2; ++d)
        for (int e = 0; e < 2; ++e) target[d] += map.DF[d][e] * reference_target[e] / map.det;
      for (int r = 0; r < size_; ++r) {
        for (int s = 0; s < size_; ++s)
          mass[(m * size_ + r) * unknowns + m * size_ + s] += weight * (v[2 * r] * v[2 * s] + v[2 * r + 1] * v[2 * s + 1]);
        rhs[m * size_ + r] += weight * lambda[vertex[m]] * (v[2 * r] * target[0] + v[2 * r + 1] * target[1]);
        for (int l = 0; l < P; ++l) balance[l].row[m * size_ + r] += weight * divergences[r] * phi[p * P + l];
      }
    }
    conditions.insert(conditions.end(), balance.begin(), balance.end());
  }

  // outward flux of cell m through its face i, times L_j from end 0 to end 1 of the face
  const auto line = reference::line_quadrature(2 * q + 4);
  const auto add_outward = [&](int m, int i, int j, std::vector<double>& row) {
    const LocalIndex K = cells(around_[m]), F = host.cell_faces(K, i);
    const LocalIndex from = host.cell_vertices(K, (i + 1) % 3), to = host.cell_vertices(K, (i + 2) % 3);
    const double normal[2] = {host.coordinates(to, 1) - host.coordinates(from, 1), host.coordinates(from, 0) - host.coordinates(to, 0)};
    for (int p = 0; p < line.size(); ++p) {
      const double s = line.point[p], along = host.face_vertices(F, 0) == from ? s : 1 - s;
      double xi[2];
      for (int d = 0; d < 2; ++d) xi[d] = (1 - s) * corner[(i + 1) % 3][d] + s * corner[(i + 2) % 3][d];
      const auto v = basis(affine_[m], affine_[m].at(xi));
      const double L = reference::legendre(q_ + 1, along)[j];
      for (int r = 0; r < size_; ++r) row[m * size_ + r] += line.weight[p] * L * (v[2 * r] * normal[0] + v[2 * r + 1] * normal[1]);
    }
  };
  bool open = false;
  for (int m = 0; m < count; ++m)
    for (int i = 0; i < 3; ++i) {
      const LocalIndex K = cells(around_[m]), F = host.cell_faces(K, i);
      const bool spoke = host.face_vertices(F, 0) == a || host.face_vertices(F, 1) == a;
      int other = -1, other_face = 0;
      for (int n = 0; n < count; ++n)
        for (int e = 0; e < 3; ++e)
          if (n != m && host.cell_faces(cells(around_[n]), e) == F) other = n, other_face = e;
      if (spoke && other >= 0 && other < m) continue;
      if (spoke && other < 0 && held[host.face_tag(F)]) {
        open = true;
        continue;
      }
      const int end = host.face_vertices(F, 0) == a ? 0 : 1;
      for (int j = 0; j <= q; ++j) {
        Condition c{std::vector<double>(unknowns, 0.0), spoke && other < 0 ? data.traction(F, end * (q + 1) + j) : 0.0};
        add_outward(m, i, j, c.row);
        if (spoke && other >= 0) add_outward(other, other_face, j, c.row);
        conditions.push_back(c);
      }
    }
  if (!open) conditions.erase(conditions.begin());  // the total of the first cell follows from all other conditions

  const int size = unknowns + static_cast<int>(conditions.size());
  std::vector<double> A(size * size, 0.0);
  for (int r = 0; r < unknowns; ++r)
    for (int s = 0; s < unknowns; ++s) A[r * size + s] = mass[r * unknowns + s];
  for (int c = unknowns; c < size; ++c) {
    for (int r = 0; r < unknowns; ++r) A[r * size + c] = A[c * size + r] = conditions[c - unknowns].row[r];
    rhs.push_back(conditions[c - unknowns].value);
  }
  solution_ = solve(size, A, rhs);
}

std::vector<double> SaddlePoint::value(int m, const double* xi) const {
  const auto v = basis(affine_[m], affine_[m].at(xi));
  std::vector<double> sum(2, 0.0);
  for (int r = 0; r < size_; ++r)
    for (int d = 0; d < 2; ++d) sum[d] += solution_[m * size_ + r] * v[2 * r + d];
  return sum;
}

}  // namespace thixis::equilibration
