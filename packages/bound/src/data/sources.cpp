#include "data/sources.hpp"

#include <algorithm>
#include <cmath>

#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/method/gradient_form.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::bound {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Modal polynomials at the points of a block, where they are not those of the reference rule.
struct PointValues {
  reference::Modal modal;
  std::vector<double> at_rule;

  PointValues(int degree, const method::CellQuadrature& quadrature) : modal(degree) {
    const auto xi = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), quadrature.rule_xi);
    at_rule = modal.values(xi.extent_int(0), xi.data());
  }
};

/// force(k, ·) and the squares |f - Pi_q f|²_K of the owned cells.
void project(const method::Space& space, int q, const scene::Field& force, double time, const CellTable& out,
             std::vector<double>& oscillation) {
  const auto& quadrature = space.quadrature();
  const PointValues values(q + 1, quadrature);
  const int n = values.modal.size(), few = reference::dimension(q);
  const LocalIndex owned = space.mesh().owned_cells;
  const auto metric = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), metrics(space.mesh(), space.cells()));
  const auto host = Kokkos::create_mirror_view(out);
  const View<double*> f("thixis::bound::force_at_points", quadrature.largest_block);
  method::for_each_block(quadrature, [&](const method::QuadratureBlock& block) {
    method::evaluate(force, time, block, f);
    const auto at = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), f);
    const auto offset = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), block.offset);
    const auto own = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), block.own_rule);
    const auto xi = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), block.xi);
    const auto weight = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), block.weight);
    std::vector<double> cut;
    for (LocalIndex c = 0; c < block.cells; ++c) {
      const LocalIndex k = block.first + c;
      const int first = offset(c), count = offset(c + 1) - first;
      if (own(c) >= 0) cut = values.modal.values(count, &xi(first, 0));
      const double* const phi = own(c) >= 0 ? cut.data() : values.at_rule.data();
      double* const coefficient = &host(k, 0);
      for (int i = 0; i < count; ++i) {
        const double weighted = weight(first + i) * at(first + i);
        for (int m = 0; m < n; ++m) coefficient[m] += weighted * phi[i * n + m];
      }
      if (k >= owned) continue;
      double square = 0;
      for (int i = 0; i < count; ++i) {
        double projection = 0;
        for (int m = 0; m < few; ++m) projection += coefficient[m] * phi[i * n + m];
        const double rest = at(first + i) - projection / metric(k).det;
        square += weight(first + i) * rest * rest;
      }
      oscillation[k] = square;
    }
  });
  Kokkos::deep_copy(out, host);
}

/// Moments of -psi_a t on the faces of the boundary that have Neumann data, and |t - Pi_q t|²_F.
void project_traction(const method::Space& space, int q, const scene::Field& t, double time, LocalIndex tag, int order,
                      const CellTable::HostMirror& traction, std::vector<double>& rest) {
  const mesh::Mesh& mesh = space.mesh();
  const auto host = mesh::on_host(mesh);
  const auto rule = reference::line_quadrature(order);
  std::vector<LocalIndex> faces;
  std::vector<double> x, y;
  for (LocalIndex F = 0; F < mesh.faces; ++F) {
    if (host.face_tag(F) != tag || space.position(mesh::first_cell(host.face_cells, F)) < 0) continue;
    faces.push_back(F);
    for (const double s : rule.point) {
      x.push_back((1 - s) * host.coordinates(host.face_vertices(F, 0), 0) + s * host.coordinates(host.face_vertices(F, 1), 0));
      y.push_back((1 - s) * host.coordinates(host.face_vertices(F, 0), 1) + s * host.coordinates(host.face_vertices(F, 1), 1));
    }
  }
  std::vector<double> values(x.size());
  t.evaluate({x.size(), x.data(), y.data()}, time, values.data());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const double length = mesh::face_geometry(host.coordinates, host.face_vertices, faces[f]).length;
    std::vector<double> moment(q + 1, 0.0);
    for (int i = 0; i < rule.size(); ++i) {
      const auto L = reference::legendre(q + 1, rule.point[i]);
      const double value = values[f * rule.size() + i], hat[2] = {1 - rule.point[i], rule.point[i]};
      for (int j = 0; j <= q; ++j) {
        moment[j] += rule.weight[i] * value * L[j];
        for (int e = 0; e < 2; ++e) traction(faces[f], e * (q + 1) + j) -= length * rule.weight[i] * value * hat[e] * L[j];
      }
    }
    for (int i = 0; i < rule.size(); ++i) {
      const auto L = reference::legendre(q + 1, rule.point[i]);
      double difference = values[f * rule.size() + i];
      for (int j = 0; j <= q; ++j) difference -= moment[j] * L[j];
      rest[faces[f]] += length * rule.weight[i] * difference * difference;
    }
  }
}

}  // namespace

