#include "thixis/method/layout.hpp"

#include "kernels/polynomial_kernels.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/to_view.hpp"
#include "thixis/method/space.hpp"

namespace thixis::method {
namespace {

using algebra::Vector;
using Indices = Kokkos::View<LocalIndex**, Kokkos::LayoutRight>;

/// Functions that do not vanish on the face f: those of its ends and its own.
std::vector<int> functions_on(const reference::CellBasis& basis, int f) {
  std::vector<int> on;
  for (int l = 0; l < basis.size(); ++l) {
    const auto& entity = basis.entities()[l];
    const bool end = entity.kind == reference::Entity::vertex && entity.index != f;
    if (end || (entity.kind == reference::Entity::face && entity.index == f)) on.push_back(l);
  }
  return on;
}

/// From values at the places of held entries to coefficients: on each face of its own functions.
void to_coefficients(const Space& space, const BoundaryValues& boundary, const mesh::ConstHostView<const LocalIndex**>& entries,
                     const Coefficients::HostMirror& values) {
  const reference::CellBasis& basis = space.basis();
  const mesh::HostMesh& mesh = space.host();
  const int n = basis.size(), c = space.components();
  for (LocalIndex F = 0; F < space.mesh().faces; ++F) {
    const LocalIndex tag = mesh.face_tag(F), K = mesh::first_cell(mesh.face_cells, F), k = tag < 0 ? -1 : space.position(K);
    if (k < 0) continue;
    const auto on = functions_on(basis, mesh::local_face(mesh.cell_faces, K, F));
    for (int component = 0; component < c; ++component) {
      if (!boundary.dirichlet[c * tag + component]) continue;
      std::vector<double> coefficient(on.size(), 0.0);
      for (std::size_t i = 0; i < on.size(); ++i)
        for (const int m : on) coefficient[i] += basis.from_values()[on[i] * n + m] * values(entries(k, c * m + component));
      for (std::size_t i = 0; i < on.size(); ++i) {
        const LocalIndex entry = entries(k, c * on[i] + component);
        if (basis.entities()[on[i]].kind == reference::Entity::face && space.numbering().held[entry] == tag) values(entry) = coefficient[i];
      }
    }
  }
}

/// (e, c i + m) -> c entry + m.
Indices interlaced(const Indices& entries, int c) {
  const Indices all("thixis::method::element_entries", entries.extent(0), c * entries.extent(1));
  Kokkos::parallel_for(
      "thixis::method::interlace", Kokkos::RangePolicy<>(0, entries.extent_int(0)), KOKKOS_LAMBDA(int e) {
        for (int i = 0; i < entries.extent_int(1); ++i)
          for (int m = 0; m < c; ++m) all(e, c * i + m) = entries(e, i) < 0 ? -1 : c * entries(e, i) + m;
      });
  return all;
}

Structure interlaced(const Structure& scalar, const std::vector<std::vector<LocalIndex>>& held) {
  const int c = static_cast<int>(held.size());
  Structure all = scalar;
  all.entries = Entries();
  all.entries.reserve(static_cast<std::size_t>(c) * scalar.entries.size());
  for (LocalIndex e = 0; e < scalar.entries.size(); ++e)
    for (int i = 0; i < c; ++i) all.entries.add(c * scalar.entries.id[e] + i, scalar.entries.owner[e], held[i][e], scalar.entries.point[e]);
  all.element_entries = interlaced(scalar.element_entries, c);
  all.coupled_entries = interlaced(scalar.coupled_entries, c);
  all.cell_entries *= c;
  all.global_cell_entries *= c;
  all.interior *= c;
  return all;
}

}  // namespace

Structure in_components(const SpaceOptions& options, const std::function<Structure(const SpaceOptions&)>& scalar) {
  const int c = options.components;
  if (c == 1) return scalar(options);
  const auto of_component = [&](int i) {
    SpaceOptions one = options;
    one.components = 1;
    one.dirichlet.resize(options.dirichlet.size() / c);
    for (std::size_t tag = 0; tag < one.dirichlet.size(); ++tag) one.dirichlet[tag] = options.dirichlet[c * tag + i];
    return one;
  };
  const SpaceOptions first = of_component(0);
  const Structure structure = scalar(first);
  std::vector<std::vector<LocalIndex>> held(1, structure.entries.held);
  for (int i = 1; i < c; ++i) {
    const SpaceOptions other = of_component(i);
    held.push_back(other.dirichlet == first.dirichlet ? held.front() : scalar(other).entries.held);
  }
  return interlaced(structure, held);
}

Coefficients Layout::lift(const Space& space, const BoundaryValues& boundary, double t) const {
  const Structure& structure = space.coefficients();
  const auto& held = space.numbering().held;
  const int c = space.components();
  const Coefficients values("thixis::method::lift", structure.entries.size());
  const auto host = Kokkos::create_mirror_view(values);
  space.mesh().comm.together([&] {
    for (std::size_t at = 0; at < boundary.dirichlet.size(); ++at) {
      if (!boundary.dirichlet[at]) continue;
      std::vector<LocalIndex> entries;
      for (LocalIndex e = static_cast<LocalIndex>(at) % c; e < structure.cell_entries; e += c)
        if (held[e] == static_cast<LocalIndex>(at) / c) entries.push_back(e);
      const auto g = space.at_entries(*boundary.dirichlet[at], entries, t);
      for (std::size_t k = 0; k < entries.size(); ++k) host(entries[k]) = g[k];
    }
  });
  if (space.basis().family() == reference::Family::bernstein)
    to_coefficients(space, boundary, Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), structure.element_entries), host);
  Kokkos::deep_copy(values, host);
  return values;
}

