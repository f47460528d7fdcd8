#include "thixis/fv/nodal_average.hpp"

#include <algorithm>
#include <cmath>

#include "averaging_nodes.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::fv {
namespace {

using algebra::MultiVector;
using Range = Kokkos::RangePolicy<MultiVector::execution_space>;

/// sums(node, j) = sum over the owned cells around it of p_j there; sums(node, m + j) = sum over the held faces F of
/// the value given there, at a corner with what p_j of the cell behind F changes by from the midpoint of F.
struct Gather {
  Lists cells, held;
  View<const LocalIndex* [2]> face_cells;
  View<const double*[2]> centre, face_centre, position;
  View<const Quadratic**> p;
  View<const double**> given;
  MultiVector::dual_view_type::t_dev sums;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex node) const {
    const int m = p.extent_int(1);
    for (int j = 0; j < 2 * m; ++j) sums(node, j) = 0;
    for (LocalIndex k = cells.begin(node); k < cells.begin(node + 1); ++k) {
      const LocalIndex K = cells.entry(k);
      const double y[2] = {position(node, 0) - centre(K, 0), position(node, 1) - centre(K, 1)};
      for (int j = 0; j < m; ++j) sums(node, j) += p(K, j)(y);
    }
    for (LocalIndex k = held.begin(node); k < held.begin(node + 1); ++k) {
      const LocalIndex F = held.entry(k), K = face_cells(F, 0);
      const double y[2] = {position(node, 0) - centre(K, 0), position(node, 1) - centre(K, 1)};
      const double middle[2] = {face_centre(F, 0) - centre(K, 0), face_centre(F, 1) - centre(K, 1)};
      for (int j = 0; j < m; ++j) sums(node, m + j) += given(F, j) + p(K, j)(y) - p(K, j)(middle);
    }
  }
};

/// |grad d|² of the function with these values at the nodes and 0 at the centre.
KOKKOS_INLINE_FUNCTION double interval_energy(double a, double b, double h) { return (7 * a * a + 2 * a * b + 7 * b * b) / (3 * h); }

KOKKOS_INLINE_FUNCTION double rectangle_energy(const double d[3][3], double h_x, double h_y) {
  constexpr double stiffness[3][3] = {{7, -8, 1}, {-8, 16, -8}, {1, -8, 7}}, mass[3][3] = {{4, 2, -1}, {2, 16, 2}, {-1, 2, 4}};
  double x = 0, y = 0;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        for (int l = 0; l < 3; ++l) {
          const double dd = d[i][j] * d[k][l];
          x += stiffness[i][k] * mass[j][l] * dd;
          y += mass[i][k] * stiffness[j][l] * dd;
        }
  return (x * h_y / h_x + y * h_x / h_y) / 90;
}

/// corner[i], and middle[i] at the midpoint of the side opposite to corner i, whose outward normal times its length is n[i].
KOKKOS_INLINE_FUNCTION double triangle_energy(const double corner[3], const double middle[3], const double n[3][2], double volume) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {  // at the midpoint k: lambda_k = 0, the others ½; grad lambda_i = -n_i/(2|K|)
    double v[2] = {0, 0};
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      const double by_corner = i == k ? -1 : 1, lambda_a = a == k ? 0 : 0.5, lambda_b = b == k ? 0 : 0.5;
      for (int c = 0; c < 2; ++c)
        v[c] -= (corner[i] * by_corner * n[i][c] + 4 * middle[i] * (lambda_a * n[b][c] + lambda_b * n[a][c])) / (2 * volume);
    }
    sum += v[0] * v[0] + v[1] * v[1];
  }
  return volume * sum / 3;
}

struct Distance {
  RaviartThomas cells;
  View<const LocalIndex**> corners;   ///< nodes of the corners of owned cells
  View<const LocalIndex*> face_node;  ///< nodes of midpoints
  View<const double* [2]> position;
  View<const double* [2]> count;  ///< of cells and of held faces around a node, on all ranks
  View<const Quadratic**> p;
  MultiVector::dual_view_type::t_dev sums;
  int dimension;
  View<double**> square;  ///< out, overwritten

  KOKKOS_FUNCTION double difference(LocalIndex K, int j, LocalIndex node) const {
    const int m = p.extent_int(1);
    const double y[2] = {position(node, 0) - cells.centre(K, 0), position(node, 1) - cells.centre(K, 1)};
    const double average = count(node, 1) > 0 ? sums(node, m + j) / count(node, 1) : sums(node, j) / count(node, 0);
    return p(K, j)(y) - average;
  }
  KOKKOS_FUNCTION int side(double y) const { return y > 0 ? 2 : 0; }