double diameter(const mesh::HostMesh& mesh, LocalIndex K) {
  double h = 0;
  for (int i = 0; i < 3; ++i) {
    const LocalIndex a = mesh.cell_vertices(K, i), b = mesh.cell_vertices(K, (i + 1) % 3);
    h = std::max(h, std::hypot(mesh.coordinates(a, 0) - mesh.coordinates(b, 0), mesh.coordinates(a, 1) - mesh.coordinates(b, 1)));
  }
  return h;
}

std::vector<double> diameters(const mesh::Mesh& mesh) {
  const auto host = mesh::on_host(mesh);
  std::vector<double> h(mesh.owned_cells);
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) h[K] = diameter(host, K);
  return h;
}

std::vector<bool> held_tags(const method::BoundaryValues& boundary) {
  std::vector<bool> held;
  for (const auto& value : boundary.dirichlet) held.push_back(value != nullptr);
  return held;
}

Sources sources(const method::Space& space, int q, const scene::Field& force, const method::BoundaryValues& boundary, double time,
                const CutOscillation* cut_cells, const std::vector<double>& least_tension) {
  const mesh::Mesh& mesh = space.mesh();
  const auto host = mesh::on_host(mesh);
  Sources data{CellTable("thixis::bound::force", space.cells().extent(0), reference::dimension(q + 1)),
               View<double*>("thixis::bound::oscillation", mesh.owned_cells),
               View<double*>("thixis::bound::sharp_oscillation", mesh.owned_cells),
               View<double*>("thixis::bound::traction_oscillation", mesh.owned_cells),
               {}};
  std::vector<double> square(mesh.owned_cells, 0.0), rest;
  const bool neumann = std::any_of(boundary.neumann.begin(), boundary.neumann.end(), [](const auto& t) { return t != nullptr; });
  if (neumann) {
    data.traction = CellTable("thixis::bound::traction", mesh.faces, 2 * (q + 1));
    rest.assign(mesh.faces, 0.0);
  }
  const int order = space.quadrature().order;  // that of the loads: on it depends whether patches are compatible
  mesh.comm.together([&] {
    project(space, q, force, time, data.force, square);
    if (!neumann) return;
    const auto traction = Kokkos::create_mirror_view(data.traction);
    for (std::size_t tag = 0; tag < boundary.neumann.size(); ++tag)
      if (boundary.neumann[tag])
        project_traction(space, q, *boundary.neumann[tag], time, static_cast<LocalIndex>(tag), order, traction, rest);
    Kokkos::deep_copy(data.traction, traction);
  });
  const auto h = diameters(mesh);
  std::vector<double> sharp(mesh.owned_cells);
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) sharp[K] = poincare * h[K] * std::sqrt(square[K]);
  if (cut_cells) cut_cells->sharpen(force, time, sharp);
  const auto oscillation = Kokkos::create_mirror_view(data.oscillation), of_sharp = Kokkos::create_mirror_view(data.sharp_oscillation),
             of_traction = Kokkos::create_mirror_view(data.traction_oscillation);
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
    oscillation(K) = h[K] / pi * std::sqrt(square[K] / least_tension[K]);
    of_sharp(K) = sharp[K] / std::sqrt(least_tension[K]);
    for (int f = 0; f < 3 && neumann; ++f) {
      const LocalIndex F = host.cell_faces(K, f);
      if (rest[F] == 0) continue;
      const double length = mesh::face_geometry(host.coordinates, host.face_vertices, F).length,
                   area = mesh::cell_area(host.coordinates, host.cell_vertices, K);
      of_traction(K) += std::sqrt(length * h[K] * h[K] / area * (1 + pi) / (pi * pi) * rest[F] / least_tension[K]);
    }
  }
  Kokkos::deep_copy(data.oscillation, oscillation);
  Kokkos::deep_copy(data.sharp_oscillation, of_sharp);
  Kokkos::deep_copy(data.traction_oscillation, of_traction);
  return data;
}

}  // namespace thixis::bound
