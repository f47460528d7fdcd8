#include "thixis/method/jumps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "thixis/mesh/remoteness.hpp"
#include "thixis/mesh/to_view.hpp"

namespace thixis::method {
namespace {

using reference::Entity;
using Barycentric = std::array<double, 3>;

constexpr int sides = 4;  ///< of the lattice at which cells are looked at, besides the points of the quadrature
constexpr int halvings = 12;
constexpr double kept = 1.0 / 16;  ///< of the difference
constexpr double round_off = 1e-12;

template <class V>
auto on_host(const V& view) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
}

/// A point of a cell with the value there.
struct Sample {
  Barycentric at{};
  double value = 0, deviation = 0;  ///< from the linear interpolant
};

/// The way between two samples of a cell.
struct Way {
  LocalIndex cell;  ///< position
  double vertex[3];
  Sample from, to;
  double difference() const { return std::abs(to.deviation - from.deviation); }
};

double interpolant(const double (&vertex)[3], const Barycentric& at) { return at[0] * vertex[0] + at[1] * vertex[1] + at[2] * vertex[2]; }

std::vector<Barycentric> lattice() {
  std::vector<Barycentric> points;
  for (int i = 0; i <= sides; ++i)
    for (int j = 0; i + j <= sides; ++j)
      points.push_back({static_cast<double>(sides - i - j) / sides, static_cast<double>(i) / sides, static_cast<double>(j) / sides});
  return points;
}

/// Looks at cells, and halves ways through all of them at a time.
class Search {
 public:
  Search(const CellQuadrature& quadrature, const scene::Field& v, double t)
      : quadrature_(quadrature),
        cell_(on_host(quadrature.cell)),
        vertices_(on_host(quadrature.cell_vertices)),
        coordinates_(on_host(quadrature.coordinates)),
        v_(v),
        t_(t) {}

  Jumps jumps() {
    found_.of_cells.resize(quadrature_.cells());
    const View<double*> value("thixis::method::jumps", quadrature_.largest_block);
    for_each_block(quadrature_, [&](const QuadratureBlock& block) {
      evaluate(v_, t_, block, value);
      look(block, value);
    });
    for (int i = 0; i < halvings; ++i) halve();
    bool any = false;
    for (std::size_t w = 0; w < ways_.size(); ++w)
      if (ways_[w].difference() > kept * first_[w]) any = found_.of_cells[ways_[w].cell].jumps = true;
    if (!any) found_.of_cells.clear();
    return std::move(found_);
  }

 private:
  void place(LocalIndex cell, const Barycentric& at, std::vector<double>& x, std::vector<double>& y) const {
    double point[2] = {0, 0};
    for (int a = 0; a < 3; ++a)
      for (int d = 0; d < 2; ++d) point[d] += at[a] * coordinates_(vertices_(cell, a), d);
    x.push_back(point[0]);
    y.push_back(point[1]);
  }

  std::vector<double> values(const std::vector<double>& x, const std::vector<double>& y) const {
    std::vector<double> of(x.size());
    v_.evaluate({x.size(), x.data(), y.data()}, t_, of.data());
    return of;
  }

