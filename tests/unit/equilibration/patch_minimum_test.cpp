/// PatchFlux against the mixed saddle point problem that defines its fluxes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "patch_saddle_point.hpp"
#include "thixis/method/quadrature.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::equilibration {
namespace {

/// A mesh whole on every rank: patches of any kind, some of one cell.
class PatchMinimum : public testing::TestWithParam<std::tuple<std::string, Held, int>> {
 protected:
  mesh::Hierarchy levels = hierarchy(std::get<0>(GetParam()), 0, core::Comm(MPI_COMM_SELF));
  const mesh::Mesh& mesh = levels.finest();
  const mesh::HostMesh host = mesh::on_host(mesh);
  const int q = std::get<2>(GetParam()), n = reference::dimension(q), N = reference::dimension(q + 1);
  const View<const LocalIndex*> cells = method::patch_cells(mesh);
  const std::vector<bool> held = held_tags(mesh, std::get<1>(GetParam()));
  const reference::Quadrature rule = reference::triangle_quadrature(2 * q + 2);
  const PatchFlux flux{mesh, cells, held, q};

  CellTable sigma(const PatchData& data) const {
    const CellTable sum("sigma", mesh.owned_cells, 2 * N);
    flux(data.data(), sum);
    return sum;
  }

  /// Values of a flux on a cell at the points of the rule, physical.
  std::vector<double> values(const CellTable& sigma, LocalIndex K) const {
    const auto phi = reference::Modal(q + 1).values(rule.size(), rule.point.data());
    double DF[2][2];
    for (int d = 0; d < 2; ++d)
      for (int e = 0; e < 2; ++e)
        DF[d][e] = host.coordinates(host.cell_vertices(K, e + 1), d) - host.coordinates(host.cell_vertices(K, 0), d);
    const double det = DF[0][0] * DF[1][1] - DF[0][1] * DF[1][0];
    std::vector<double> v(2 * rule.size(), 0.0);
    for (int p = 0; p < rule.size(); ++p)
      for (int l = 0; l < N; ++l)
        for (int d = 0; d < 2; ++d) v[2 * p + d] += (DF[d][0] * sigma(K, l) + DF[d][1] * sigma(K, N + l)) * phi[p * N + l] / det;
    return v;
  }
  std::vector<double> values(const SaddlePoint& patch, int m) const {
    std::vector<double> v;
    for (int p = 0; p < rule.size(); ++p)
      for (const double x : patch.value(m, &rule.point[2 * p])) v.push_back(x);
    return v;
  }

  static double norm(const std::vector<double>& v) {
    double sum = 0;
    for (const double x : v) sum += x * x;
    return std::sqrt(sum);
  }
  static void add(double factor, const std::vector<double>& w, std::vector<double>& v) {
    for (std::size_t e = 0; e < v.size(); ++e) v[e] += factor * w[e];
  }

  /// The data of vertex a alone, w = 0: the sum of all fluxes is sigma_a.
  PatchData alone(const PatchData& all, LocalIndex a) const {
    const PatchData one = {CellTable("density", cells.extent(0), 3 * n), CellTable("target", cells.extent(0), 2 * n),
                           CellTable("traction", mesh.faces, 2 * (q + 1))};
    for (LocalIndex k = 0; k < cells.extent_int(0); ++k)
      for (int i = 0; i < 3; ++i)
        for (int m = 0; m < n && host.cell_vertices(cells(k), i) == a; ++m) one.density(k, i * n + m) = all.density(k, i * n + m);
    for (LocalIndex F = 0; F < mesh.faces; ++F)
      for (int end = 0; end < 2; ++end)
        for (int j = 0; j <= q && host.face_vertices(F, end) == a; ++j)
          one.traction(F, end * (q + 1) + j) = all.traction(F, end * (q + 1) + j);
    return one;
  }
};

TEST_P(PatchMinimum, of_one_vertex_solves_the_saddle_point_problem_of_its_patch) {
  const auto data = random_data(mesh, cells, held, q);
  std::multiset<std::pair<int, int>> seen;  // cells around, faces of the boundary: two patches of each kind
  for (LocalIndex a = 0; a < mesh.vertices; ++a) {
    int boundary = 0, around = 0;
    for (LocalIndex F = 0; F < mesh.faces; ++F)
      if (host.face_tag(F) >= 0 && (host.face_vertices(F, 0) == a || host.face_vertices(F, 1) == a))
        boundary += held[host.face_tag(F)] ? 1 : 4;
    for (LocalIndex k = 0; k < cells.extent_int(0); ++k)
      for (int i = 0; i < 3; ++i) around += host.cell_vertices(cells(k), i) == a ? 1 : 0;
    if (seen.count({around, boundary}) >= 2) continue;
    seen.insert({around, boundary});

    const auto one = alone(data, a);
    const SaddlePoint expected(mesh, cells, held, q, one, a);
    const auto sum = sigma(one);
    double size = 0, error = 0;
    for (std::size_t m = 0; m < expected.around().size(); ++m) {
      auto difference = values(sum, cells(expected.around()[m]));
      size += norm(difference);
      add(-1, values(expected, static_cast<int>(m)), difference);
      error += norm(difference);
    }
    EXPECT_LT(error, 1e-9 * size) << "vertex " << a << ", " << around << " cells";
    double elsewhere = 0;
    for (LocalIndex k = 0; k < cells.extent_int(0); ++k)
      if (std::count(expected.around().begin(), expected.around().end(), k) == 0) elsewhere += norm(values(sum, cells(k)));
    EXPECT_LT(elsewhere, 1e-12 * size);
  }
}

TEST_P(PatchMinimum, on_a_cell_is_the_sum_of_those_of_its_vertices) {
  const int step = std::get<0>(GetParam()) == "wheel" ? 50 : 5;
  const auto data = random_data(mesh, cells, held, q);
  const auto sum = sigma(data);
  for (LocalIndex k = 0; k < cells.extent_int(0); k += step) {
    auto difference = values(sum, cells(k));
    const double size = norm(difference);
    for (int i = 0; i < 3; ++i) {
      const SaddlePoint patch(mesh, cells, held, q, data, host.cell_vertices(cells(k), i));
      const auto m = std::find(patch.around().begin(), patch.around().end(), k) - patch.around().begin();
      add(-1, values(patch, static_cast<int>(m)), difference);
    }
    EXPECT_LT(norm(difference), 1e-9 * size) << "cell " << cells(k);
  }
}

std::string setting(const testing::TestParamInfo<std::tuple<std::string, Held, int>>& test) {
  std::string name = std::get<0>(test.param);
  name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
  const std::string parts[] = {"all", "none", "some"};
  return name + "_" + parts[static_cast<int>(std::get<1>(test.param))] + "_RT" + std::to_string(std::get<2>(test.param));
}

INSTANTIATE_TEST_SUITE_P(Degrees, PatchMinimum,
                         testing::Combine(testing::Values("rectangle", "disk", "file"), testing::Values(Held::all, Held::none, Held::some),
                                          testing::Values(0, 1, 2, 3, 4)),
                         setting);
INSTANTIATE_TEST_SUITE_P(ManyCells, PatchMinimum,
                         testing::Combine(testing::Values("wheel"), testing::Values(Held::all), testing::Values(1)), setting);

}  // namespace
}  // namespace thixis::equilibration
