#include "systems.hpp"

#include <array>
#include <cmath>

namespace thixis::algebra::testing {

namespace {

/// Contact on a disk around the centre.
bool in_contact(int n, GlobalIndex node) {
  const double x = (node % n + 1.) / (n + 1) - 0.5, y = (node / n + 1.) / (n + 1) - 0.5;
  return x * x + y * y < 0.09;
}

/// Neighbours of a node in the grid.
template <class F>
void for_neighbours(int n, GlobalIndex node, F&& f) {
  if (node % n > 0) f(node - 1);
  if (node % n < n - 1) f(node + 1);
  if (node / n > 0) f(node - n);
  if (node / n < n - 1) f(node + n);
}

}  // namespace

MapPtr node_map(GlobalIndex nodes, int fields, Distribution distribution) {
  const core::Comm comm;
  const int owners = distribution == Distribution::even || comm.size() == 1 ? comm.size() : comm.size() - 1;
  const int rank = std::min(comm.rank(), owners);
  const GlobalIndex first = nodes * rank / owners, last = nodes * std::min(rank + 1, owners) / owners;
  return contiguous_map(static_cast<LocalIndex>((last - first) * fields), comm);
}

MatrixPtr matrix(const MapPtr& map, const Row& row) {
  const MatrixPtr A = Teuchos::rcp(new Matrix(map, 16));
  std::vector<GlobalIndex> columns;
  std::vector<double> values;
  for (LocalIndex i = 0; i < local_size(*map); ++i) {
    columns.clear();
    values.clear();
    const GlobalIndex id = map->getGlobalElement(i);
    row(id, columns, values);
    A->insertGlobalValues(id, Teuchos::ArrayView<const GlobalIndex>(columns.data(), columns.size()),
                          Teuchos::ArrayView<const double>(values.data(), values.size()));
  }
  A->fillComplete(map, map);
  return A;
}

Row poisson(int n) {
  return [n](GlobalIndex row, auto& columns, auto& values) {
    columns.push_back(row), values.push_back(4);
    for_neighbours(n, row, [&](GlobalIndex j) { columns.push_back(j), values.push_back(-1); });
  };
}

Row neumann(int n) {
  return [n](GlobalIndex row, auto& columns, auto& values) {
    double sum = 0;
    for_neighbours(n, row, [&](GlobalIndex j) { columns.push_back(j), values.push_back(-1), ++sum; });
    columns.push_back(row), values.push_back(sum);
  };
}

Row membranes(int n) {
  return [n](GlobalIndex row, auto& columns, auto& values) {
    const GlobalIndex node = row / 3;
    const int field = static_cast<int>(row % 3);
    const bool contact = in_contact(n, node);
    // All nine entries of the node block are in the pattern, as in the contact problem, where they change from step to step.
    std::array<double, 3> block = {0, 0, 0};
    if (field < 2) block[field] = 4, block[2] = field == 0 ? -1 : 1;
    else if (contact) block = {1, -1, 0};
    else block = {0, 0, 1};
    for (int j = 0; j < 3; ++j) columns.push_back(3 * node + j), values.push_back(block[j]);
    if (field < 2) for_neighbours(n, node, [&](GlobalIndex j) { columns.push_back(3 * j + field), values.push_back(-1); });
  };
}

Row reduced_membranes(int n, double scale) {
  return [n, scale](GlobalIndex row, auto& columns, auto& values) {
    const GlobalIndex node = row / 2;
    const int field = static_cast<int>(row % 2);
    const bool contact = in_contact(n, node);
    const auto add = [&](GlobalIndex column, double value) { columns.push_back(column), values.push_back(value); };
    if (contact && field == 1) return add(row, scale);
    // Where the neighbour is in contact, its u2 is its u1; where this node is, both of its equations are added.
    add(row, contact ? 8 : 4);
    for_neighbours(n, node, [&](GlobalIndex j) {
      if (contact == in_contact(n, j)) {
        add(2 * j + field, contact ? -2 : -1);
      } else if (contact) {
        add(2 * j, -1), add(2 * j + 1, -1);
      } else {
        add(2 * j, -1);
      }
    });
  };
}

Teuchos::RCP<const MultiVector> coordinates(int n, Distribution distribution) {
  const MapPtr map = node_map(GlobalIndex(n) * n, 1, distribution);
  const auto xy = Teuchos::rcp(new MultiVector(map, 2));
  const auto view = xy->getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (LocalIndex i = 0; i < local_size(*map); ++i) {
    view(i, 0) = static_cast<double>(map->getGlobalElement(i) % n);
    view(i, 1) = static_cast<double>(map->getGlobalElement(i) / n);
  }
  return xy;
}

Vector right_hand_side(const MapPtr& map) {
  Vector b(map);
  const auto view = host_overwrite(b);
  for (LocalIndex i = 0; i < local_size(*map); ++i) {
    const auto id = static_cast<double>(map->getGlobalElement(i));
    view(i) = 1 + std::sin(0.1 * id) + 0.3 * std::cos(2.5 * id);
  }
  return b;
}

double true_residual(const Matrix& A, const Vector& b, const Vector& x) {
  Vector r(b.getMap());
  return residual(A, b, x, r);
}

double difference(const Vector& x, const Vector& y) {
  Vector d(x, Teuchos::Copy);
  d.update(-1., y, 1.);
  return norm2(d) / norm2(y);
}

}  // namespace thixis::algebra::testing