  /// Ranges of the cells of a block, and a way through each that may jump.
  void look(const QuadratureBlock& block, const View<double*>& values_at_rule) {
    const auto offset = on_host(block.offset);
    const auto xi = on_host(block.xi);
    const auto at_rule = on_host(values_at_rule);
    std::vector<double> x, y;
    for (LocalIndex k = 0; k < block.cells; ++k)
      for (const Barycentric& at : lattice_) place(cell_(block.first + k), at, x, y);
    const auto at_lattice = values(x, y);
    for (LocalIndex k = 0; k < block.cells; ++k) {
      const double* const of_lattice = &at_lattice[k * lattice_.size()];
      Way way{block.first + k, {}, {}, {}};
      for (std::size_t i = 0; i < lattice_.size(); ++i)
        for (int a = 0; a < 3; ++a)
          if (lattice_[i][a] == 1) way.vertex[a] = of_lattice[i];
      Jumps::Range& range = found_.of_cells[way.cell];
      range = {false, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
      bool first = true;
      const auto meet = [&](const Barycentric& at, double value) {
        const Sample sample{at, value, value - interpolant(way.vertex, at)};
        widen(range, value);
        if (first || sample.deviation < way.from.deviation) way.from = sample;
        if (first || sample.deviation > way.to.deviation) way.to = sample;
        first = false;
      };
      for (std::size_t i = 0; i < lattice_.size(); ++i) meet(lattice_[i], of_lattice[i]);
      for (int q = offset(k); q < offset(k + 1); ++q) meet({1 - xi(q, 0) - xi(q, 1), xi(q, 0), xi(q, 1)}, at_rule(q));
      const auto vertex = [&](int a, int d) { return coordinates_(vertices_(cell_(way.cell), a), d); };
      const double by_place = mesh::remoteness(3, vertex) * (range.high - range.low);
      if (way.difference() <= round_off * std::max({std::abs(range.low), std::abs(range.high), v_.cancelled(), by_place})) continue;
      first_.push_back(way.difference());
      ways_.push_back(way);
    }
  }

  void halve() {
    std::vector<double> x, y;
    std::vector<Barycentric> middle;
    for (const Way& way : ways_) {
      Barycentric at;
      for (int a = 0; a < 3; ++a) at[a] = (way.from.at[a] + way.to.at[a]) / 2;
      middle.push_back(at);
      place(cell_(way.cell), at, x, y);
    }
    const auto value = values(x, y);
    for (std::size_t w = 0; w < ways_.size(); ++w) {
      Way& way = ways_[w];
      const Sample between{middle[w], value[w], value[w] - interpolant(way.vertex, middle[w])};
      widen(found_.of_cells[way.cell], value[w]);
      const bool near_from = std::abs(between.deviation - way.from.deviation) > std::abs(way.to.deviation - between.deviation);
      (near_from ? way.to : way.from) = between;
    }
  }

  static void widen(Jumps::Range& range, double value) {
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }

  const CellQuadrature& quadrature_;
  mesh::ConstHostView<const LocalIndex*> cell_;  ///< these three: of the quadrature
  mesh::ConstHostView<const LocalIndex* [3]> vertices_;
  mesh::ConstHostView<const double* [2]> coordinates_;
  const scene::Field& v_;
  double t_;
  const std::vector<Barycentric> lattice_ = lattice();
  Jumps found_;
  std::vector<Way> ways_;
  std::vector<double> first_;  ///< their differences before they were halved
};

}  // namespace

Jumps jumps_in_cells(const CellQuadrature& quadrature, const scene::Field& v, double t) {
  return v.constant() ? Jumps() : Search(quadrature, v, t).jumps();
}

void interpolate_with_jumps(const reference::CellBasis& basis, const Kokkos::View<const LocalIndex**, Kokkos::LayoutRight>& of_cells_view,
                            const Jumps& jumps, AtJumps rule, std::vector<double>& value) {
  const auto of_cells = on_host(of_cells_view);
  const int n = basis.size();
  const auto cells = static_cast<LocalIndex>(of_cells.extent(0));
  const bool bernstein = basis.family() == reference::Family::bernstein;
  std::vector<double> coefficient = value;
  for (LocalIndex k = 0; bernstein && k < cells; ++k)
    for (int l = 0; l < n && !jumps.at(k); ++l) {
      double sum = 0;
      for (int m = 0; m < n; ++m) sum += basis.from_values()[l * n + m] * value[of_cells(k, m)];
      coefficient[of_cells(k, l)] = sum;
    }
  if (jumps.any()) {
    std::vector<double> lowest(value.size(), std::numeric_limits<double>::infinity());
    for (LocalIndex k = 0; k < cells; ++k)
      for (int l = 0; l < n && jumps.at(k); ++l) {
        const bool kept_there = rule == AtJumps::shared && basis.entities()[l].kind == Entity::vertex;
        if (!kept_there) lowest[of_cells(k, l)] = std::min(lowest[of_cells(k, l)], jumps.of_cells[k].low);
      }
    for (LocalIndex k = 0; k < cells && rule == AtJumps::shared; ++k)
      for (int l = 0; l < n && !jumps.at(k); ++l) lowest[of_cells(k, l)] = std::numeric_limits<double>::infinity();
    for (std::size_t e = 0; e < value.size(); ++e)
      if (std::isfinite(lowest[e])) coefficient[e] = lowest[e];
  }
  value = std::move(coefficient);
}

}  // namespace thixis::method
