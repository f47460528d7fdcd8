#pragma once
#include "thixis/algebra/tpetra.hpp"

/// Vectors in kernels.
namespace thixis::flow {

using Cells = Kokkos::RangePolicy<algebra::Vector::execution_space>;
using VectorIn = decltype(std::declval<const algebra::Vector&>().getLocalViewDevice(Tpetra::Access::ReadOnly));
using VectorOut = decltype(std::declval<algebra::Vector&>().getLocalViewDevice(Tpetra::Access::ReadWrite));

inline VectorIn read(const algebra::Vector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadOnly); }
inline VectorOut write(algebra::Vector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadWrite); }

}  // namespace thixis::flow
