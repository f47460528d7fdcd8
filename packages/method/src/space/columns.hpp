#pragma once
#include "thixis/mesh/mesh.hpp"
#include "thixis/method/graph.hpp"

namespace thixis::method {

/// (element, i) -> column from (element, i) -> entry, -1 where there is none.
ElementUnknowns columns_of(const Kokkos::View<LocalIndex**, Kokkos::LayoutRight>& entries, const mesh::View<LocalIndex*>& column_of_entry);

}  // namespace thixis::method
