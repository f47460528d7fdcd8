#include "transformed.hpp"

namespace thixis::contact {
namespace {

using algebra::MultiVector;
using Range = Kokkos::RangePolicy<algebra::Vector::execution_space>;

auto read(const MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadOnly); }
auto overwrite(MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::OverwriteAll); }

}  // namespace

Part all_coordinates(int fields) {
  Part part;
  part.size = fields;
  for (int i = 0; i < fields; ++i) part.coordinate[i] = i;
  return part;
}

TransformedBlocks::TransformedBlocks(const System& system, const Part& of)
    : fields(system.fields()), matrices(static_cast<int>(system.S.matrix.size())), frames(system.constraint.frames), part(of) {
  for (int k = 0; k < matrices; ++k) weight[k] = system.S.weight[k];
  if (!frames.uniform()) return;
  const auto T = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), frames.T);
  between(T(0), T(0), uniform);
}

TransformedOperator::TransformedOperator(const System& system)
    : system_(system),
      blocks_(system, all_coordinates(system.fields())),
      left_(system.map(), system.fields()),
      right_(system.map(), system.fields()) {}

void TransformedOperator::apply(const MultiVector& y, int first, MultiVector& out) const {
  const int rows = static_cast<int>(out.getNumVectors()), fields = blocks_.fields;
  if (!blocks_.frames.uniform()) {
    apply_frames(system_, y, left_);
    MultiVector product(system_.map(), fields);
    system_.S.apply(left_, right_, product);
    transpose_frames(system_, right_, product);
    Tpetra::deep_copy(out, *product.subView(Teuchos::Range1D(first, first + rows - 1)));
    return;
  }
  out.putScalar(0);
  const Teuchos::Range1D columns(0, rows - 1);
  const auto combined = left_.subViewNonConst(columns), product = right_.subViewNonConst(columns);
  for (int k = 0; k < blocks_.matrices; ++k) {
    {
      const auto in = read(y);
      const auto to = overwrite(*combined);
      const Small c = blocks_.uniform[k];
      Kokkos::parallel_for(
          "thixis::contact::combine", Range(0, in.extent_int(0)), KOKKOS_LAMBDA(int l) {
            for (int i = 0; i < rows; ++i) {
              double sum = 0;
              for (int j = 0; j < fields; ++j) sum += c(first + i, j) * in(l, j);
              to(l, i) = sum;
            }
          });
    }
    system_.S.matrix[k]->apply(*combined, *product);
    out.update(1, *product, 1);
  }
}

void TransformedOperator::diagonal(int first, MultiVector& out) const {
  algebra::Vector of_matrix(system_.map());
  out.putScalar(0);
  const int rows = static_cast<int>(out.getNumVectors());
  const TransformedBlocks blocks = blocks_;
  for (int k = 0; k < blocks_.matrices; ++k) {
    system_.S.matrix[k]->getLocalDiagCopy(of_matrix);
    const auto A = read(of_matrix);
    const auto to = out.getLocalViewDevice(Tpetra::Access::ReadWrite);
    Kokkos::parallel_for(
        "thixis::contact::diagonal", Range(0, to.extent_int(0)), KOKKOS_LAMBDA(int l) {
          Small room[most_matrices];
          const Small& c = blocks.at(l, l, room)[k];
          for (int i = 0; i < rows; ++i) to(l, i) += c(first + i, first + i) * A(l, 0);
        });
  }
}

void transpose_frames(const System& system, const MultiVector& r, MultiVector& y) {
  const auto in = read(r);
  const auto out = overwrite(y);
  const auto frames = system.constraint.frames;
  const int m = system.fields();
  Kokkos::parallel_for(
      "thixis::contact::to_coordinates", Range(0, in.extent_int(0)), KOKKOS_LAMBDA(int l) {
        const Small& T = frames.T(frames.at(l));
        for (int i = 0; i < m; ++i) {
          double sum = 0;
          for (int a = 0; a < m; ++a) sum += T(a, i) * in(l, a);
          out(l, i) = sum;
        }
      });
}

void apply_frames(const System& system, const MultiVector& y, MultiVector& u) {
  const auto in = read(y);
  const auto out = overwrite(u);
  const auto frames = system.constraint.frames;
  const int m = system.fields();
  Kokkos::parallel_for(
      "thixis::contact::to_fields", Range(0, in.extent_int(0)), KOKKOS_LAMBDA(int l) {
        const Small& T = frames.T(frames.at(l));
        for (int a = 0; a < m; ++a) {
          double sum = 0;
          for (int i = 0; i < m; ++i) sum += T(a, i) * in(l, i);
          out(l, a) = sum;
        }
      });
}

Kokkos::View<const LocalIndex*> points_of_nodes(const System& system) {
  const Kokkos::View<LocalIndex*> point("thixis::contact::point", algebra::local_size(*system.map()));
  Kokkos::deep_copy(point, -1);
  const auto node = system.constraint.node;
  Kokkos::parallel_for(
      "thixis::contact::points", Range(0, node.extent_int(0)), KOKKOS_LAMBDA(int p) { point(node(p)) = p; });
  return point;
}

}  // namespace thixis::contact
