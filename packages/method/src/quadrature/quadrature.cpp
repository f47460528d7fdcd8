#include "thixis/method/quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "quadrature/cut_cell.hpp"
#include "thixis/mesh/to_view.hpp"
#include "thixis/method/evaluate.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::method {
namespace {

using mesh::to_view;

View<double* [2]> to_points(const std::string& label, const std::vector<double>& values) {
  const View<double* [2]> view(Kokkos::view_alloc(label, Kokkos::WithoutInitializing), values.size() / 2);
  const auto host = Kokkos::create_mirror_view(view);
  std::copy(values.begin(), values.end(), host.data());
  Kokkos::deep_copy(view, host);
  return view;
}

template <class T>
T value_at(const View<const T*>& view, std::size_t i) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), Kokkos::subview(view, i))();
}

/// Whether the curve may go through a cell, from the values at its vertices and its centre: a change of sign, or values as near to zero
/// as twice their variation. Saves a closer look at most cells.
bool suspicious(const double (&value)[4]) {
  const auto [low, high] = std::minmax_element(value, value + 4);
  if (*low <= 0 && *high >= 0) return true;
  return std::min(std::abs(*low), std::abs(*high)) <= 2 * (*high - *low);
}

struct OwnRules {
  std::vector<LocalIndex> rule;  // by position
  std::vector<GlobalIndex> offset = {0};
  std::vector<double> xi, weight;
};

/// The vertices of some cells and their centre, four points each.
struct FillCorners {
  CellQuadrature quadrature;
  LocalIndex first;
  View<double*> x, y;  ///< out
  KOKKOS_FUNCTION void operator()(const LocalIndex k) const {
    const CellQuadrature& Q = quadrature;
    const LocalIndex K = Q.cell(first + k), centre = 4 * k + 3;
    x(centre) = y(centre) = 0;
    for (int i = 0; i < 3; ++i) {
      x(4 * k + i) = Q.coordinates(Q.cell_vertices(K, i), 0);
      y(4 * k + i) = Q.coordinates(Q.cell_vertices(K, i), 1);
      x(centre) += x(4 * k + i) / 3;
      y(centre) += y(4 * k + i) / 3;
    }
  }
};

OwnRules own_rules(const CellQuadrature& quadrature, const scene::Field& level_set, double t) {
  constexpr LocalIndex chunk = 4096;
  OwnRules own;
  own.rule.assign(quadrature.cells(), -1);
  CutCell cut_cell(level_set, t, quadrature.order);
  const View<double*> x_view("thixis::method::corner_x", 4 * chunk), y_view("thixis::method::corner_y", 4 * chunk);
  std::vector<double> value(4 * chunk);
  for (LocalIndex first = 0; first < quadrature.cells(); first += chunk) {
    const LocalIndex count = std::min(chunk, quadrature.cells() - first);
    Kokkos::parallel_for("thixis::method::corners", Kokkos::RangePolicy<>(0, count), FillCorners{quadrature, first, x_view, y_view});
    const auto x = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), x_view);
    const auto y = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), y_view);
    level_set.evaluate({static_cast<std::size_t>(4 * count), x.data(), y.data()}, t, value.data());
    for (LocalIndex k = 0; k < count; ++k) {
      const int a = 4 * k, b = a + 1, c = a + 2;
      if (!suspicious({value[a], value[b], value[c], value[a + 3]})) continue;
      const double corners[3][2] = {{x(a), y(a)}, {x(b), y(b)}, {x(c), y(c)}};
      if (!cut_cell.append(corners, own.xi, own.weight)) continue;
      own.rule[first + k] = static_cast<LocalIndex>(own.offset.size()) - 1;
      own.offset.push_back(static_cast<GlobalIndex>(own.weight.size()));
    }
  }
  return own;
}

/// offset(k+1) - offset(k) = number of points of position k.
View<GlobalIndex*> offsets(const View<const LocalIndex*>& own_rule, const View<const GlobalIndex*>& own_offset, GlobalIndex of_others) {
  const View<GlobalIndex*> offset("thixis::method::quadrature_offset", own_rule.extent(0) + 1);
  Kokkos::parallel_scan(
      "thixis::method::quadrature_offset", Kokkos::RangePolicy<>(0, own_rule.extent_int(0)),
      KOKKOS_LAMBDA(int k, GlobalIndex& sum, bool last) {
        const LocalIndex c = own_rule(k);
        sum += c < 0 ? of_others : own_offset(c + 1) - own_offset(c);
        if (last) offset(k + 1) = sum;
      });
  return offset;
}

