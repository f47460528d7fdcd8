#include "membrane_operator.hpp"

namespace thixis::models {

using Execution = algebra::Vector::execution_space;

void split(const algebra::Vector& X, algebra::MultiVector& fields) {
  const auto x = X.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto columns = fields.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const int width = columns.extent_int(1);
  Kokkos::parallel_for(
      "thixis::models::split", Kokkos::RangePolicy<Execution>(0, columns.extent_int(0)), KOKKOS_LAMBDA(int l) {
        for (int f = 0; f < width; ++f) columns(l, f) = x(width * l + f, 0);
      });
}

void join(const algebra::MultiVector& fields, algebra::Vector& X) {
  const auto columns = fields.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto x = X.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const int width = columns.extent_int(1);
  Kokkos::parallel_for(
      "thixis::models::join", Kokkos::RangePolicy<Execution>(0, columns.extent_int(0)), KOKKOS_LAMBDA(int l) {
        for (int f = 0; f < width; ++f) x(width * l + f, 0) = columns(l, f);
      });
}

}  // namespace thixis::models
