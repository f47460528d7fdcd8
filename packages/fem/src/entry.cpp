#include "thixis/fem/entry.hpp"

#include "thixis/fem/forms.hpp"
#include "thixis/fem/lagrange_space.hpp"

namespace thixis::fem {

method::Method entry() {
  method::Method fem;
  fem.name = "fem";
  fem.title = "continuous finite elements";
  fem.uses = {"method/degree", "method/nodes", "method/quadrature order"};
  fem.make_space = make_lagrange_space;
  fem.diffusion = diffusion;
  fem.interior = {[](const method::MethodParams& params) { return params.degree >= 3; }, "method/degree = 3 or 4", false};
  fem.bounded_in_time = fem.published_bound = true;
  fem.unknowns_per_cell = [](const method::MethodParams& params) { return params.degree * params.degree / 2.0; };
  return fem;
}

}  // namespace thixis::fem