int most_points(const CellQuadrature& quadrature) {
  const auto offset = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), quadrature.offset);
  GlobalIndex most = 0;
  for (LocalIndex first = 0; first < quadrature.cells(); first += quadrature.block_cells)
    most = std::max(most, offset(std::min(first + quadrature.block_cells, quadrature.cells())) - offset(first));
  return static_cast<int>(most);
}

/// out(first + i) = first + i, or of(i) where there is such a list.
void list(const View<LocalIndex*>& out, LocalIndex first, LocalIndex count, const View<const LocalIndex*>& of) {
  Kokkos::parallel_for(
      "thixis::method::list_cells", Kokkos::RangePolicy<>(0, count),
      KOKKOS_LAMBDA(int i) { out(first + i) = of.extent(0) > 0 ? of(i) : first + i; });
}

/// The points of a block: x(q) = X_0 + (X_1 - X_0) xi_0 + (X_2 - X_0) xi_1, weight times 2|K|.
struct FillPoints {
  CellQuadrature quadrature;
  LocalIndex first, cells;
  View<int*> offset;     ///< out
  View<double* [2]> xi;  ///< out
  View<double*> weight;  ///< out
  View<double*> x, y;    ///< out
  KOKKOS_FUNCTION void operator()(const LocalIndex k) const {
    const CellQuadrature& Q = quadrature;
    const int begin = static_cast<int>(Q.offset(first + k) - Q.offset(first));
    const int count = static_cast<int>(Q.offset(first + k + 1) - Q.offset(first + k));
    offset(k) = begin;
    if (k + 1 == cells) offset(k + 1) = begin + count;

    const LocalIndex c = Q.own_rule(first + k);
    if (c < 0) place(k, begin, count, Q.rule_xi.data(), Q.rule_weight.data());
    else place(k, begin, count, &Q.own_xi(Q.own_offset(c), 0), &Q.own_weight(Q.own_offset(c)));
  }
  KOKKOS_FUNCTION void place(LocalIndex k, int begin, int count, const double* at, const double* of_rule) const {
    const CellQuadrature& Q = quadrature;
    const LocalIndex K = Q.cell(first + k), v0 = Q.cell_vertices(K, 0), v1 = Q.cell_vertices(K, 1), v2 = Q.cell_vertices(K, 2);
    const double x0 = Q.coordinates(v0, 0), x1 = Q.coordinates(v1, 0) - x0, x2 = Q.coordinates(v2, 0) - x0;
    const double y0 = Q.coordinates(v0, 1), y1 = Q.coordinates(v1, 1) - y0, y2 = Q.coordinates(v2, 1) - y0;
    const double twice_volume = x1 * y2 - x2 * y1;
    double *const to_xi = &xi(begin, 0), *const to_weight = &weight(begin), *const to_x = &x(begin), *const to_y = &y(begin);
    for (int i = 0; i < count; ++i) {
      const double a = at[2 * i], b = at[2 * i + 1];
      to_xi[2 * i] = a;
      to_xi[2 * i + 1] = b;
      to_weight[i] = twice_volume * of_rule[i];
      to_x[i] = x0 + x1 * a + x2 * b;
      to_y[i] = y0 + y1 * a + y2 * b;
    }
  }
};

}  // namespace

GlobalIndex CellQuadrature::points() const { return offset.extent(0) == 0 ? 0 : value_at(offset, offset.extent(0) - 1); }

