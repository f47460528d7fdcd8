#include "scene/exact_gradient.hpp"

#include "thixis/mesh/statistics.hpp"

namespace thixis::membranes {

std::array<scene::FieldPtr, 2> exact_gradient(const ExactMembranes& exact, int alpha, const mesh::Mesh& mesh) {
  constexpr double step = 1e-6;  // of the diagonal
  if (exact.gradient[alpha][0]) return exact.gradient[alpha];
  return scene::difference_gradient(exact.u[alpha], step * mesh::bounding_box(mesh).diagonal());
}

}  // namespace thixis::membranes
