#include "thixis/method/values_at.hpp"

namespace thixis::method {

std::vector<double> values_at(const Space& space, const std::vector<mesh::Place>& places, const Coefficients& u) {
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.coefficients().element_entries);
  const auto u_host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), u);
  std::vector<double> values(places.size(), 0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const mesh::Place& place = places[i];
    if (place.cell < 0) continue;
    const double at[2] = {place.xi, place.eta};
    const auto table = space.basis().tabulate(1, at);
    for (int l = 0; l < space.basis().size(); ++l) values[i] += table.value[l] * u_host(entries(place.cell, l));
  }
  space.mesh().comm.sum(values);
  return values;
}

}  // namespace thixis::method
