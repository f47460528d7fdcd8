#pragma once
#include <Kokkos_Core.hpp>
#include <string>

#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"

/// What all refinements do with vertices.
namespace thixis::mesh {

/// Keeps the vertices of the coarse level: same local number, same id.
struct KeepVertices {
  const Mesh& coarse;
  HostMesh in;
  Mesh& fine;
  HostMesh out;  ///< first in.vertices entries written

  void operator()(LocalIndex v) const {
    for (int d = 0; d < 2; ++d) {
      out.parameter(v, d) = in.parameter(v, d);
      out.coordinates(v, d) = in.coordinates(v, d);
    }
    fine.vertex_id[v] = coarse.vertex_id[v];
    fine.vertex_owner[v] = coarse.vertex_owner[v];
    fine.vertex_parents[v] = {v, v};
  }
};

/// Puts the vertex m of the fine level on the face F of the coarse one.
inline void put_on_midpoint(const HostMesh& in, LocalIndex F, LocalIndex m, Mesh& fine, const HostMesh& out) {
  const LocalIndex a = in.face_vertices(F, 0), b = in.face_vertices(F, 1);
  const double x = 0.5 * (in.parameter(a, 0) + in.parameter(b, 0)), y = 0.5 * (in.parameter(a, 1) + in.parameter(b, 1));
  const Point point = physical(fine.chart, {x, y});
  out.parameter(m, 0) = x, out.parameter(m, 1) = y;
  out.coordinates(m, 0) = point.x, out.coordinates(m, 1) = point.y;
  fine.vertex_parents[m] = {a, b};
}

template <class Kernel>
void launch(const std::string& name, LocalIndex size, const Kernel& kernel) {
  Kokkos::parallel_for("thixis::mesh::" + name,
                       Kokkos::RangePolicy<Kokkos::DefaultHostExecutionSpace, Kokkos::IndexType<LocalIndex>>(0, size), kernel);
}

}  // namespace thixis::mesh
