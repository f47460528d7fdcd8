#pragma once
#include "thixis/method/form.hpp"

/// The forms of continuous finite elements. A space must outlive its forms.
namespace thixis::fem {

/// a(u, v) = (mu grad u, grad v), with the energy ∫ mu |grad u|². Scalar spaces.
method::FormPtr diffusion(const method::Space& space, const scene::FieldPtr& tension);

/// Linear elasticity in plane strain, of spaces with two components:
///
///     a(u, v) = (2 mu eps(u), eps(v)) + (lambda div u, div v),     eps(u) = (grad u + grad uᵀ)/2,
///
/// with the Lamé parameters mu > 0, lambda + mu > 0, and the energy a(u, u). Loads are forces f and, on the Neumann boundary, tractions
/// sigma n, component by component. Forms of it throw InputError where the parameters are not such.
method::FormPtr elasticity(const method::Space& space, const scene::FieldPtr& mu, const scene::FieldPtr& lambda);

}  // namespace thixis::fem
