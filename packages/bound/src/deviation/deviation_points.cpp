#include "deviation/deviation_points.hpp"

#include <algorithm>
#include <cmath>

namespace thixis::bound {

method::CellQuadrature subset(const method::CellQuadrature& all, const std::vector<LocalIndex>& positions) {
  const LocalIndex count = static_cast<LocalIndex>(positions.size());
  const View<LocalIndex*> cell("thixis::bound::subset_cell", count), own_rule("thixis::bound::subset_rule", count);
  const View<GlobalIndex*> offset("thixis::bound::subset_offset", count + 1);
  for (LocalIndex k = 0; k < count; ++k) {
    cell(k) = all.cell(positions[k]);
    own_rule(k) = all.own_rule(positions[k]);
    offset(k + 1) = offset(k) + all.offset(positions[k] + 1) - all.offset(positions[k]);
  }
  method::CellQuadrature some = all;
  some.cell = cell;
  some.own_rule = own_rule;
  some.offset = offset;
  some.largest_block = 0;
  for (LocalIndex first = 0; first < count; first += some.block_cells)
    some.largest_block = std::max(some.largest_block, static_cast<int>(offset(std::min(first + some.block_cells, count)) - offset(first)));
  return some;
}

method::CellQuadrature composite(method::CellQuadrature quadrature, int sides) {
  const int points = quadrature.rule_weight.extent_int(0), parts = sides * sides;
  const View<double* [2]> xi("thixis::bound::composite_xi", parts * points);
  const View<double*> weight("thixis::bound::composite_weight", parts * points);
  int at = 0;
  const auto add = [&](double origin_xi, double origin_eta, double scale) {
    for (int q = 0; q < points; ++q, ++at) {
      xi(at, 0) = origin_xi + scale * quadrature.rule_xi(q, 0);
      xi(at, 1) = origin_eta + scale * quadrature.rule_xi(q, 1);
      weight(at) = quadrature.rule_weight(q) / parts;
    }
  };
  const double h = 1.0 / sides;
  for (int i = 0; i < sides; ++i)
    for (int j = 0; i + j < sides; ++j) {
      add(i * h, j * h, h);
      if (i + j + 1 < sides) add((i + 1) * h, (j + 1) * h, -h);
    }
  const View<GlobalIndex*> offset("thixis::bound::composite_offset", quadrature.cells() + 1);
  for (LocalIndex k = 0; k <= quadrature.cells(); ++k) offset(k) = static_cast<GlobalIndex>(k) * parts * points;
  quadrature.rule_xi = xi;
  quadrature.rule_weight = weight;
  quadrature.offset = offset;
  quadrature.largest_block *= parts;
  return quadrature;
}

View<double* [2]> face_points() {
  const View<double* [2]> xi("thixis::bound::face_points", 3 * points_of_face);
  for (int i = 0; i < 3; ++i)
    for (int m = 0; m < points_of_face; ++m) {
      double lambda[3] = {0, 0, 0};
      lambda[(i + 1) % 3] = 1 - (m + 0.5) / points_of_face;
      lambda[(i + 2) % 3] = (m + 0.5) / points_of_face;
      for (int d = 0; d < 2; ++d) xi(i * points_of_face + m, d) = lambda[1 + d];
    }
  return xi;
}

void mark_held(const mesh::HostMesh& host, const std::vector<bool>& dirichlet, LocalIndex K, const double* D, double noise,
               const View<bool* [3]>& on_held, LocalIndex place) {
  for (int i = 0; i < 3; ++i) {
    const LocalIndex tag = host.face_tag(host.cell_faces(K, i));
    if (tag < 0 || !dirichlet[tag]) continue;
    for (int m = 0; m < points_of_face; ++m) on_held(place, i) = on_held(place, i) || std::abs(D[i * points_of_face + m]) > noise;
  }
}

View<LocalIndex*> nowhere(const mesh::Mesh& mesh) {
  const View<LocalIndex*> place("thixis::bound::place_of_deviation", mesh.owned_cells);
  Kokkos::deep_copy(place, -1);
  return place;
}

}  // namespace thixis::bound
