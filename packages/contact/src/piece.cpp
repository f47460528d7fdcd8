#include "piece.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace thixis::contact {

using algebra::MultiVector;
using algebra::Vector;
using Range = Kokkos::RangePolicy<Vector::execution_space>;

std::vector<Part> independent_parts(const System& system) {
  const int m = system.fields();
  const TransformedBlocks blocks(system, all_coordinates(m));
  if (!blocks.frames.uniform()) return {all_coordinates(m)};
  const auto act = [&](int i, int j) {
    for (int k = 0; k < blocks.matrices; ++k) {
      const double size = std::sqrt(std::abs(blocks.uniform[k](i, i) * blocks.uniform[k](j, j)));
      for (const double c : {blocks.uniform[k](i, j), blocks.uniform[k](j, i)})
        if (std::abs(c) > 1e-13 * size) return true;
    }
    return false;
  };
  std::vector<int> root(m);
  std::iota(root.begin(), root.end(), 0);
  for (int pass = 0; pass < m; ++pass)
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < m; ++j)
        if (act(i, j)) root[i] = root[j] = std::min(root[i], root[j]);
  std::vector<Part> parts;
  for (int r = 0; r < m; ++r) {
    Part part;
    for (int i = 0; i < m; ++i)
      if (root[i] == r) part.coordinate[part.size++] = i;
    if (part.size > 0) parts.push_back(part);
  }
  return parts;
}

Piece::Piece(const System& system, const Part& of, std::unique_ptr<ConstrainedSolver> by, MultiVector& all_rhs, MultiVector& dy)
    : part(of), solver(std::move(by)), has_gaps(of.coordinate[of.size - 1] >= system.fields() - system.gaps()) {
  if (part.size == 1) {
    rhs = all_rhs.getVectorNonConst(part.coordinate[0]);
    y = dy.getVectorNonConst(part.coordinate[0]);
  } else {
    const auto map = algebra::interlaced(system.map(), part.size);
    rhs = Teuchos::rcp(new Vector(map));
    y = Teuchos::rcp(new Vector(map));
  }
}

void Piece::take(const MultiVector& all_rhs, const MultiVector& dy) const {
  if (part.size == 1) return;
  take(all_rhs, *rhs, true);
  take(dy, *y, false);
}

void Piece::take(const MultiVector& columns, Vector& out, bool right_side) const {
  const auto in = columns.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto to = out.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const Part of = part;
  Kokkos::parallel_for(
      "thixis::contact::take", Range(0, in.extent_int(0)), KOKKOS_LAMBDA(int l) {
        for (int i = 0; i < of.size; ++i)
          to(of.size * l + i, 0) = right_side ? of.stretch[i] * in(l, of.coordinate[i]) : in(l, of.coordinate[i]) / of.stretch[i];
      });
}

void Piece::put(const Vector& of_piece, MultiVector& dy) const {
  const auto in = of_piece.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto to = dy.getLocalViewDevice(Tpetra::Access::ReadWrite);
  const Part of = part;
  Kokkos::parallel_for(
      "thixis::contact::put", Range(0, to.extent_int(0)), KOKKOS_LAMBDA(int l) {
        for (int i = 0; i < of.size; ++i) to(l, of.coordinate[i]) = of.stretch[i] * in(of.size * l + i, 0);
      });
}

}  // namespace thixis::contact
