#include "face_data.hpp"

#include "thixis/mesh/to_view.hpp"
#include "thixis/method/evaluate.hpp"

namespace thixis::dg {
namespace {

struct Place {
  View<double* [2]> coordinates;
  View<LocalIndex* [3]> cell_vertices;
  View<LocalIndex* [2]> face_vertices;
  Faces faces;
  View<const double*> t;
  int side;
  LocalIndex first;
  PointValues x, y;  ///< out, overwritten

  static constexpr double inside = 1e-10;

  KOKKOS_FUNCTION void operator()(int e) const {
    const LocalIndex k = first + e, F = faces.face(k), a = face_vertices(F, 0), b = face_vertices(F, 1);
    const int points = t.extent_int(0);
    for (int d = 0; d < 2; ++d) {
      const PointValues& out = d == 0 ? x : y;
      const double centroid = side == on_face ? 0 : centre(k, d);
      for (int q = 0; q < points; ++q) {
        const double at = (1 - t(q)) * coordinates(a, d) + t(q) * coordinates(b, d);
        out(e * points + q) = side == on_face ? at : at + inside * (centroid - at);
      }
    }
  }

  KOKKOS_FUNCTION double centre(LocalIndex k, int d) const {
    const LocalIndex K = faces.cell(k, faces.cell(k, side) >= 0 ? side : 1 - side);
    double sum = 0;
    for (int a = 0; a < 3; ++a) sum += coordinates(cell_vertices(K, a), d) / 3;
    return sum;
  }
};

Faces with_tag(const method::Space& space, LocalIndex tag) {
  const mesh::HostMesh& mesh = space.host();
  std::vector<LocalIndex> faces;
  for (LocalIndex F = 0; F < space.mesh().faces; ++F)
    if (mesh.face_tag(F) == tag && mesh::first_cell(mesh.face_cells, F) < space.mesh().owned_cells) faces.push_back(F);
  return faces_of(space.mesh(), mesh::to_view("thixis::dg::tagged_faces", faces));
}

}  // namespace

PointValues FacePoints::values(const scene::Field& field, double t) const {
  const PointValues values("thixis::dg::face_values", size());
  method::evaluate(field, t, size(), x, y, values);
  return values;
}

void place(const mesh::Mesh& mesh, const Faces& faces, const Traces& traces, int side, LocalIndex first, LocalIndex count,
           const FacePoints& points) {
  Place kernel;
  kernel.coordinates = mesh.coordinates;
  kernel.cell_vertices = mesh.cell_vertices;
  kernel.face_vertices = mesh.face_vertices;
  kernel.faces = faces;
  kernel.t = traces.t;
  kernel.side = side;
  kernel.first = first;
  kernel.x = points.x;
  kernel.y = points.y;
  Kokkos::parallel_for("thixis::dg::place", Kokkos::RangePolicy<>(0, count), kernel);
}

Traces traces_for(const method::Space& space, const scene::Field& tension) {
  return traces(space.basis(), tension.constant() ? 2 * space.basis().degree() : space.options().params.order());
}

FaceTension::FaceTension(const method::Space& space, const Faces& faces, const Traces& traces, const scene::Field& tension)
    : space_(space), faces_(faces), traces_(traces), tension_(tension) {}

const Tensions& FaceTension::at(LocalIndex first, LocalIndex count) {
  if (mu_.extent_int(0) < count) {
    mu_ = Tensions("thixis::dg::face_tension", count, traces_.points());
    if (const double* value = tension_.constant()) {
      Kokkos::deep_copy(mu_, *value);
    } else {
      points_ = FacePoints(static_cast<std::size_t>(count) * traces_.points());
      values_ = PointValues("thixis::dg::tension_at_points", points_.size());
    }
  }
  if (!tension_.constant()) evaluate(first, count);
  return mu_;
}

void FaceTension::evaluate(LocalIndex first, LocalIndex count) {
  const int points = traces_.points();
  const Tensions mu = mu_;
  const PointValues values = values_;
  for (int s = 0; s < 2; ++s) {
    place(space_.mesh(), faces_, traces_, s, first, count, points_);
    method::evaluate(tension_, 0, count * points, points_.x, points_.y, values);
    Kokkos::parallel_for(
        "thixis::dg::face_tension", Kokkos::RangePolicy<>(0, count), KOKKOS_LAMBDA(int e) {
          for (int q = 0; q < points; ++q) mu(e, q, s) = values(e * points + q);
        });
  }
}

BoundaryData boundary_data(const method::Space& space, LocalIndex tag, const Traces& traces, const scene::Field& data, double t,
                           const scene::Field* tension) {
  BoundaryData on;
  on.faces = with_tag(space, tag);
  const FacePoints points(static_cast<std::size_t>(on.size()) * traces.points());
  place(space.mesh(), on.faces, traces, on_face, 0, on.size(), points);
  on.data = points.values(data, t);
  if (tension) {
    place(space.mesh(), on.faces, traces, 0, 0, on.size(), points);
    on.mu = points.values(*tension, 0);
  } else {
    on.mu = PointValues("thixis::dg::face_values", points.size());
    Kokkos::deep_copy(on.mu, 1);
  }
  return on;
}

}  // namespace thixis::dg
