#include "faces.hpp"

#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/to_view.hpp"
#include "thixis/method/cell_functions.hpp"
#include "thixis/method/evaluate.hpp"
#include "thixis/reference/modal.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::hho {
namespace {

using Table = Kokkos::View<const double**, Kokkos::LayoutRight>;

/// The points of a line rule on faces.
struct Place {
  View<double* [2]> coordinates;
  View<LocalIndex* [2]> face_vertices;
  View<const LocalIndex*> face;
  View<const double*> t;
  View<double*> x, y, length;  ///< out, overwritten: (e, q), flat; (e)

  KOKKOS_FUNCTION void operator()(int e) const {
    const LocalIndex a = face_vertices(face(e), 0), b = face_vertices(face(e), 1);
    const int points = t.extent_int(0);
    for (int q = 0; q < points; ++q) {
      x(e * points + q) = (1 - t(q)) * coordinates(a, 0) + t(q) * coordinates(b, 0);
      y(e * points + q) = (1 - t(q)) * coordinates(a, 1) + t(q) * coordinates(b, 1);
    }
    length(e) = mesh::face_geometry(coordinates, face_vertices, face(e)).length;
  }
};

/// (q, j): the weight of the rule at t_q times L_j.
Table weighted_legendre(const reference::Quadrature& rule, int p) {
  std::vector<double> weighted;
  for (int q = 0; q < rule.size(); ++q)
    for (const double L : reference::legendre(p, rule.point[q])) weighted.push_back(rule.weight[q] * L);
  return method::matrix_view("thixis::hho::weighted_legendre", rule.size(), p, weighted);
}

}  // namespace

std::vector<Face> faces_of(const method::Space& space) {
  const int p = space.basis().degree(), n = space.basis().size(), c = space.components();
  const LocalIndex cell_entries = space.coefficients().cell_entries / c;
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.coefficients().element_entries);
  const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.cells());
  std::vector<Face> faces((space.coefficients().entries.size() / c - cell_entries) / p);
  for (int k = 0; k < cells.extent_int(0); ++k)
    for (int f = 0; f < 3; ++f) {
      const LocalIndex entry = entries(k, c * (n + f * p)) / c;
      faces[(entry - cell_entries) / p] = {space.host().cell_faces(cells(k), f), entry};
    }
  return faces;
}

Projected project(const method::Space& space, const std::vector<Face>& faces, const std::vector<LocalIndex>& wanted, const scene::Field& g,
                  double t) {
  std::vector<LocalIndex> face, entry;
  for (const LocalIndex k : wanted) {
    face.push_back(faces[k].face);
    entry.push_back(faces[k].entry);
  }
  const auto rule = reference::line_quadrature(space.options().params.order());
  const int p = space.basis().degree(), points = rule.size(), count = static_cast<int>(wanted.size());
  Projected on;
  on.number = mesh::to_view("thixis::hho::number_of_face", wanted);
  on.face = mesh::to_view("thixis::hho::face", face);
  on.entry = mesh::to_view("thixis::hho::entry_of_face", entry);
  on.length = View<double*>("thixis::hho::face_length", count);
  on.coefficient = Moments("thixis::hho::projected", count, p);

  const View<double*> x("thixis::hho::face_x", count * points), y("thixis::hho::face_y", count * points),
      value("thixis::hho::face_values", count * points);
  Place kernel;
  kernel.coordinates = space.mesh().coordinates;
  kernel.face_vertices = space.mesh().face_vertices;
  kernel.face = on.face;
  kernel.t = mesh::to_view("thixis::hho::line_points", rule.point);
  kernel.x = x;
  kernel.y = y;
  kernel.length = on.length;
  Kokkos::parallel_for("thixis::hho::place", Kokkos::RangePolicy<>(0, count), kernel);
  method::evaluate(g, t, count * points, x, y, value);

  const Table weighted = weighted_legendre(rule, p);
  const Moments coefficient = on.coefficient;
  Kokkos::parallel_for(
      "thixis::hho::project", Kokkos::RangePolicy<>(0, count), KOKKOS_LAMBDA(int e) {
        for (int j = 0; j < p; ++j)
          for (int q = 0; q < points; ++q) coefficient(e, j) += weighted(q, j) * value(e * points + q);
      });
  return on;
}

}  // namespace thixis::hho