CellQuadrature make_quadrature(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, int order, const scene::FieldPtr& level_set,
                               double t, LocalIndex block_cells) {
  const reference::Quadrature rule = reference::triangle_quadrature(order);
  CellQuadrature quadrature;
  quadrature.order = order;
  quadrature.cell = cells;
  quadrature.rule_xi = to_points("thixis::method::rule_xi", rule.point);
  quadrature.rule_weight = to_view("thixis::method::rule_weight", rule.weight);
  quadrature.coordinates = mesh.coordinates;
  quadrature.cell_vertices = mesh.cell_vertices;
  quadrature.block_cells = std::max(1, block_cells);

  OwnRules own;
  own.rule.assign(quadrature.cells(), -1);
  if (level_set && level_set->constant() == nullptr) own = mesh.comm.together([&] { return own_rules(quadrature, *level_set, t); });
  quadrature.own_rule = to_view("thixis::method::own_rule", own.rule);
  quadrature.own_offset = to_view("thixis::method::own_offset", own.offset);
  quadrature.own_xi = to_points("thixis::method::own_xi", own.xi);
  quadrature.own_weight = to_view("thixis::method::own_weight", own.weight);
  quadrature.offset = offsets(quadrature.own_rule, quadrature.own_offset, rule.size());
  quadrature.largest_block = most_points(quadrature);
  return quadrature;
}

View<const LocalIndex*> owned_cells(const mesh::Mesh& mesh) {
  const View<LocalIndex*> cells("thixis::method::owned_cells", mesh.owned_cells);
  list(cells, 0, mesh.owned_cells, {});
  return cells;
}

View<const LocalIndex*> patch_cells(const mesh::Mesh& mesh) {
  const LocalIndex ghosts = static_cast<LocalIndex>(mesh.ghost_patch_cells.extent(0));
  const View<LocalIndex*> cells("thixis::method::patch_cells", mesh.owned_cells + ghosts);
  list(cells, 0, mesh.owned_cells, {});
  list(cells, mesh.owned_cells, ghosts, mesh.ghost_patch_cells);
  return cells;
}

void evaluate(const scene::Field& field, double t, const QuadratureBlock& block, const View<double*>& values) {
  evaluate(field, t, block.points, block.x, block.y, values);
}

void evaluate(const scene::Field& field, double t, int points, const View<const double*>& x, const View<const double*>& y,
              const View<double*>& values) {
  const auto x_host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), x);
  const auto y_host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), y);
  const auto out = Kokkos::create_mirror_view(values);
  field.evaluate({static_cast<std::size_t>(points), x_host.data(), y_host.data()}, t, out.data());
  Kokkos::deep_copy(values, out);
}

QuadraturePoints::QuadraturePoints(const CellQuadrature& quadrature)
    : quadrature_(quadrature),
      offset_("thixis::method::block_offset", std::min(quadrature.block_cells, quadrature.cells()) + 1),
      xi_(Kokkos::view_alloc(std::string("thixis::method::block_xi"), Kokkos::WithoutInitializing), quadrature.largest_block),
      weight_(Kokkos::view_alloc(std::string("thixis::method::block_weight"), Kokkos::WithoutInitializing), quadrature.largest_block),
      x_(Kokkos::view_alloc(std::string("thixis::method::block_x"), Kokkos::WithoutInitializing), quadrature.largest_block),
      y_(Kokkos::view_alloc(std::string("thixis::method::block_y"), Kokkos::WithoutInitializing), quadrature.largest_block) {}

const QuadratureBlock& QuadraturePoints::fill(LocalIndex first, LocalIndex cells) {
  FillPoints kernel;
  kernel.quadrature = quadrature_;
  kernel.first = first;
  kernel.cells = cells;
  kernel.offset = offset_;
  kernel.xi = xi_;
  kernel.weight = weight_;
  kernel.x = x_;
  kernel.y = y_;
  Kokkos::parallel_for("thixis::method::quadrature_points", Kokkos::RangePolicy<>(0, cells), kernel);
  Kokkos::fence();
  const auto positions = std::make_pair(first, first + cells);
  block_.first = first;
  block_.cells = cells;
  block_.points = value_at(View<const int*>(offset_), cells);
  block_.cell = Kokkos::subview(quadrature_.cell, positions);
  block_.own_rule = Kokkos::subview(quadrature_.own_rule, positions);
  block_.offset = offset_;
  block_.xi = xi_;
  block_.weight = weight_;
  block_.x = x_;
  block_.y = y_;
  return block_;
}

}  // namespace thixis::method
