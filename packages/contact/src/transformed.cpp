#include "transformed.hpp"

namespace thixis::contact {
namespace {

using algebra::MultiVector;
using Range = Kokkos::RangePolicy<algebra::Vector::execution_space>;

auto read(const MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadOnly); }

/// out_l = M in_l or Mᵀ in_l, M that of the node's kind.
template <class In, class Out>
struct AtNodes {
  Frames frames;
  Kokkos::View<const Small*> M;  ///< (kind)
  bool transposed;
  int fields;
  In in;
  Out out;  ///< overwritten; may be `in`

  KOKKOS_FUNCTION void operator()(int l) const {
    const Small& of_node = M(frames.at(l));
    double x[most_fields];
    for (int j = 0; j < fields; ++j) x[j] = in(l, j);
    for (int i = 0; i < fields; ++i) {
      double sum = 0;
      for (int j = 0; j < fields; ++j) sum += (transposed ? of_node(j, i) : of_node(i, j)) * x[j];
      out(l, i) = sum;
    }
  }
};

void at_nodes(const char* name, const System& system, const Kokkos::View<const Small*>& M, bool transposed, const MultiVector& x,
              MultiVector& y) {
  const auto in = read(x);
  const auto out = y.getLocalViewDevice(Tpetra::Access::ReadWrite);
  AtNodes<std::decay_t<decltype(in)>, std::decay_t<decltype(out)>> kernel;
  kernel.frames = system.constraint.frames;
  kernel.M = M;
  kernel.transposed = transposed;
  kernel.fields = system.fields();
  kernel.in = in;
  kernel.out = out;
  Kokkos::parallel_for(name, Range(0, in.extent_int(0)), kernel);
}

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

TransformedOperator::TransformedOperator(const System& system, const Teuchos::RCP<MultiVector>& product)
    : system_(system), blocks_(system, all_coordinates(system.fields())), product_(product) {
  if (blocks_.frames.uniform())
    uniform_ = BlockOperator{blocks_.fields, system.S.matrix, {blocks_.uniform, blocks_.uniform + blocks_.matrices}, nullptr};
  else u_ = Teuchos::rcp(new MultiVector(system.map(), system.fields()));
}

void TransformedOperator::apply(const MultiVector& y, MultiVector& out) const {
  if (u_.is_null()) return uniform_.apply(y, out, *product_);
  apply_frames(system_, y, *u_);
  system_.S.apply(*u_, out, *product_);
  transpose_frames(system_, out, out);
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

void apply_frames(const System& system, const MultiVector& y, MultiVector& u) {
  at_nodes("thixis::contact::to_fields", system, system.constraint.frames.T, false, y, u);
}
void transpose_frames(const System& system, const MultiVector& r, MultiVector& y) {
  at_nodes("thixis::contact::to_coordinates", system, system.constraint.frames.T, true, r, y);
}
void leave_frames(const System& system, const MultiVector& y, MultiVector& r) {
  at_nodes("thixis::contact::out_of_coordinates", system, system.constraint.frames.inverse, true, y, r);
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
