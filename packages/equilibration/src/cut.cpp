#include "thixis/equilibration/cut.hpp"

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "thixis/core/assert.hpp"
#include "thixis/reference/cell_basis.hpp"

namespace thixis::equilibration {
namespace {

using Point = std::array<double, 2>;
using Dense = std::vector<double>;

/// The affine map from the reference triangle to a child in its parent.
struct Child {
  Point corner[3];
  double A[2][2], det;

  explicit Child(const mesh::Corners& corners) {
    for (int i = 0; i < 3; ++i) corner[i] = {corners[i][1], corners[i][2]};
    for (int d = 0; d < 2; ++d)
      for (int i = 0; i < 2; ++i) A[d][i] = corner[i + 1][d] - corner[0][d];
    det = A[0][0] * A[1][1] - A[0][1] * A[1][0];
  }
};

bool same(Point a, Point b) { return std::hypot(a[0] - b[0], a[1] - b[1]) < 1e-12; }

/// Fields that span RT_q on the reference triangle, with their normal moments and divergences.
struct Fields {
  std::vector<Dense> field;
  int faces;      ///< the first ones: (i, j) -> i (q + 1) + j
  int densities;  ///< the next ones have divergence phi_1, phi_2, …

  explicit Fields(int q) : faces(3 * (q + 1)), densities(reference::dimension(q) - 1) {
    const reference::RaviartThomas rt(q);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= q; ++j) field.push_back(rt.from_face(i, j));
    for (int k = 1; k <= densities; ++k) field.push_back(rt.from_density(k));
    for (int b = 0; b < rt.bubbles(); ++b) field.push_back(rt.bubble(b));
  }
  int size() const { return static_cast<int>(field.size()); }
};

/// The product of A (rows × inner) and B (inner × columns).
Dense product(int rows, int inner, int columns, const Dense& A, const Dense& B) {
  Dense C(rows * columns, 0.0);
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < inner; ++k)
      if (const double a = A[i * inner + k]; a != 0)
        for (int j = 0; j < columns; ++j) C[i * columns + j] += a * B[k * columns + j];
  return C;
}
Dense transposed(int rows, int columns, const Dense& A) {
  Dense T(rows * columns);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) T[j * rows + i] = A[i * columns + j];
  return T;
}

/// Energies of the fields in a child, sum_ij G_ij (v_i, w_j), measured in the parent.
Dense energies(const Fields& fields, const Child& child) {
  double G[2][2];
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) G[i][j] = (child.A[0][i] * child.A[0][j] + child.A[1][i] * child.A[1][j]) / child.det;
  const int n = fields.size(), m = static_cast<int>(fields.field[0].size()) / 2;
  Dense M(n * n, 0.0);
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          for (int k = 0; k < m; ++k) M[a * n + b] += G[i][j] * fields.field[a][i * m + k] * fields.field[b][j * m + k];
  return M;
}

/// Constraints of fluxes x = (x_child) within the cell: rows of C x = B d. One per normal moment of a face of the parent's boundary (0), or
/// inside (what leaves one child enters the other); one per coefficient of the divergence, but for the mean in the last child, which
/// follows from the others.
struct Constraints {
  Dense C, B;
  int count = 0;

  Constraints(const std::vector<Child>& children, const Fields& fields, int q) {
    const int c = static_cast<int>(children.size()), n = reference::dimension(q), width = fields.size();
    const auto row = [&] {
      C.resize(C.size() + c * width, 0.0);
      B.resize(B.size() + c * n, 0.0);
      return count++;
    };
    for (int a = 0; a < c; ++a)
      for (int f = 0; f < 3; ++f) {
        int other = -1, other_face = -1;
        for (int b = 0; b < c; ++b)
          for (int g = 0; g < 3; ++g)
            if (b != a && same(children[a].corner[(f + 1) % 3], children[b].corner[(g + 2) % 3]) &&
                same(children[a].corner[(f + 2) % 3], children[b].corner[(g + 1) % 3])) {
              other = b;
              other_face = g;
            }
        if (other >= 0 && other < a) continue;
        for (int j = 0; j <= q; ++j) {
          const int r = row();
          C[r * c * width + a * width + f * (q + 1) + j] = 1;
          if (other >= 0) C[r * c * width + other * width + other_face * (q + 1) + j] = j % 2 == 0 ? 1 : -1;
        }
      }
    for (int a = 0; a < c; ++a)
      for (int k = a + 1 < c ? 0 : 1; k < n; ++k) {
        const int r = row();
        if (k == 0)
          for (int f = 0; f < 3; ++f) C[r * c * width + a * width + f * (q + 1)] = std::sqrt(2.0);
        else C[r * c * width + a * width + fields.faces + k - 1] = 1;
        B[r * c * n + a * n + k] = 1;
      }
  }
};

