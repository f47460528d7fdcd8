#include "thixis/method/flux_density.hpp"

#include "thixis/method/cell_functions.hpp"
#include "thixis/method/gradient_form.hpp"
#include "thixis/reference/flux_moments.hpp"

namespace thixis::method {

FluxDensity flux_density(const mesh::Mesh& mesh, const CellQuadrature& quadrature, int degree, const scene::Field& tension) {
  FluxDensity density;
  density.quadrature = quadrature;
  density.B = reference::bernstein(degree);
  density.C = matrix_view("thixis::method::modal_to_bernstein", density.B.size, density.B.size, reference::modal_to_bernstein(density.B));
  if (const double* mu = tension.constant()) density.constant = *mu;
  else density.mu = tension_at_points(mesh, quadrature, tension);
  return density;
}

}  // namespace thixis::method
