#include "thixis/mesh/locate.hpp"

#include <algorithm>
#include <limits>

#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::mesh {
namespace {

constexpr double slack = 1e-9;  // of barycentric coordinates: points on an edge, but for rounding
constexpr GlobalIndex none = std::numeric_limits<GlobalIndex>::max();

/// The place in K, whether or not K holds the point.
Place place_in(const HostMesh& mesh, LocalIndex K, const std::array<double, 2>& point) {
  const auto geometry = cell_geometry(mesh.coordinates, mesh.cell_vertices, K);
  const LocalIndex origin = mesh.cell_vertices(K, 0);
  const double dx = point[0] - mesh.coordinates(origin, 0), dy = point[1] - mesh.coordinates(origin, 1);
  Place place;
  place.cell = K;
  place.xi = geometry.gradient[1][0] * dx + geometry.gradient[1][1] * dy;
  place.eta = geometry.gradient[2][0] * dx + geometry.gradient[2][1] * dy;
  place.inside = std::min({place.xi, place.eta, 1 - place.xi - place.eta}) >= -slack;
  return place;
}

}  // namespace

std::vector<Place> locate(const Mesh& mesh, const std::vector<std::array<double, 2>>& points) {
  const auto host = on_host(mesh);
  std::vector<Place> places(points.size());
  std::vector<GlobalIndex> id(points.size(), none);
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (std::size_t i = 0; i < points.size(); ++i)
      if (const Place here = place_in(host, K, points[i]); here.inside && mesh.cell_id[K] < id[i]) {
        places[i] = here;
        id[i] = mesh.cell_id[K];
      }
  auto lowest = id;
  mesh.comm.min(lowest);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (id[i] != lowest[i]) places[i] = Place{};
    places[i].inside = lowest[i] != none;
  }
  return places;
}

}  // namespace thixis::mesh
