#include "flux.hpp"
#include "thixis/method/cell_functions.hpp"
#include "thixis/reference/modal.hpp"

namespace thixis::dg {
namespace {

constexpr int most_legendre = reference::max_degree + 1;

struct FaceFluxes {
  View<double* [2]> x;
  View<LocalIndex* [3]> vertices;
  View<LocalIndex* [2]> face_vertices;
  Faces faces;
  Traces traces;
  Table legendre;  ///< (q, j)
  Penalty penalty;
  bool held;  ///< [u] = 0
  LocalIndex first;
  Tensions mu;
  ElementEntries entries;
  Kokkos::View<const double*> u;
  FaceMoments moments;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const LocalIndex k = first + e, F = faces.face(k);
    const int n = traces.value.extent_int(2), p = legendre.extent_int(1) - 1;
    const mesh::FaceGeometry face = mesh::face_geometry(x, face_vertices, F);
    const double share = faces.cell(k, 0) >= 0 && faces.cell(k, 1) >= 0 ? 0.5 : 1.0;
    double slope[2][3] = {};  // n·grad(lambda_a), times the share in the mean
    for (int s = 0; s < 2; ++s) {
      if (faces.cell(k, s) < 0) continue;
      const mesh::CellGeometry K = mesh::cell_geometry(x, vertices, faces.cell(k, s));
      for (int a = 0; a < 3; ++a) slope[s][a] = share * (face.normal[0] * K.gradient[a][0] + face.normal[1] * K.gradient[a][1]);
    }
    double flux[most_legendre] = {}, slip[2][most_legendre] = {};
    for (int q = 0; q < traces.points(); ++q) {
      double mean = 0, jump = 0;
      for (int s = 0; s < 2; ++s) {
        if (faces.cell(k, s) < 0) continue;
        double value = 0, derivative[3] = {0, 0, 0};
        for (int i = 0; i < n; ++i) {
          const double c = u(entries(k, s * n + i));
          value += c * traces.value(faces.side(k, s), q, i);
          for (int a = 0; a < 3; ++a) derivative[a] += c * traces.derivative(faces.side(k, s), q, i, a);
        }
        if (!held) jump += s == 0 ? value : -value;
        for (int a = 0; a < 3; ++a) mean += mu(e, q, s) * slope[s][a] * derivative[a];
      }
      const double mu_F = mu(e, q, 0) > mu(e, q, 1) ? mu(e, q, 0) : mu(e, q, 1);
      const double normal = -mean + penalty.eta / face.length * mu_F * jump;
      for (int j = 0; j <= p; ++j) {
        const double weight = traces.weight(q) * legendre(q, j);
        flux[j] += weight * normal;
        for (int s = 0; s < 2; ++s) slip[s][j] += weight * mu(e, q, s) * jump;
      }
    }
    for (int j = 0; j <= p; ++j) moments.flux(F, j) = flux[j];
    for (int s = 0; s < 2; ++s)
      for (int j = 0; j < p; ++j) moments.slip(F, s, j) = slip[s][j];
  }
};

/// What boundary data change: weak Dirichlet data g take g off [u], tractions t make sigma·n = -t.
struct BoundaryFluxes {
  View<double* [2]> x;
  View<LocalIndex* [2]> face_vertices;
  BoundaryData on;
  View<const double*> weight;
  Table legendre;  ///< (q, j)
  bool traction;   ///< no Dirichlet data
  double eta;
  FaceMoments moments;

  KOKKOS_FUNCTION void operator()(int e) const {
    const LocalIndex F = on.faces.face(e);
    const int side = on.faces.cell(e, 0) >= 0 ? 0 : 1, points = weight.extent_int(0), p = legendre.extent_int(1) - 1;
    const double outward = side == 0 ? 1 : -1, length = mesh::face_geometry(x, face_vertices, F).length;
    for (int q = 0; q < points; ++q) {
      const double weighted = outward * weight(q) * on.mu(e * points + q) * on.data(e * points + q);
      for (int j = 0; j <= p; ++j) moments.flux(F, j) -= (traction ? 1 : eta / length) * weighted * legendre(q, j);
      for (int j = 0; j < p && !traction; ++j) moments.slip(F, side, j) -= weighted * legendre(q, j);
    }
  }
};

/// (q, j): L_j at the points of the rule.
Table legendre_at(const Traces& traces, int width) {
  const auto t = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), traces.t);
  std::vector<double> legendre;
  for (int q = 0; q < traces.points(); ++q) {
    const auto L = reference::legendre(width, t(q));
    legendre.insert(legendre.end(), L.begin(), L.end());
  }
  return method::matrix_view("thixis::dg::legendre", traces.points(), width, legendre);
}

}  // namespace

FaceMoments face_moments(const mesh::Mesh& mesh, int degree) {
  return {Kokkos::View<double**, Kokkos::LayoutRight>("thixis::dg::face_fluxes", mesh.faces, degree + 1),
          Kokkos::View<double***, Kokkos::LayoutRight>("thixis::dg::face_slips", mesh.faces, 2, degree)};
}

void add_face_fluxes(const mesh::Mesh& mesh, const Faces& faces, const Traces& traces, const Penalty& penalty, bool held, LocalIndex first,
                     LocalIndex count, const Tensions& mu, const ElementEntries& entries, const Kokkos::View<const double*>& u,
                     const FaceMoments& moments) {
  FaceFluxes kernel;
  kernel.x = mesh.coordinates;
  kernel.vertices = mesh.cell_vertices;
  kernel.face_vertices = mesh.face_vertices;
  kernel.faces = faces;
  kernel.traces = traces;
  kernel.legendre = legendre_at(traces, moments.flux.extent_int(1));
  kernel.penalty = penalty;
  kernel.held = held;
  kernel.first = first;
  kernel.mu = mu;
  kernel.entries = entries;
  kernel.u = u;
  kernel.moments = moments;
  Kokkos::parallel_for("thixis::dg::face_fluxes", Kokkos::RangePolicy<>(0, count), kernel);
}

void add_boundary_fluxes(const mesh::Mesh& mesh, const BoundaryData& data, const Traces& traces, const Penalty* weak,
                         const FaceMoments& moments) {
  BoundaryFluxes kernel;
  kernel.x = mesh.coordinates;
  kernel.face_vertices = mesh.face_vertices;
  kernel.on = data;
  kernel.weight = traces.weight;
  kernel.legendre = legendre_at(traces, moments.flux.extent_int(1));
  kernel.traction = weak == nullptr;
  kernel.eta = weak ? weak->eta : 0;
  kernel.moments = moments;
  Kokkos::parallel_for("thixis::dg::boundary_fluxes", Kokkos::RangePolicy<>(0, data.size()), kernel);
}

}  // namespace thixis::dg
