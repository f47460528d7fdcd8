#include "thixis/fv/entry.hpp"

namespace thixis::fv {

/// Cell-centred finite volumes with two-point fluxes: models build their systems on thixis/fv/grid.hpp themselves.
method::Method entry() {
  method::Method fv;
  fv.name = "fv";
  fv.title = "finite volumes";
  fv.triangles = false;
  fv.unknowns_per_cell = [](const method::MethodParams&) { return 1.0; };
  return fv;
}

}  // namespace thixis::fv