  KOKKOS_FUNCTION double rectangle(LocalIndex K, int j) const {
    double d[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, width[2] = {1, 1};
    for (int i = 0; i < 4; ++i) {
      const LocalIndex v = corners(K, i), F = cells.face(K, i);
      d[side(position(v, 0) - cells.centre(K, 0))][side(position(v, 1) - cells.centre(K, 1))] = difference(K, j, v);
      const int axis = cells.axis(F), at = side(cells.face_centre(F, axis) - cells.centre(K, axis));
      (axis == 0 ? d[at][1] : d[1][at]) = difference(K, j, face_node(F));
      width[axis] = cells.volume(K) / cells.area(F);
    }
    return rectangle_energy(d, width[0], width[1]);
  }

  KOKKOS_FUNCTION double triangle(LocalIndex K, int j) const {
    double corner[3], middle[3], n[3][2];
    for (int i = 0; i < 3; ++i) {
      const LocalIndex v = corners(K, i);
      corner[i] = difference(K, j, v);
      int opposite = 0;
      double farthest = -1;
      for (int f = 0; f < 3; ++f) {
        const LocalIndex F = cells.face(K, f);
        const double away = -cells.sign(K, f) *
                            ((position(v, 0) - cells.face_centre(F, 0)) * cells.normal(F, 0) +
                             (position(v, 1) - cells.face_centre(F, 1)) * cells.normal(F, 1)) *
                            cells.area(F);
        if (away > farthest) {
          farthest = away;
          opposite = f;
        }
      }
      const LocalIndex F = cells.face(K, opposite);
      middle[i] = difference(K, j, face_node(F));
      for (int c = 0; c < 2; ++c) n[i][c] = cells.sign(K, opposite) * cells.normal(F, c) * cells.area(F);
    }
    return triangle_energy(corner, middle, n, cells.volume(K));
  }

  KOKKOS_FUNCTION void operator()(LocalIndex K) const {
    for (int j = 0; j < p.extent_int(1); ++j)
      square(K, j) = dimension == 1    ? interval_energy(difference(K, j, corners(K, 0)), difference(K, j, corners(K, 1)), cells.volume(K))
                     : cells.triangles ? triangle(K, j)
                                       : rectangle(K, j);
  }
};

}  // namespace

struct NodalAverage::Impl {
  Grid grid;
  AveragingNodes at;
  View<double* [2]> count;  ///< cells and held faces around each node, of all ranks
  algebra::MapPtr nodes, unique;
  Teuchos::RCP<const algebra::Import> import;

  Impl(const Grid& on, const std::vector<bool>& held_faces)
      : grid(on), at(averaging_nodes(on, held_faces)), count("thixis::fv::node_count", at.ids.size()) {
    nodes = algebra::map_of(at.ids, grid.comm);
    unique = Tpetra::createOneToOne(nodes);
    import = Teuchos::rcp(new algebra::Import(unique, nodes));
    MultiVector counts(nodes, 2);
    {
      const auto values = counts.getLocalViewHost(Tpetra::Access::OverwriteAll);
      for (std::size_t i = 0; i < at.count.size(); ++i)
        for (int c = 0; c < 2; ++c) values(i, c) = at.count[i][c];
    }
    add_up(counts);
    Kokkos::deep_copy(count, std::as_const(counts).getLocalViewDevice(Tpetra::Access::ReadOnly));
  }

  /// What ranks have at shared nodes is summed up, everywhere.
  void add_up(MultiVector& values) const {
    if (grid.comm.size() == 1) return;
    MultiVector sums(unique, values.getNumVectors());
    sums.doExport(values, *import, Tpetra::ADD);
    values.doImport(sums, *import, Tpetra::INSERT);
  }
};

NodalAverage::NodalAverage(const Grid& grid, const std::vector<bool>& held) : impl_(std::make_unique<Impl>(grid, held)) {}
NodalAverage::~NodalAverage() = default;

void NodalAverage::operator()(const View<const Quadratic**>& p, const View<const double**>& given, const View<double**>& square) const {
  const Impl& in = *impl_;
  MultiVector sums(in.nodes, 2 * p.extent(1));
  Gather gather;
  gather.cells = in.at.cells;
  gather.held = in.at.held;
  gather.face_cells = in.grid.face_cells;
  gather.centre = in.grid.centre;
  gather.face_centre = in.grid.face_centre;
  gather.position = in.at.position;
  gather.p = p;
  gather.given = given;
  gather.sums = sums.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  Kokkos::parallel_for("thixis::fv::gather_nodes", Range(0, in.at.position.extent_int(0)), gather);
  in.add_up(sums);
  Distance distance{RaviartThomas(in.grid)};
  distance.corners = in.at.corners;
  distance.face_node = in.at.face_node;
  distance.position = in.at.position;
  distance.count = in.count;
  distance.p = p;
  distance.sums = sums.getLocalViewDevice(Tpetra::Access::ReadWrite);
  distance.dimension = in.grid.dimension;
  distance.square = square;
  Kokkos::parallel_for("thixis::fv::distance_from_average", Range(0, in.grid.owned_cells), distance);
}

}  // namespace thixis::fv
