#pragma once
#include <Kokkos_Core.hpp>
#include <array>
#include <vector>

#include "thixis/scene/field.hpp"

namespace thixis::method {

/// What a field does on the boundary: for each tag of the mesh a value g (Dirichlet) or t, what the form exerts there, mu du/dn for
/// diffusion (Neumann); the other is null. Of c components, component i of a tag is at c tag + i.
struct BoundaryValues {
  std::vector<scene::FieldPtr> dirichlet, neumann;
};

/// Gradient of a known function.
using Gradient = std::array<scene::FieldPtr, 2>;

/// All coefficients of a discrete function that this rank needs: unknowns, Dirichlet values and ghosts, in a numbering of the space.
using Coefficients = Kokkos::View<double*>;

/// A function with as many components as a space has, made of a scalar function or of one for each component, which must outlive it.
class Function {
 public:
  Function(const scene::Field& scalar) : components_{&scalar} {}
  Function(const std::vector<scene::FieldPtr>& components) {
    for (const auto& component : components) components_.push_back(component.get());
  }
  int components() const { return static_cast<int>(components_.size()); }
  const scene::Field& operator[](int i) const { return *components_[i]; }

 private:
  std::vector<const scene::Field*> components_;
};

}  // namespace thixis::method
