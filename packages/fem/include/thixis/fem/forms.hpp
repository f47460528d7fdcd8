#pragma once
#include "thixis/method/form.hpp"

/// The forms of continuous finite elements. A space must outlive its forms.
namespace thixis::fem {

/// a(u, v) = (mu grad u, grad v), with the energy ∫ mu |grad u|². Scalar spaces.
method::FormPtr diffusion(const method::Space& space, const scene::FieldPtr& tension);

}  // namespace thixis::fem
