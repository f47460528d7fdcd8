#include "thixis/dg/space.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "face_form.hpp"
#include "flux.hpp"
#include "held_boundary.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"
#include "thixis/dg/params.hpp"
#include "thixis/method/gradient_form.hpp"
#include "thixis/method/polynomial_space.hpp"
#include "thixis/reference/modal.hpp"

namespace thixis::dg {
namespace {

using algebra::Vector;
using method::BoundaryValues;
using method::Coefficients;
using Indices = Kokkos::View<LocalIndex**, Kokkos::LayoutRight>;

const Params& own(const method::SpaceOptions& options) { return options.params.own.get<Params>(); }
bool strong(const method::SpaceOptions& options) { return own(options).boundary == BoundaryTreatment::strong; }

/// Faces that an owned cell has and that carry a form: all inside, on the boundary those with weak Dirichlet data.
std::vector<LocalIndex> faces_with_form(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  const auto host = mesh::on_host(mesh);
  std::vector<LocalIndex> faces;
  for (LocalIndex F = 0; F < mesh.faces; ++F) {
    const bool own =
        std::any_of(&host.face_cells(F, 0), &host.face_cells(F, 0) + 2, [&](LocalIndex K) { return K >= 0 && K < mesh.owned_cells; });
    const LocalIndex tag = host.face_tag(F);
    if (own && (tag < 0 || (options.dirichlet[tag] && !strong(options)))) faces.push_back(F);
  }
  return faces;
}

/// Faces of owned cells whose nodes are held.
std::vector<LocalIndex> faces_held(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  const auto host = mesh::on_host(mesh);
  std::vector<LocalIndex> faces;
  for (LocalIndex F = 0; F < mesh.faces; ++F)
    if (host.face_tag(F) >= 0 && options.dirichlet[host.face_tag(F)] && mesh::first_cell(host.face_cells, F) < mesh.owned_cells)
      faces.push_back(F);
  return faces;
}

/// n entries per patch cell. With strong data the nodes on the held boundary are held, also those of cells that meet it at a vertex only.
method::Structure structure(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  const auto host = mesh::on_host(mesh);
  const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), method::patch_cells(mesh));
  const reference::CellBasis basis(options.params.degree, method::family(options.params.nodes));
  const int n = basis.size();
  const std::vector<bool> fixing = strong(options) ? options.dirichlet : std::vector<bool>(options.dirichlet.size(), false);
  const auto vertex_tag = method::held_vertices(mesh, fixing), face_tag = method::held_faces(mesh, fixing);

  method::Structure s;
  s.element_entries = Indices("thixis::dg::element_entries", cells.extent(0), n);
  const auto entries = Kokkos::create_mirror_view(s.element_entries);
  std::vector<LocalIndex> position(mesh.cells, -1);
  s.entries.reserve(cells.extent(0) * n);
  for (std::size_t k = 0; k < cells.extent(0); ++k) {
    const LocalIndex K = cells(k);
    position[K] = static_cast<LocalIndex>(k);
    for (int i = 0; i < n; ++i) {
      const auto& entity = basis.entities()[i];
      const LocalIndex held = entity.kind == reference::Entity::vertex ? vertex_tag[host.cell_vertices(K, entity.index)]
                              : entity.kind == reference::Entity::face ? face_tag[host.cell_faces(K, entity.index)]
                                                                       : -1;
      const double xi = basis.points()[2 * i], eta = basis.points()[2 * i + 1], lambda[3] = {1 - xi - eta, xi, eta};
      std::array<double, 2> point = {0, 0};
      for (int a = 0; a < 3; ++a)
        for (int d = 0; d < 2; ++d) point[d] += lambda[a] * host.coordinates(host.cell_vertices(K, a), d);
      entries(k, i) = s.entries.size();
      s.entries.add(n * mesh.cell_id[K] + i, mesh.cell_owner[K], held, point);
    }
  }
  Kokkos::deep_copy(s.element_entries, entries);