void Layout::interpolate_traces(const Space&, const Function&, double, Vector&) const {}

bool Layout::backwards(const Space&, LocalIndex, int) const { return false; }

void Layout::share(const Space& space, const Vector& R, const View<double**>& moments) const {
  const ElementUnknowns& columns = space.elements();
  if (sharers_.extent(0) == 0) {  // all cells of an unknown of this rank are patch cells
    sharers_ = View<int*>("thixis::method::sharers", algebra::local_size(*space.map()));
    count_cells(columns, moments.extent_int(1), sharers_);
  }
  const View<int*> sharers = sharers_;
  Vector part(R, Teuchos::Copy);
  {
    const auto values = part.getLocalViewDevice(Tpetra::Access::ReadWrite);
    Kokkos::parallel_for(
        "thixis::method::divide", Kokkos::RangePolicy<>(0, values.extent_int(0)), KOKKOS_LAMBDA(int row) {
          if (sharers(row) > 1) values(row, 0) /= sharers(row);
        });
  }
  const Vector ghosted = space.with_ghosts(part);
  const auto values = ghosted.getLocalViewDevice(Tpetra::Access::ReadOnly);
  Kokkos::parallel_for(
      "thixis::method::share", Kokkos::RangePolicy<>(0, moments.extent_int(0)), KOKKOS_LAMBDA(int k) {
        for (int l = 0; l < moments.extent_int(1); ++l) moments(k, l) = columns(k, l) < 0 ? 0 : values(columns(k, l), 0);
      });
}

Coefficients Layout::multiplier(const Space& space, const Vector& X3) const {
  const Coefficients lambda("thixis::method::multiplier", space.coefficients().entries.size());
  const int n = space.basis().size();
  const auto moments = Kokkos::subview(X3.getLocalViewDevice(Tpetra::Access::ReadOnly), Kokkos::ALL, 0);
  invert_mass(matrix_view("thixis::method::inverse_mass", n, n, reference::inverse(n, space.basis().mass())), space.mesh(), space.cells(),
              space.mesh().owned_cells, space.elements(), space.coefficients().element_entries, moments, lambda);
  Kokkos::fence();
  return lambda;
}

std::vector<LocalIndex> held_faces(const mesh::Mesh& mesh, const std::vector<bool>& dirichlet) {
  const auto face_tag = mesh::on_host(mesh).face_tag;
  std::vector<LocalIndex> held(mesh.faces, -1);
  for (LocalIndex F = 0; F < mesh.faces; ++F)
    if (face_tag(F) >= 0 && dirichlet[face_tag(F)]) held[F] = face_tag(F);
  return held;
}

std::vector<LocalIndex> held_vertices(const mesh::Mesh& mesh, const std::vector<bool>& dirichlet) {
  const auto faces = held_faces(mesh, dirichlet);
  const auto face_vertices = mesh::on_host(mesh).face_vertices;
  std::vector<LocalIndex> held(mesh.vertices, -1);
  for (LocalIndex F = 0; F < mesh.faces; ++F)
    for (int i = 0; i < 2 && faces[F] >= 0; ++i) {
      LocalIndex& lowest = held[face_vertices(F, i)];
      if (lowest < 0 || faces[F] < lowest) lowest = faces[F];
    }
  return held;
}

}  // namespace thixis::method
