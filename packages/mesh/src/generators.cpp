#include <algorithm>
#include <cmath>

#include "triangulation.hpp"

namespace thixis::mesh {
namespace {

/// nx x ny equal squares.
struct Squares {
  std::array<double, 2> lower, upper;
  LocalIndex nx, ny;

  LocalIndex corner(LocalIndex i, LocalIndex j) const { return j * (nx + 1) + i; }
  LocalIndex centre(LocalIndex i, LocalIndex j) const { return (nx + 1) * (ny + 1) + j * nx + i; }
  /// The point at (i, j) in units of squares, exact at the corners of the rectangle.
  std::array<double, 2> point(double i, double j) const {
    return {(lower[0] * (nx - i) + upper[0] * i) / nx, (lower[1] * (ny - j) + upper[1] * j) / ny};
  }
};

Squares squares(const MeshParams& params) {
  const double width = params.upper[0] - params.lower[0], height = params.upper[1] - params.lower[1];
  const LocalIndex n = params.cells_per_side;
  const auto m = static_cast<LocalIndex>(std::lround(n * std::max(width, height) / std::min(width, height)));
  return {{params.lower[0], params.lower[1]}, {params.upper[0], params.upper[1]}, width < height ? n : m, width < height ? m : n};
}

void add_sides(const Squares& s, Triangulation& mesh) {
  mesh.tags = {"left", "right", "bottom", "top"};
  for (LocalIndex j = 0; j < s.ny; ++j) {
    mesh.boundary.push_back({s.corner(0, j), s.corner(0, j + 1), 0});
    mesh.boundary.push_back({s.corner(s.nx, j), s.corner(s.nx, j + 1), 1});
  }
  for (LocalIndex i = 0; i < s.nx; ++i) {
    mesh.boundary.push_back({s.corner(i, 0), s.corner(i + 1, 0), 2});
    mesh.boundary.push_back({s.corner(i, s.ny), s.corner(i + 1, s.ny), 3});
  }
}

}  // namespace

Triangulation rectangle_mesh(const MeshParams& params) {
  const Squares s = squares(params);
  const bool both_diagonals = params.generator == Generator::criss_cross;
  Triangulation mesh;
  mesh.refinement = both_diagonals ? Refinement::bisection : Refinement::red;
  for (LocalIndex j = 0; j <= s.ny; ++j)
    for (LocalIndex i = 0; i <= s.nx; ++i) mesh.points.push_back(s.point(i, j));
  if (both_diagonals)
    for (LocalIndex j = 0; j < s.ny; ++j)
      for (LocalIndex i = 0; i < s.nx; ++i) mesh.points.push_back(s.point(i + 0.5, j + 0.5));

  for (LocalIndex j = 0; j < s.ny; ++j)
    for (LocalIndex i = 0; i < s.nx; ++i) {
      const LocalIndex a = s.corner(i, j), b = s.corner(i + 1, j), c = s.corner(i + 1, j + 1), d = s.corner(i, j + 1);
      if (both_diagonals) {
        const LocalIndex m = s.centre(i, j);
        mesh.cells.insert(mesh.cells.end(), {{m, a, b}, {m, b, c}, {m, c, d}, {m, d, a}});
      } else {
        mesh.cells.insert(mesh.cells.end(), {{a, b, c}, {a, c, d}});
      }
    }
  add_sides(s, mesh);
  return mesh;
}

Triangulation disk_mesh(const MeshParams& params) {
  const LocalIndex N = params.rings;
  const auto first = [](LocalIndex k) { return k == 0 ? 0 : 1 + 3 * k * (k - 1); };  // of ring k
  const auto vertex = [&](LocalIndex k, LocalIndex j) { return k == 0 ? 0 : first(k) + j % (6 * k); };

  const double h = std::sqrt(0.75);
  const double corner[7][2] = {{1, 0}, {0.5, h}, {-0.5, h}, {-1, 0}, {-0.5, -h}, {0.5, -h}, {1, 0}};
  Triangulation mesh;
  mesh.chart = Chart::disk;
  mesh.points.push_back({0, 0});
  for (LocalIndex k = 1; k <= N; ++k)
    for (LocalIndex s = 0; s < 6; ++s)
      for (LocalIndex j = 0; j < k; ++j)
        mesh.points.push_back({((k - j) * corner[s][0] + j * corner[s + 1][0]) / N, ((k - j) * corner[s][1] + j * corner[s + 1][1]) / N});

  for (LocalIndex k = 0; k < N; ++k)  // between rings k and k + 1
    for (LocalIndex s = 0; s < 6; ++s) {
      const LocalIndex in = s * k, out = s * (k + 1);
      for (LocalIndex j = 0; j <= k; ++j) mesh.cells.push_back({vertex(k, in + j), vertex(k + 1, out + j), vertex(k + 1, out + j + 1)});
      for (LocalIndex j = 0; j < k; ++j) mesh.cells.push_back({vertex(k, in + j), vertex(k + 1, out + j + 1), vertex(k, in + j + 1)});
    }
  mesh.tags = {"circle"};
  for (LocalIndex j = 0; j < 6 * N; ++j) mesh.boundary.push_back({vertex(N, j), vertex(N, j + 1), 0});
  return mesh;
}

}  // namespace thixis::mesh