/// x = M^{-1} C^T (C M^{-1} C^T)^{-1} B d: the smallest flux.
Dense smallest_fluxes(const std::vector<Child>& children, int q) {
  const Fields fields(q);
  const Constraints constraints(children, fields, q);
  const int c = static_cast<int>(children.size()), n = reference::dimension(q), width = fields.size(), all = c * width;
  const int count = constraints.count, flux = 2 * reference::dimension(q + 1);
  Dense M_inverse(all * all, 0.0);
  for (int a = 0; a < c; ++a) {
    const Dense block = reference::inverse(width, energies(fields, children[a]));
    for (int i = 0; i < width; ++i)
      for (int j = 0; j < width; ++j) M_inverse[(a * width + i) * all + a * width + j] = block[i * width + j];
  }
  const Dense step = product(all, all, count, M_inverse, transposed(count, all, constraints.C));
  const Dense gram = product(count, all, count, constraints.C, step);
  const Dense x = product(all, count, c * n, step, product(count, count, c * n, reference::inverse(count, gram), constraints.B));
  Dense lift(c * flux * c * n, 0.0);
  for (int a = 0; a < c; ++a)
    for (int i = 0; i < width; ++i)
      for (int k = 0; k < flux; ++k)
        for (int d = 0; d < c * n; ++d) lift[(a * flux + k) * c * n + d] += fields.field[i][k] * x[(a * width + i) * c * n + d];
  return lift;
}

Cut make_cut(const std::vector<mesh::ChildShape>& shapes, int q) {
  const reference::Modal densities(q), fluxes(q + 1);
  const int c = static_cast<int>(shapes.size()), n = densities.size(), m = fluxes.size();
  std::vector<Child> children;
  for (const auto shape : shapes) children.emplace_back(mesh::child_shapes()[shape]);

  Cut cut;
  cut.children = c;
  cut.sum.assign(n * c * n, 0.0);
  cut.share.assign(c * n * n, 0.0);
  cut.restrict.assign(c * 2 * m * 2 * m, 0.0);
  for (int a = 0; a < c; ++a) {
    const auto& part = mesh::child_shapes()[shapes[a]];
    const auto R = densities.restriction(part), R_flux = fluxes.restriction(part);
    const auto& A = children[a].A;
    for (int l = 0; l < n; ++l)
      for (int k = 0; k < n; ++k) {
        cut.sum[k * c * n + a * n + l] = R[l * n + k];
        cut.share[(a * n + l) * n + k] = children[a].det * R[l * n + k];
      }
    const double B[2][2] = {{A[1][1], -A[0][1]}, {-A[1][0], A[0][0]}};  // det A^{-1}
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        for (int l = 0; l < m; ++l)
          for (int k = 0; k < m; ++k) cut.restrict[(a * 2 * m + i * m + l) * 2 * m + j * m + k] = B[i][j] * R_flux[l * m + k];
  }
  if (c > 1) cut.lift = smallest_fluxes(children, q);
  return cut;
}

}  // namespace

const Cut& cut(const std::vector<mesh::ChildShape>& shapes, int q) {
  static std::map<std::pair<int, std::vector<mesh::ChildShape>>, Cut> known;
  const auto key = std::pair(q, shapes);
  const auto found = known.find(key);
  return found != known.end() ? found->second : known.emplace(key, make_cut(shapes, q)).first->second;
}

}  // namespace thixis::equilibration
