#include "deviation/deviation_points.hpp"

#include <algorithm>
#include <cmath>

#include "data/on_host.hpp"
#include "data/tables.hpp"

namespace thixis::bound {

method::CellQuadrature subset(const method::CellQuadrature& all, const std::vector<LocalIndex>& positions) {
  const LocalIndex count = static_cast<LocalIndex>(positions.size());
  const auto cells = on_host(all.cell), rules = on_host(all.own_rule);
  const auto points = on_host(all.offset);
  std::vector<LocalIndex> cell, own_rule;
  std::vector<GlobalIndex> offset = {0};
  for (const LocalIndex k : positions) {
    cell.push_back(cells(k));
    own_rule.push_back(rules(k));
    offset.push_back(offset.back() + points(k + 1) - points(k));
  }
  method::CellQuadrature some = all;
  some.cell = to_view("thixis::bound::subset_cell", cell);
  some.own_rule = to_view("thixis::bound::subset_rule", own_rule);
  some.offset = to_view("thixis::bound::subset_offset", offset);
  some.largest_block = 0;
  for (LocalIndex first = 0; first < count; first += some.block_cells)
    some.largest_block = std::max(some.largest_block, static_cast<int>(offset[std::min(first + some.block_cells, count)] - offset[first]));
  return some;
}

method::CellQuadrature composite(method::CellQuadrature quadrature, int sides) {
  const int points = quadrature.rule_weight.extent_int(0), parts = sides * sides;
  const View<double* [2]> xi_view("thixis::bound::composite_xi", parts * points);
  const View<double*> weight_view("thixis::bound::composite_weight", parts * points);
  const auto xi = Kokkos::create_mirror_view(xi_view);
  const auto weight = Kokkos::create_mirror_view(weight_view);
  const auto rule_xi = on_host(quadrature.rule_xi);
  const auto rule_weight = on_host(quadrature.rule_weight);
  int at = 0;
  const auto add = [&](double origin_xi, double origin_eta, double scale) {
    for (int q = 0; q < points; ++q, ++at) {
      xi(at, 0) = origin_xi + scale * rule_xi(q, 0);
      xi(at, 1) = origin_eta + scale * rule_xi(q, 1);
      weight(at) = rule_weight(q) / parts;
    }
  };
  const double h = 1.0 / sides;
  for (int i = 0; i < sides; ++i)
    for (int j = 0; i + j < sides; ++j) {
      add(i * h, j * h, h);
      if (i + j + 1 < sides) add((i + 1) * h, (j + 1) * h, -h);
    }
  Kokkos::deep_copy(xi_view, xi);
  Kokkos::deep_copy(weight_view, weight);
  std::vector<GlobalIndex> offset;
  for (LocalIndex k = 0; k <= quadrature.cells(); ++k) offset.push_back(static_cast<GlobalIndex>(k) * parts * points);
  quadrature.rule_xi = xi_view;
  quadrature.rule_weight = weight_view;
  quadrature.offset = to_view("thixis::bound::composite_offset", offset);
  quadrature.largest_block *= parts;
  return quadrature;
}

View<double* [2]> face_points() {
  const View<double* [2]> points("thixis::bound::face_points", 3 * points_of_face);
  const auto xi = Kokkos::create_mirror_view(points);
  for (int i = 0; i < 3; ++i)
    for (int m = 0; m < points_of_face; ++m) {
      double lambda[3] = {0, 0, 0};
      lambda[(i + 1) % 3] = 1 - (m + 0.5) / points_of_face;
      lambda[(i + 2) % 3] = (m + 0.5) / points_of_face;
      for (int d = 0; d < 2; ++d) xi(i * points_of_face + m, d) = lambda[1 + d];
    }
  Kokkos::deep_copy(points, xi);
  return points;
}

void mark_held(const mesh::HostMesh& host, const std::vector<bool>& dirichlet, LocalIndex K, const double* D, double noise,
               const mesh::HostView<bool* [3]>& on_held, LocalIndex place) {
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

DeviationOnHost::DeviationOnHost(const mesh::Mesh& mesh, std::size_t cells, std::size_t points)
    : place_(nowhere(mesh)),
      bound_("thixis::bound::deviation_bound", cells),
      at_points_("thixis::bound::deviation", points),
      on_held_("thixis::bound::deviation_on_held", cells) {
  place = on_host(place_);
  bound = on_host(bound_);
  at_points = on_host(at_points_);
  on_held = on_host(on_held_);
}

void DeviationOnHost::commit(Deviation& deviation) const {
  Kokkos::deep_copy(place_, place);
  Kokkos::deep_copy(bound_, bound);
  Kokkos::deep_copy(at_points_, at_points);
  Kokkos::deep_copy(on_held_, on_held);
  deviation.place = place_;
  deviation.bound = bound_;
  deviation.at_points = at_points_;
  deviation.on_held = on_held_;
}

}  // namespace thixis::bound
