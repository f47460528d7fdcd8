#include "face_data.hpp"

#include "thixis/algebra/tpetra.hpp"

namespace thixis::dg {
namespace {

/// Physical points of the rule on a face, from its lower to its higher vertex id.
void place(const mesh::HostMesh& mesh, LocalIndex F, const Traces& at, double* x, double* y) {
  const LocalIndex a = mesh.face_vertices(F, 0), b = mesh.face_vertices(F, 1);
  for (int q = 0; q < at.points(); ++q) {
    x[q] = (1 - at.t(q)) * mesh.coordinates(a, 0) + at.t(q) * mesh.coordinates(b, 0);
    y[q] = (1 - at.t(q)) * mesh.coordinates(a, 1) + at.t(q) * mesh.coordinates(b, 1);
  }
}

/// The same, but so little inside K that a function which jumps across F shows its trace from K.
void place_inside(const mesh::HostMesh& mesh, LocalIndex K, LocalIndex F, const Traces& at, double* x, double* y) {
  constexpr double inside = 1e-10;
  double centroid[2] = {0, 0};
  for (int a = 0; a < 3; ++a)
    for (int d = 0; d < 2; ++d) centroid[d] += mesh.coordinates(mesh.cell_vertices(K, a), d) / 3;
  place(mesh, F, at, x, y);
  for (int q = 0; q < at.points(); ++q) {
    x[q] += inside * (centroid[0] - x[q]);
    y[q] += inside * (centroid[1] - y[q]);
  }
}

}  // namespace

Traces traces_for(const method::Space& space, const scene::Field& tension) {
  return traces(space.basis(), tension.constant() ? 2 * space.basis().degree() : space.options().params.order());
}

FaceTension::FaceTension(const method::Space& space, const Faces& faces, const Traces& traces, const scene::Field& tension)
    : space_(space), faces_(faces), traces_(traces), tension_(tension) {}

const Tensions& FaceTension::at(LocalIndex first, LocalIndex count) {
  if (mu_.extent_int(0) < count) {
    mu_ = Tensions("thixis::dg::face_tension", count, traces_.points());
    if (const double* value = tension_.constant()) Kokkos::deep_copy(mu_, *value);
  }
  if (!tension_.constant()) evaluate(first, count);
  return mu_;
}

void FaceTension::evaluate(LocalIndex first, LocalIndex count) {
  const auto face = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), faces_.face);
  const auto cell = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), faces_.cell);
  const auto host = Kokkos::create_mirror_view(mu_);
  const int points = traces_.points();
  std::vector<double> x(count * points), y(x.size()), values(x.size());
  for (int s = 0; s < 2; ++s) {
    for (LocalIndex e = 0; e < count; ++e) {
      const LocalIndex k = first + e, K = cell(k, cell(k, s) >= 0 ? s : 1 - s);
      place_inside(space_.host(), K, face(k), traces_, &x[e * points], &y[e * points]);
    }
    tension_.evaluate({x.size(), x.data(), y.data()}, 0, values.data());
    for (LocalIndex e = 0; e < count; ++e)
      for (int q = 0; q < points; ++q) host(e, q, s) = values[e * points + q];
  }
  Kokkos::deep_copy(mu_, host);
}

BoundaryPoints::BoundaryPoints(const method::Space& space, LocalIndex tag, const Traces& traces) {
  const mesh::HostMesh& mesh = space.host();
  for (LocalIndex F = 0; F < space.mesh().faces; ++F)
    if (mesh.face_tag(F) == tag && mesh::first_cell(mesh.face_cells, F) < space.mesh().owned_cells) faces.push_back(F);
  const std::size_t points = traces.points(), count = faces.size() * points;
  for (auto* coordinate : {&x, &y, &inside_x, &inside_y}) coordinate->resize(count);
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const LocalIndex F = faces[k];
    place(mesh, F, traces, &x[k * points], &y[k * points]);
    place_inside(mesh, mesh::first_cell(mesh.face_cells, F), F, traces, &inside_x[k * points], &inside_y[k * points]);
  }
}

std::vector<double> BoundaryPoints::values(const scene::Field& field, double t) const {
  std::vector<double> values(x.size());
  field.evaluate({x.size(), x.data(), y.data()}, t, values.data());
  return values;
}

std::vector<double> BoundaryPoints::values_inside(const scene::Field& field) const {
  std::vector<double> values(x.size());
  field.evaluate({x.size(), inside_x.data(), inside_y.data()}, 0, values.data());
  return values;
}

void add_weakly(const method::Space& space, const Penalty& penalty, const scene::Field& tension, const scene::Field& dirichlet,
                LocalIndex tag, double t, algebra::Vector& load) {
  const mesh::HostMesh& mesh = space.host();
  const Traces at = traces(space.basis(), space.options().params.order());
  const auto columns = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.elements());
  const auto out = algebra::host_view(load);
  const std::size_t points = at.points();
  const BoundaryPoints on(space, tag, at);
  const auto g = on.values(dirichlet, t), mu = on.values_inside(tension);
  for (std::size_t k = 0; k < on.faces.size(); ++k) {
    const LocalIndex F = on.faces[k], K = mesh::first_cell(mesh.face_cells, F);
    const auto cell = mesh::cell_geometry(mesh.coordinates, mesh.cell_vertices, K);
    const auto face = mesh::face_geometry(mesh.coordinates, mesh.face_vertices, F);
    const double outward = mesh::normal_sign(mesh.face_cells, F, K);
    const int f = mesh::local_face(mesh.cell_faces, K, F),
              side = 2 * f + (mesh.face_vertices(F, 0) == mesh.cell_vertices(K, (f + 1) % 3) ? 0 : 1);
    for (int i = 0; i < space.basis().size(); ++i) {
      double sum = 0;
      for (std::size_t q = 0; q < points; ++q) {
        double slope = 0;
        for (int a = 0; a < 3; ++a)
          slope += at.derivative(side, q, i, a) * outward * (face.normal[0] * cell.gradient[a][0] + face.normal[1] * cell.gradient[a][1]);
        sum += at.weight(q) * face.length * mu[k * points + q] * g[k * points + q] *
               (penalty.eta / face.length * at.value(side, q, i) - penalty.theta * slope);
      }
      out(columns(space.position(K), i)) += sum;
    }
  }
}

}  // namespace thixis::dg