  // rows of the owned cells couple across their faces
  std::vector<LocalIndex> faces;
  for (LocalIndex F = 0; F < mesh.faces; ++F)
    if ((host.face_cells(F, 0) >= 0 && host.face_cells(F, 0) < mesh.owned_cells) ||
        (host.face_cells(F, 1) >= 0 && host.face_cells(F, 1) < mesh.owned_cells))
      faces.push_back(F);
  s.coupled_entries = Indices("thixis::dg::coupled_entries", faces.size(), 2 * n);
  const auto coupled = Kokkos::create_mirror_view(s.coupled_entries);
  for (std::size_t k = 0; k < faces.size(); ++k)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n; ++i) {
        const LocalIndex K = host.face_cells(faces[k], side);
        coupled(k, side * n + i) = K < 0 ? -1 : entries(position[K], i);
      }
  Kokkos::deep_copy(s.coupled_entries, coupled);
  s.cell_entries = s.entries.size();
  s.global_cell_entries = n * mesh.global_cells;
  return s;
}

class Space final : public method::PolynomialSpace {
 public:
  Space(const mesh::Mesh& mesh, const method::SpaceOptions& options)
      : PolynomialSpace(mesh, options, structure(mesh, options)),
        dirichlet_(options.dirichlet),
        strong_(strong(options)),
        symmetric_(own(options).variant == Variant::sipg),
        penalty_{symmetric_ ? 1.0 : -1.0, own(options).penalty * params_.degree * params_.degree} {
    with_form_ = collected(faces_with_form(mesh, options));
    if (strong_) held_ = collected(faces_held(mesh, options));
  }

  bool symmetric() const override { return symmetric_; }

  std::shared_ptr<const method::CellForm> cell_form(const scene::Field& tension) const override {
    return method::gradient_form(mesh_, quadrature_, basis_, tension);
  }

  algebra::MatrixPtr stiffness(const scene::Field& tension) const override {
    auto S = PolynomialSpace::stiffness(tension);
    over_faces(tension, [&](LocalIndex first, const Matrices& A) { method::scatter(with_form_.columns, first, A, *S); });
    return S;
  }

  void forces(const scene::Field& tension, const Coefficients& u, Vector& y) const override {
    PolynomialSpace::forces(tension, u, y);
    const Kokkos::View<double**, Kokkos::LayoutRight> local("thixis::dg::face_forces", faces_per_block(with_form_.faces),
                                                            2 * basis_.size());
    over_faces(tension, [&](LocalIndex first, const Matrices& A) {
      const auto part = Kokkos::subview(local, std::pair(0, A.extent_int(0)), Kokkos::ALL);
      Kokkos::parallel_for("thixis::dg::face_forces", Kokkos::RangePolicy<>(0, A.extent_int(0)),
                           Apply{A, first, with_form_.entries, u, part});
      method::scatter(with_form_.columns, first, part, y);
    });
  }

  /// Dirichlet data g enter as - theta (mu grad(psi)·n, g)_F + (eta p²/|F|) (mu g, psi)_F.
  void load(const scene::Field& tension, const scene::Field& force, const BoundaryValues& boundary, double t, Vector& F) const override {
    PolynomialSpace::load(tension, force, boundary, t, F);
    if (strong_) return;
    mesh_.comm.together([&] {
      const auto out = algebra::host_view(F);
      for (std::size_t tag = 0; tag < boundary.dirichlet.size(); ++tag)
        if (boundary.dirichlet[tag]) add_weakly(tension, *boundary.dirichlet[tag], static_cast<LocalIndex>(tag), t, out);
    });
  }

  void native_flux(const scene::Field& tension, const scene::Field& force, const Coefficients& u, const BoundaryValues& boundary, double t,
                   const method::HeldSource& at_held, const View<double**>& sigma) const override {
    if (!flux_tables_) flux_tables_ = flux_tables(basis_);
    const auto density = method::flux_density(mesh_, quadrature_, basis_.degree() - 1, tension);
    const FaceMoments moments = face_moments(mesh_, basis_.degree());
    for (const FaceSet* set : {&with_form_, &held_})
      over_face_blocks(tension, set->faces, [&](const Traces& at, LocalIndex first, LocalIndex count, const Tensions& mu) {
        add_face_fluxes(mesh_, set->faces, at, penalty_, set == &held_, first, count, mu, set->entries, u, moments);
      });
    mesh_.comm.together([&] { add_boundary_fluxes(tension, boundary, t, moments); });
    dg::native_flux(mesh_, *flux_tables_, penalty_.theta, density, structure_.element_entries, u, moments, mesh_.owned_cells, sigma);
    if (strong_) held_boundary().balance(force, t, at_held, sigma);
  }

