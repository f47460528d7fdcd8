#include "feasible/averages.hpp"

namespace thixis::bound {
namespace {

struct Mean {
  View<const LocalIndex*> offset, source;
  method::Coefficients u;
  View<const double*> held;
  View<double*> average;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const LocalIndex first = offset(e), last = offset(e + 1);
    double sum = 0;
    for (LocalIndex i = first; i < last; ++i) sum += u(source(i));
    average(e) = first == last ? held(e) : sum / (last - first);
  }
};

}  // namespace

Averages::Averages(const method::Space& space, const ContinuousNodes& nodes) {
  const auto node = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), nodes.of_cells);
  const auto of_u = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.coefficients().element_entries);
  const LocalIndex count = nodes.entries.size();
  const int n = space.basis().size();
  const View<LocalIndex*> offset("thixis::bound::average_offset", count + 1);
  const auto offset_host = Kokkos::create_mirror_view(offset);
  const auto free = [&](LocalIndex e) { return nodes.entries.held[e] < 0; };
  for (std::size_t k = 0; k < node.extent(0); ++k)
    for (int l = 0; l < n; ++l) offset_host(node(k, l) + 1) += free(node(k, l));
  for (LocalIndex e = 0; e < count; ++e) offset_host(e + 1) += offset_host(e);
  const View<LocalIndex*> source("thixis::bound::average_source", offset_host(count));
  const auto source_host = Kokkos::create_mirror_view(source);
  std::vector<LocalIndex> next(offset_host.data(), offset_host.data() + count);
  for (std::size_t k = 0; k < node.extent(0); ++k)
    for (int l = 0; l < n; ++l)
      if (free(node(k, l))) source_host(next[node(k, l)]++) = of_u(k, l);
  Kokkos::deep_copy(offset, offset_host);
  Kokkos::deep_copy(source, source_host);
  offset_ = offset;
  source_ = source;
}

void Averages::operator()(const method::Coefficients& u, const View<const double*>& held, const View<double*>& average) const {
  Kokkos::parallel_for("thixis::bound::averages", Kokkos::RangePolicy<>(0, average.extent_int(0)),
                       Mean{offset_, source_, u, held, average});
}

}  // namespace thixis::bound
