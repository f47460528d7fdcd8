#include "step/places.hpp"

#include <fmt/format.h>

#include "thixis/core/error.hpp"
#include "thixis/core/text.hpp"
#include "thixis/fv/host.hpp"
#include "thixis/mesh/groups.hpp"

namespace thixis::flow {
namespace {

constexpr double negligible = 1e-9;  // of the pressures of which that of the gas is the sum

enum class Fault { none, saturation, fraction, pressure };

KOKKOS_INLINE_FUNCTION Fault fault(const TwoPhaseLaws& laws, double s_g, double P, double chi) {
  if (!(s_g >= 0 && laws.e_of(s_g) < TwoPhaseLaws::dry)) return Fault::saturation;
  if (!(chi >= 0 && chi <= 1)) return Fault::fraction;
  using Kokkos::Experimental::fabs;
  using Kokkos::Experimental::fmax;
  const double P_g = P + laws.capillary(s_g).value;
  return P_g >= -negligible * fmax(fabs(P), fabs(P_g - P)) ? Fault::none : Fault::pressure;
}

struct FirstFault {
  TwoPhaseLaws laws;
  StateValues at;
  KOKKOS_FUNCTION void operator()(LocalIndex i, LocalIndex& first) const {
    if (i < first && fault(laws, at.s_g(i), at.P(i), at.chi(i)) != Fault::none) first = i;
  }
};

/// What is wrong with a state, in a clause.
std::string sentence(const TwoPhaseLaws& laws, double s_g, double P, double chi) {
  switch (fault(laws, s_g, P, chi)) {
    case Fault::saturation:
      return fmt::format("the gas saturation is {}; it must not be negative, and leave more liquid than S_lr.", core::to_text(s_g));
    case Fault::fraction:
      return fmt::format("chi is {}; a molar fraction lies between 0 and 1.", core::to_text(chi));
    case Fault::pressure:
      return fmt::format(
          "P is {}, and the pressure of the gas, P + P_cp(s_g) = {}, is negative; write a larger P (in Pa, counted from vacuum).",
          core::to_text(P), core::to_text(P + laws.capillary(s_g).value));
    case Fault::none:
      break;
  }
  return "";
}

double value_at(const fv::View<double*>& values, LocalIndex i) {
  double value = 0;
  Kokkos::deep_copy(value, Kokkos::subview(values, i));
  return value;
}

Places places_of(const std::vector<LocalIndex>& index, const fv::HostView<double* [2]>& centre) {
  Places places{fv::View<LocalIndex*>("thixis::flow::places", index.size()), {}, {}};
  const auto to = Kokkos::create_mirror_view(places.index);
  for (std::size_t i = 0; i < index.size(); ++i) {
    to(i) = index[i];
    places.x.push_back(centre(index[i], 0));
    places.y.push_back(centre(index[i], 1));
  }
  Kokkos::deep_copy(places.index, to);
  return places;
}

}  // namespace

fv::View<double*> Places::values(const scene::FieldPtr& field, double t) const {
  const fv::View<double*> values("thixis::flow::values", x.size());
  if (!field) return values;
  const auto host = Kokkos::create_mirror_view(values);
  field->evaluate({x.size(), x.data(), y.data()}, t, host.data());
  Kokkos::deep_copy(values, host);
  return values;
}

Places centres(const fv::Grid& grid) {
  std::vector<LocalIndex> cells;
  for (LocalIndex K = 0; K < grid.owned_cells; ++K) cells.push_back(K);
  return places_of(cells, Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), grid.centre));
}

Places part_of_boundary(const fv::Grid& grid, const std::string& name) {
  const auto tag = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), grid.face_tag);
  std::vector<LocalIndex> faces;
  for (LocalIndex F = 0; F < grid.faces; ++F)
    if (tag(F) >= 0 && mesh::is_in_group(grid.tags[tag(F)], name)) faces.push_back(F);
  return places_of(faces, Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), grid.face_centre));
}

StateValues states_at(const FlowState& state, const TwoPhaseLaws& laws, const Places& places, double t, const std::string& path) {
  const StateValues at{places.values(state.s_g, t), places.values(state.P, t), places.values(state.chi, t)};
  LocalIndex first = places.count();
  Kokkos::parallel_reduce("thixis::flow::first_fault", Kokkos::RangePolicy<>(0, places.count()), FirstFault{laws, at},
                          Kokkos::Min<LocalIndex>(first));
  if (first >= places.count()) return at;
  throw core::InputError(fmt::format("scene/flow/{}: at ({}, {}) {}", path, core::to_text(places.x[first]), core::to_text(places.y[first]),
                                     sentence(laws, value_at(at.s_g, first), value_at(at.P, first), value_at(at.chi, first))));
}

}  // namespace thixis::flow
