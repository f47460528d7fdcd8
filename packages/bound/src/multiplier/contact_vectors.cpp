#include "multiplier/contact_vectors.hpp"

#include "thixis/algebra/tpetra.hpp"

namespace thixis::bound {
namespace {

using algebra::Vector;
using Range = Kokkos::RangePolicy<Vector::execution_space>;

auto read(const Vector& x) { return x.getLocalViewDevice(Tpetra::Access::ReadOnly); }

}  // namespace

Vector at_unknowns(const method::Space& space, const Vector& at_points) {
  Vector all(space.map());
  const auto in = read(at_points);
  const auto out = all.getLocalViewDevice(Tpetra::Access::ReadWrite);
  Kokkos::parallel_for(
      "thixis::bound::at_unknowns", Range(0, in.extent_int(0)), KOKKOS_LAMBDA(int l) { out(l, 0) = in(l, 0); });
  return all;
}

void split_multiplier(const method::Space& space, const Vector& X3, Vector& above, Vector& below) {
  const auto lambda = read(X3), D = read(space.pairing());
  const auto plus = above.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const auto minus = below.getLocalViewDevice(Tpetra::Access::ReadWrite);
  Kokkos::parallel_for(
      "thixis::bound::split_multiplier", Range(0, lambda.extent_int(0)), KOKKOS_LAMBDA(int l) {
        const double value = lambda(l, 0);
        plus(l, 0) = D(l, 0) * (value < 0 ? 0 : value);
        minus(l, 0) = -D(l, 0) * (value > 0 ? 0 : value);
      });
}

Vector contact_products(const method::Space& space, const Vector& M, const Vector& K) {
  Vector product(space.map());
  const auto moment = read(M), gap = read(K);
  const auto out = product.getLocalViewDevice(Tpetra::Access::ReadWrite);
  Kokkos::parallel_for(
      "thixis::bound::contact_products", Range(0, moment.extent_int(0)),
      KOKKOS_LAMBDA(int l) { out(l, 0) = moment(l, 0) * (gap(l, 0) < 0 ? 0 : gap(l, 0)); });
  return product;
}

}  // namespace thixis::bound