 private:
  struct Apply {
    Matrices A;
    LocalIndex first;
    Indices entries;
    Coefficients u;
    Kokkos::View<double**, Kokkos::LayoutRight> y;  ///< out, overwritten
    KOKKOS_FUNCTION void operator()(int e) const {
      for (int i = 0; i < A.extent_int(1); ++i) {
        double sum = 0;
        for (int j = 0; j < A.extent_int(2); ++j)
          if (entries(first + e, j) >= 0) sum += A(e, i, j) * u(entries(first + e, j));
        y(e, i) = sum;
      }
    }
  };

  /// Faces and, for each, the entries and columns of both cells.
  struct FaceSet {
    Faces faces;
    Indices entries, columns;  ///< (face, 2n)
  };

  FaceSet collected(const std::vector<LocalIndex>& list) const {
    const int n = basis_.size();
    const std::size_t count = list.size();
    View<LocalIndex*> face("thixis::dg::faces", count);
    View<LocalIndex*[2]> cell("thixis::dg::face_cells", count), side("thixis::dg::face_sides", count);
    const Indices entries("thixis::dg::face_entries", count, 2 * n), columns("thixis::dg::face_columns", count, 2 * n);
    const auto face_host = Kokkos::create_mirror_view(face);
    const auto cell_host = Kokkos::create_mirror_view(cell), side_host = Kokkos::create_mirror_view(side);
    const auto entries_host = Kokkos::create_mirror_view(entries), columns_host = Kokkos::create_mirror_view(columns);
    const auto of_cell = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), structure_.element_entries);
    const auto column = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), numbering_.column_of_entry);
    for (std::size_t k = 0; k < count; ++k) {
      const LocalIndex F = list[k];
      face_host(k) = F;
      for (int s = 0; s < 2; ++s) {
        const LocalIndex K = cell_host(k, s) = host_.face_cells(F, s);
        side_host(k, s) = K < 0 ? 0 : side_of(K, F);
        for (int i = 0; i < n; ++i) {
          entries_host(k, s * n + i) = K < 0 ? -1 : of_cell(position(K), i);
          columns_host(k, s * n + i) = K < 0 ? -1 : column(of_cell(position(K), i));
        }
      }
    }
    Kokkos::deep_copy(face, face_host);
    Kokkos::deep_copy(cell, cell_host);
    Kokkos::deep_copy(side, side_host);
    Kokkos::deep_copy(entries, entries_host);
    Kokkos::deep_copy(columns, columns_host);
    return {{face, cell, side}, entries, columns};
  }

  int side_of(LocalIndex K, LocalIndex F) const {
    const int f = mesh::local_face(host_.cell_faces, K, F);
    return 2 * f + (host_.face_vertices(F, 0) == host_.cell_vertices(K, (f + 1) % 3) ? 0 : 1);
  }

  LocalIndex faces_per_block(const Faces& faces) const {
    return std::min(method::cells_per_block(2 * basis_.size()), faces.face.extent_int(0));
  }

  /// f(traces, first, count, mu) for blocks of faces. Collective, since the tension may be refused.
  template <class Action>
  void over_face_blocks(const scene::Field& tension, const Faces& faces, Action f) const {
    const Traces at = traces(basis_, tension.constant() ? 2 * basis_.degree() : params_.order());
    const LocalIndex count = faces.face.extent_int(0), most = faces_per_block(faces);
    const Tensions mu("thixis::dg::face_tension", most, at.points());
    if (const double* value = tension.constant()) Kokkos::deep_copy(mu, *value);
    mesh_.comm.together([&] {
      for (LocalIndex first = 0; first < count; first += most) {
        const LocalIndex length = std::min(most, count - first);
        if (!tension.constant()) evaluate_traces(tension, faces, at, first, length, mu);
        f(at, first, length, mu);
      }
    });
  }

  /// f(first, A) for blocks of faces. Collective, since the tension may be refused.
  template <class Action>
  void over_faces(const scene::Field& tension, Action f) const {
    const int n = basis_.size();
    const Matrices A("thixis::dg::face_matrices", faces_per_block(with_form_.faces), 2 * n, 2 * n);
    over_face_blocks(tension, with_form_.faces, [&](const Traces& at, LocalIndex first, LocalIndex count, const Tensions& mu) {
      const Matrices block = Kokkos::subview(A, std::pair(0, count), Kokkos::ALL, Kokkos::ALL);
      face_matrices(mesh_, with_form_.faces, at, penalty_, first, mu, block);
      f(first, block);
    });
  }

  /// mu(e, q, s): trace from K+ and K- on the faces first + e.
  void evaluate_traces(const scene::Field& tension, const Faces& faces, const Traces& at, LocalIndex first, LocalIndex length,
                       const Tensions& mu) const {
    const auto face = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), faces.face);
    const auto cell = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), faces.cell);
    const auto host = Kokkos::create_mirror_view(mu);
    const int points = at.points();
    std::vector<double> x(length * points), y(x.size()), values(x.size());
    for (int s = 0; s < 2; ++s) {
      for (LocalIndex e = 0; e < length; ++e) {
        const LocalIndex k = first + e, K = cell(k, cell(k, s) >= 0 ? s : 1 - s);
        place_inside(K, face(k), at, &x[e * points], &y[e * points]);
      }
      tension.evaluate({x.size(), x.data(), y.data()}, 0, values.data());
      for (LocalIndex e = 0; e < length; ++e)
        for (int q = 0; q < points; ++q) host(e, q, s) = values[e * points + q];
    }
    Kokkos::deep_copy(mu, host);
  }

  /// Physical points of the rule on a face, from its lower to its higher vertex id.
  void place(LocalIndex F, const Traces& at, double* x, double* y) const {
    const LocalIndex a = host_.face_vertices(F, 0), b = host_.face_vertices(F, 1);
    for (int q = 0; q < at.points(); ++q) {
      x[q] = (1 - at.t(q)) * host_.coordinates(a, 0) + at.t(q) * host_.coordinates(b, 0);
      y[q] = (1 - at.t(q)) * host_.coordinates(a, 1) + at.t(q) * host_.coordinates(b, 1);
    }
  }

  /// The same, but so little inside K that a function which jumps across F shows its trace from K.
  void place_inside(LocalIndex K, LocalIndex F, const Traces& at, double* x, double* y) const {
    constexpr double inside = 1e-10;
    double centroid[2] = {0, 0};
    for (int a = 0; a < 3; ++a)
      for (int d = 0; d < 2; ++d) centroid[d] += host_.coordinates(host_.cell_vertices(K, a), d) / 3;
    place(F, at, x, y);
    for (int q = 0; q < at.points(); ++q) {
      x[q] += inside * (centroid[0] - x[q]);
      y[q] += inside * (centroid[1] - y[q]);
    }
  }

  /// Points of the rule on the faces with this tag of owned cells, and the same a little inside.
  struct BoundaryPoints {
    std::vector<LocalIndex> faces;
    std::vector<double> x, y, inside_x, inside_y;  ///< (face, q)
  };
  BoundaryPoints boundary_points(LocalIndex tag, const Traces& at) const {
    BoundaryPoints on;
    for (LocalIndex F = 0; F < mesh_.faces; ++F)
      if (host_.face_tag(F) == tag && mesh::first_cell(host_.face_cells, F) < mesh_.owned_cells) on.faces.push_back(F);
    const std::size_t points = at.points(), count = on.faces.size() * points;
    for (auto* coordinate : {&on.x, &on.y, &on.inside_x, &on.inside_y}) coordinate->resize(count);
    for (std::size_t k = 0; k < on.faces.size(); ++k) {
      const LocalIndex F = on.faces[k];
      place(F, at, &on.x[k * points], &on.y[k * points]);
      place_inside(mesh::first_cell(host_.face_cells, F), F, at, &on.inside_x[k * points], &on.inside_y[k * points]);
    }
    return on;
  }

  template <class Out>
  void add_weakly(const scene::Field& tension, const scene::Field& dirichlet, LocalIndex tag, double t, const Out& out) const {
    const Traces at = traces(basis_, params_.order());
    const auto of_cell = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), structure_.element_entries);
    const auto column = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), numbering_.column_of_entry);
    const std::size_t points = at.points();
    const BoundaryPoints on = boundary_points(tag, at);
    std::vector<double> g(on.x.size()), mu(g.size());
    dirichlet.evaluate({g.size(), on.x.data(), on.y.data()}, t, g.data());
    tension.evaluate({mu.size(), on.inside_x.data(), on.inside_y.data()}, 0, mu.data());
    for (std::size_t k = 0; k < on.faces.size(); ++k) {
      const LocalIndex F = on.faces[k], K = mesh::first_cell(host_.face_cells, F);
      const auto cell = mesh::cell_geometry(host_.coordinates, host_.cell_vertices, K);
      const auto face = mesh::face_geometry(host_.coordinates, host_.face_vertices, F);
      const double outward = mesh::normal_sign(host_.face_cells, F, K);
      const int side = side_of(K, F);
      for (int i = 0; i < basis_.size(); ++i) {
        double sum = 0;
        for (std::size_t q = 0; q < points; ++q) {
          double slope = 0;
          for (int a = 0; a < 3; ++a)
            slope += at.derivative(side, q, i, a) * outward * (face.normal[0] * cell.gradient[a][0] + face.normal[1] * cell.gradient[a][1]);
          sum += at.weight(q) * face.length * mu[k * points + q] * g[k * points + q] *
                 (penalty_.eta / face.length * at.value(side, q, i) - penalty_.theta * slope);
        }
        out(column(of_cell(position(K), i))) += sum;
      }
    }
  }

  /// What the boundary data give: weak Dirichlet data g take g off [u], tractions t make sigma·n = -t. Throws on this rank only.
  void add_boundary_fluxes(const scene::Field& tension, const BoundaryValues& boundary, double t, const FaceMoments& moments) const {
    const Traces at = traces(basis_, params_.order());
    const auto flux = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), moments.flux);
    const auto slip = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), moments.slip);
    const int p = basis_.degree(), points = at.points();
    for (std::size_t tag = 0; tag < dirichlet_.size(); ++tag) {
      if (dirichlet_[tag] && strong_) continue;
      const auto& data = dirichlet_[tag] ? boundary.dirichlet[tag] : boundary.neumann[tag];
      if (!data) continue;
      const BoundaryPoints on = boundary_points(static_cast<LocalIndex>(tag), at);
      std::vector<double> value(on.x.size()), mu(on.x.size(), 1.0);
      data->evaluate({value.size(), on.x.data(), on.y.data()}, t, value.data());
      if (dirichlet_[tag]) tension.evaluate({mu.size(), on.inside_x.data(), on.inside_y.data()}, 0, mu.data());
      for (std::size_t k = 0; k < on.faces.size(); ++k) {
        const LocalIndex F = on.faces[k];
        const int side = host_.face_cells(F, 0) >= 0 ? 0 : 1;
        const double outward = side == 0 ? 1 : -1;
        const double length = mesh::face_geometry(host_.coordinates, host_.face_vertices, F).length;
        for (int q = 0; q < points; ++q) {
          const auto L = reference::legendre(p + 1, at.t(q));
          const double weighted = outward * at.weight(q) * mu[k * points + q] * value[k * points + q];
          for (int j = 0; j <= p; ++j) flux(F, j) -= (dirichlet_[tag] ? penalty_.eta / length : 1) * weighted * L[j];
          for (int j = 0; j < p && dirichlet_[tag]; ++j) slip(F, side, j) -= weighted * L[j];
        }
      }
    }
    Kokkos::deep_copy(moments.flux, flux);
    Kokkos::deep_copy(moments.slip, slip);
  }

  const HeldBoundary& held_boundary() const {
    if (!held_boundary_) held_boundary_.emplace(*this, dirichlet_);
    return *held_boundary_;
  }

  std::vector<bool> dirichlet_;  ///< by tag
  bool strong_, symmetric_;
  Penalty penalty_;
  FaceSet with_form_, held_;
  mutable std::optional<FluxTables> flux_tables_;  ///< these two are made when a flux is first asked for
  mutable std::optional<HeldBoundary> held_boundary_;
};

}  // namespace

std::unique_ptr<method::Space> make_space(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  return std::make_unique<Space>(mesh, options);
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
  if (own(options).variant == Variant::nipg) return;
  const double needed = sufficient_penalty(mesh, options);
  if (own(options).penalty > needed) return;
  throw core::InputError(fmt::format(
      "method/penalty: {:g} is too small for sipg on this mesh, whose thinnest cell asks for more than {:.3g}; write at least {:.3g}, "
      "or method/variant = nipg, which takes any penalty.",
      own(options).penalty, needed, 1.1 * needed));
}

}  // namespace thixis::dg
