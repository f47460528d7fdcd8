#include "thixis/dg/space.hpp"

#include <fmt/core.h>

#include "layout.hpp"
#include "thixis/core/error.hpp"
#include "thixis/dg/params.hpp"
#include "thixis/mesh/geometry.hpp"

namespace thixis::dg {

std::unique_ptr<method::Space> make_space(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  auto structure = method::in_components(options, [&](const method::SpaceOptions& scalar) { return layout(mesh, scalar); });
  return std::make_unique<method::Space>(mesh, options, std::move(structure), std::make_unique<method::Layout>());
}

double sufficient_penalty(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  const auto host = mesh::on_host(mesh);
  double largest = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
    double sum = 0;
    for (int f = 0; f < 3; ++f) {
      const LocalIndex F = host.cell_faces(K, f), tag = host.face_tag(F);
      const double weight = tag < 0 ? 1 : options.dirichlet[tag] && !strong(options) ? 2 : 0;
      const double length = mesh::face_geometry(host.coordinates, host.face_vertices, F).length;
      sum += weight * length * length;
    }
    largest = std::max(largest, sum / mesh::cell_area(host.coordinates, host.cell_vertices, K));
  }
  return (1 + 1.0 / options.params.degree) / 4 * mesh.comm.max(largest);
}

void check_mesh(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  const Params& own = options.params.own.get<Params>();
  if (own.variant == Variant::nipg) return;
  const double needed = sufficient_penalty(mesh, options);
  if (own.penalty > needed) return;
  throw core::InputError(fmt::format(
      "method/penalty: {:g} is too small for sipg on this mesh, whose thinnest cell asks for more than {:.3g}; write at least {:.3g}, "
      "or method/variant = nipg, which takes any penalty.",
      own.penalty, needed, 1.1 * needed));
}

}  // namespace thixis::dg
