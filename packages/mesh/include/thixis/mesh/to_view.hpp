#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

/// A mirror that is only read.
template <class Data>
using ConstHostView = Kokkos::View<Data, Kokkos::LayoutRight, Kokkos::HostSpace>;

/// An array of the host as a View.
template <class T>
View<T*> to_view(const std::string& label, const std::vector<T>& values) {
  const View<T*> view(Kokkos::view_alloc(Kokkos::WithoutInitializing, label), values.size());
  const auto host = Kokkos::create_mirror_view(view);
  std::copy(values.begin(), values.end(), host.data());
  Kokkos::deep_copy(view, host);
  return view;
}

}  // namespace thixis::mesh
