#pragma once
#include <Kokkos_Core.hpp>

#include "thixis/algebra/fwd.hpp"

namespace thixis::method {

/// Unknowns of each element (cell, face, …): (element, i) -> local column index, -1 where there is none (Dirichlet).
using ElementUnknowns = Kokkos::View<const LocalIndex**, Kokkos::LayoutRight>;

/// Couples all unknowns of each element. Rows: the unknowns of `rows`, which are the first ones of `columns`; columns of a row are sorted.
algebra::GraphPtr make_graph(const algebra::MapPtr& rows, const algebra::MapPtr& columns, const ElementUnknowns& elements);

/// A(l, m) += local(e, i, j) for elements first, first+1, … with l, m their i-th, j-th unknowns; rows of other ranks are left to them.
void scatter(const ElementUnknowns& elements, LocalIndex first, const Kokkos::View<const double***, Kokkos::LayoutRight>& local,
             algebra::Matrix& A);
/// b(l) += local(e, i), likewise.
void scatter(const ElementUnknowns& elements, LocalIndex first, const Kokkos::View<const double**, Kokkos::LayoutRight>& local,
             algebra::Vector& b);

/// Elements are worked on in blocks of this size: local matrices stay in cache and are never held for the whole mesh.
constexpr LocalIndex block_size = 4096;

}  // namespace thixis::method
