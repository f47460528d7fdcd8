#include "thixis/method/polynomial_space.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mass_form.hpp"
#include "polynomial_kernels.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/ancestry.hpp"
#include "thixis/method/gradient_form.hpp"
#include "thixis/method/jumps.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::method {
namespace {

using algebra::Vector;

/// (element, i) -> column from (element, i) -> entry.
ElementUnknowns columns_of(const Kokkos::View<LocalIndex**, Kokkos::LayoutRight>& entries, const View<LocalIndex*>& column_of_entry) {
  Kokkos::View<LocalIndex**, Kokkos::LayoutRight> columns("thixis::method::element_columns", entries.extent(0), entries.extent(1));
  Kokkos::parallel_for(
      "thixis::method::element_columns", Kokkos::RangePolicy<>(0, entries.extent_int(0)), KOKKOS_LAMBDA(int e) {
        for (int i = 0; i < entries.extent_int(1); ++i) columns(e, i) = entries(e, i) < 0 ? -1 : column_of_entry(entries(e, i));
      });
  return columns;
}

/// Points of the face f of the reference cell, from vertex f+1 to f+2, at t.
std::array<double, 2> on_face(int f, double t) {
  constexpr double corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  const double* const a = corner[(f + 1) % 3];
  const double* const b = corner[(f + 2) % 3];
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
}

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

/// T(s, i, j): coefficient i, in a child of shape s, of the basis function j of its parent.
Kokkos::View<double***, Kokkos::LayoutRight> to_children(const reference::CellBasis& basis) {
  const int n = basis.size();
  const auto& shapes = mesh::child_shapes();
  Kokkos::View<double***, Kokkos::LayoutRight> T("thixis::method::to_children", shapes.size(), n, n);
  const auto out = Kokkos::create_mirror_view(T);
  std::vector<double> at(2 * n);
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    for (int l = 0; l < n; ++l) {
      const double xi = basis.points()[2 * l], eta = basis.points()[2 * l + 1], lambda[3] = {1 - xi - eta, xi, eta};
      for (int d = 0; d < 2; ++d)
        at[2 * l + d] = lambda[0] * shapes[s][0][d + 1] + lambda[1] * shapes[s][1][d + 1] + lambda[2] * shapes[s][2][d + 1];
    }
    const auto table = basis.tabulate(n, at.data());
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int l = 0; l < n; ++l) out(s, i, j) += basis.from_values()[i * n + l] * table.value[l * n + j];
  }
  Kokkos::deep_copy(T, out);
  return T;
}

}  // namespace

reference::Family family(Nodes nodes) {
  switch (nodes) {
    case Nodes::equispaced:
      return reference::Family::equispaced;
    case Nodes::bernstein:
      return reference::Family::bernstein;
    default:
      return reference::Family::gauss_lobatto;
  }
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

PolynomialSpace::PolynomialSpace(const mesh::Mesh& mesh, const SpaceOptions& options, Structure structure)
    : mesh_(mesh),
      host_(mesh::on_host(mesh)),
      params_(options.params),
      basis_(options.params.degree, family(options.params.nodes)),
      structure_(std::move(structure)),
      numbering_(number(structure_.entries, mesh.comm)),
      cells_(patch_cells(mesh)),
      quadrature_(make_quadrature(mesh, cells_, options.params.order(), options.level_set)),
      elements_(columns_of(structure_.element_entries, numbering_.column_of_entry)),
      level_set_(options.level_set),
      position_(mesh.cells, -1) {
  for (LocalIndex k = 0; k < cells_.extent_int(0); ++k) position_[cells_(k)] = k;
  const bool as_cells = structure_.coupled_entries.extent(0) == 0;
  graph_ = make_graph(numbering_.rows, numbering_.columns,
                      as_cells ? elements_ : columns_of(structure_.coupled_entries, numbering_.column_of_entry));
  LocalIndex rows = algebra::local_size(*numbering_.rows), with_contact = 0;
  while (with_contact < rows && numbering_.entry_of_column[with_contact] < structure_.cell_entries) ++with_contact;
  points_ = mesh.comm.all(with_contact == rows) ? numbering_.rows : algebra::contiguous_map(with_contact, mesh.comm);
  const auto ones = Teuchos::rcp(new Vector(points_));
  ones->putScalar(1);
  pairing_ = ones;
}

std::vector<GlobalIndex> PolynomialSpace::unknown_ids() const {
  std::vector<GlobalIndex> ids(algebra::local_size(*numbering_.rows));
  for (std::size_t row = 0; row < ids.size(); ++row) ids[row] = structure_.entries.id[numbering_.entry_of_column[row]];
  return ids;
}

Teuchos::RCP<const algebra::MultiVector> PolynomialSpace::coordinates() const {
  auto coordinates = Teuchos::rcp(new algebra::MultiVector(numbering_.rows, 2));
  const auto out = coordinates->getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (std::size_t row = 0; row < out.extent(0); ++row)
    for (int d = 0; d < 2; ++d) out(row, d) = structure_.entries.point[numbering_.entry_of_column[row]][d];
  return coordinates;
}

// -- forms --------------------------------------------------------------------------------------------------------------------------

algebra::MatrixPtr PolynomialSpace::assemble(const CellForm& form) const {
  auto S = Teuchos::rcp(new algebra::Matrix(graph_));
  S->fillComplete();
  const int n = elements_.extent_int(1);
  const LocalIndex most = cells_per_block(n);
  const LocalMatrices A("thixis::method::local_matrices", std::min(most, cells_.extent_int(0)), n, n);
  over_blocks(most, [&](LocalIndex first, LocalIndex count) {
    const LocalMatrices block = Kokkos::subview(A, std::pair(0, count), Kokkos::ALL, Kokkos::ALL);
    form.matrices(first, block);
    scatter(elements_, first, block, *S);
  });
  return S;
}

void PolynomialSpace::apply_form(const CellForm& form, const Coefficients& u, Vector& y) const {
  y.putScalar(0);
  const int n = elements_.extent_int(1);
  const LocalIndex most = cells_per_block(n), length = std::min(most, cells_.extent_int(0));
  const LocalMatrices A("thixis::method::local_matrices", length, n, n);
  const Block2 local("thixis::method::local_forces", length, n);
  over_blocks(most, [&](LocalIndex first, LocalIndex count) {
    const LocalMatrices block = Kokkos::subview(A, std::pair(0, count), Kokkos::ALL, Kokkos::ALL);
    const Block2 part = Kokkos::subview(local, std::pair(0, count), Kokkos::ALL);
    form.matrices(first, block);
    apply(block, first, structure_.element_entries, u, part);
    scatter(elements_, first, part, y);
  });
}

algebra::MatrixPtr PolynomialSpace::stiffness(const scene::Field& tension) const { return assemble(*cell_form(tension)); }

void PolynomialSpace::forces(const scene::Field& tension, const Coefficients& u, Vector& y) const { apply_form(*cell_form(tension), u, y); }

algebra::MatrixPtr PolynomialSpace::mass() const { return assemble(*with_mass(nullptr, 0, 1)); }

std::shared_ptr<const CellForm> PolynomialSpace::with_mass(const std::shared_ptr<const CellForm>& form, double factor,
                                                           double weight) const {
  return std::make_shared<MassForm>(mesh_, cells_, basis_, form, factor, weight);
}

void PolynomialSpace::apply_mass(const Coefficients& w, Vector& y) const { apply_form(*with_mass(nullptr, 0, 1), w, y); }

void PolynomialSpace::move_interface(double t) {
  if (level_set_) quadrature_ = make_quadrature(mesh_, cells_, params_.order(), level_set_, t);
}

void PolynomialSpace::add_moments(const scene::Field& f, double t, Vector& F) const {
  const View<double*> values("thixis::method::force", quadrature_.largest_block);
  const Block2 local("thixis::method::loads", std::min(quadrature_.block_cells, quadrature_.cells()), functions());
  const CellFunctions basis = cell_functions(basis_);
  for_each_block(quadrature_, [&](const QuadratureBlock& block) {
    evaluate(f, t, block, values);
    const Block2 part = Kokkos::subview(local, std::pair(0, block.cells), Kokkos::ALL);
    moments(basis, block, values, part);
    scatter(elements_, block.first, part, F);
  });
}

void PolynomialSpace::add_traces(const std::vector<scene::FieldPtr>& by_tag, double t, Vector& F) const {
  const auto rule = reference::line_quadrature(params_.order());
  const int n = functions(), points = rule.size();
  reference::Tabulation trace[3];
  for (int f = 0; f < 3; ++f) {
    std::vector<double> at;
    for (const double s : rule.point)
      for (const double coordinate : on_face(f, s)) at.push_back(coordinate);
    trace[f] = basis_.tabulate(points, at.data());
  }
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), structure_.element_entries);
  const auto column = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), numbering_.column_of_entry);
  const auto out = algebra::host_view(F);
  for (std::size_t tag = 0; tag < by_tag.size(); ++tag) {
    if (!by_tag[tag]) continue;
    std::vector<std::array<LocalIndex, 2>> faces;  // patch position, local face
    std::vector<double> x, y, length;
    for (LocalIndex F_ = 0; F_ < mesh_.faces; ++F_) {
      if (host_.face_tag(F_) != static_cast<LocalIndex>(tag)) continue;
      const LocalIndex K = mesh::first_cell(host_.face_cells, F_);
      if (position_[K] < 0) continue;
      const int f = mesh::local_face(host_.cell_faces, K, F_);
      const LocalIndex a = host_.cell_vertices(K, (f + 1) % 3), b = host_.cell_vertices(K, (f + 2) % 3);
      const double dx = host_.coordinates(b, 0) - host_.coordinates(a, 0), dy = host_.coordinates(b, 1) - host_.coordinates(a, 1);
      faces.push_back({position_[K], f});
      length.push_back(std::hypot(dx, dy));
      for (const double s : rule.point) {
        x.push_back(host_.coordinates(a, 0) + s * dx);
        y.push_back(host_.coordinates(a, 1) + s * dy);
      }
    }
    std::vector<double> traction(x.size());
    by_tag[tag]->evaluate({x.size(), x.data(), y.data()}, t, traction.data());
    for (std::size_t k = 0; k < faces.size(); ++k)
      for (int l = 0; l < n; ++l) {
        const LocalIndex row = column(entries(faces[k][0], l));
        if (row < 0 || row >= static_cast<LocalIndex>(out.extent(0))) continue;
        for (int q = 0; q < points; ++q)
          out(row) += length[k] * rule.weight[q] * traction[k * points + q] * trace[faces[k][1]].value[q * n + l];
      }
  }
}

void PolynomialSpace::load(const scene::Field&, const scene::Field& force, const BoundaryValues& boundary, double t, Vector& F) const {
  F.putScalar(0);
  mesh_.comm.together([&] {
    add_moments(force, t, F);
    add_traces(boundary.neumann, t, F);
  });
}

// -- coefficients -------------------------------------------------------------------------------------------------------------------

std::vector<double> PolynomialSpace::at_entries(const scene::Field& field, const std::vector<LocalIndex>& entries, double t) const {
  std::vector<double> x(entries.size()), y(entries.size()), values(entries.size());
  for (std::size_t k = 0; k < entries.size(); ++k) {
    x[k] = structure_.entries.point[entries[k]][0];
    y[k] = structure_.entries.point[entries[k]][1];
  }
  field.evaluate({entries.size(), x.data(), y.data()}, t, values.data());
  return values;
}

Coefficients PolynomialSpace::lift(const BoundaryValues& boundary, double t) const {
  const Coefficients values("thixis::method::lift", structure_.entries.size());
  const auto host = Kokkos::create_mirror_view(values);
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), structure_.element_entries);
  mesh_.comm.together([&] {
    for (std::size_t tag = 0; tag < boundary.dirichlet.size(); ++tag) {
      if (!boundary.dirichlet[tag]) continue;
      std::vector<LocalIndex> held;
      for (LocalIndex e = 0; e < structure_.cell_entries; ++e)
        if (numbering_.held[e] == static_cast<LocalIndex>(tag)) held.push_back(e);
      const auto g = at_entries(*boundary.dirichlet[tag], held, t);
      for (std::size_t k = 0; k < held.size(); ++k) host(held[k]) = g[k];
    }
  });
  if (basis_.family() == reference::Family::bernstein) {  // from values on each face to coefficients of its own functions
    const int n = functions();
    for (LocalIndex F = 0; F < mesh_.faces; ++F) {
      const LocalIndex tag = host_.face_tag(F), K = mesh::first_cell(host_.face_cells, F), k = tag < 0 ? -1 : position_[K];
      if (k < 0 || !boundary.dirichlet[tag]) continue;
      const int f = mesh::local_face(host_.cell_faces, K, F);
      const auto on = functions_on(basis_, f);
      std::vector<double> coefficient(on.size(), 0.0);
      for (std::size_t i = 0; i < on.size(); ++i)
        for (const int m : on) coefficient[i] += basis_.from_values()[on[i] * n + m] * host(entries(k, m));
      for (std::size_t i = 0; i < on.size(); ++i)
        if (basis_.entities()[on[i]].kind == reference::Entity::face && numbering_.held[entries(k, on[i])] == tag)
          host(entries(k, on[i])) = coefficient[i];
    }
  }
  Kokkos::deep_copy(values, host);
  return values;
}

Coefficients PolynomialSpace::complete(const Vector& u, const Coefficients& lift) const {
  const Coefficients values("thixis::method::coefficients", structure_.entries.size());
  Kokkos::deep_copy(values, lift);
  Vector ghosted(numbering_.columns);
  const auto import = graph_->getImporter();
  if (import.is_null()) ghosted.assign(u);
  else ghosted.doImport(u, *import, Tpetra::INSERT);
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), values);
  const auto unknowns = algebra::host_view(std::as_const(ghosted));
  for (std::size_t c = 0; c < numbering_.entry_of_column.size(); ++c) host(numbering_.entry_of_column[c]) = unknowns(c);
  Kokkos::deep_copy(values, host);
  return values;
}

void PolynomialSpace::restrict_to_unknowns(const Coefficients& u, Vector& values) const {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), u);
  const auto out = algebra::host_overwrite(values);
  for (std::size_t row = 0; row < out.extent(0); ++row) out(row) = host(numbering_.entry_of_column[row]);
}

void PolynomialSpace::interpolate(const scene::Field& u, double t, Vector& values) const {
  const Coefficients at_points("thixis::method::interpolant", structure_.entries.size());
  mesh_.comm.together([&] {
    std::vector<LocalIndex> all(structure_.cell_entries);
    for (LocalIndex e = 0; e < structure_.cell_entries; ++e) all[e] = e;
    const auto value = at_entries(u, all, t);
    const auto host = Kokkos::create_mirror_view(at_points);
    std::copy(value.begin(), value.end(), host.data());
    Kokkos::deep_copy(at_points, host);
  });
  if (basis_.family() != reference::Family::bernstein) return restrict_to_unknowns(at_points, values);
  const Coefficients coefficients("thixis::method::interpolant", structure_.entries.size());
  transform(matrix_view("thixis::method::from_values", functions(), functions(), basis_.from_values()), cells_.extent_int(0),
            structure_.element_entries, at_points, coefficients);
  restrict_to_unknowns(coefficients, values);
}

void PolynomialSpace::interpolate_obstacle(const scene::Field& psi, Vector& values) const {
  interpolate(psi, 0, values);  // unknowns on faces, where there are some, stay as these are
  const Coefficients coefficients("thixis::method::obstacle", structure_.entries.size());
  mesh_.comm.together([&] {
    std::vector<LocalIndex> all(structure_.cell_entries);
    for (LocalIndex e = 0; e < structure_.cell_entries; ++e) all[e] = e;
    auto value = at_entries(psi, all, 0);
    const auto rule = conforming() ? AtJumps::shared : AtJumps::lowest;
    const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), structure_.element_entries);
    interpolate_with_jumps(basis_, entries, jumps_in_cells(quadrature_, psi, 0), rule, value);
    const auto host = Kokkos::create_mirror_view(coefficients);
    std::copy(value.begin(), value.end(), host.data());
    Kokkos::deep_copy(coefficients, host);
  });
  Vector in_cells(values.getMap());
  restrict_to_unknowns(coefficients, in_cells);
  const auto from = algebra::host_view(in_cells);
  const auto to = algebra::host_view(values);
  for (LocalIndex l = 0; l < algebra::local_size(*points()); ++l) to(l) = from(l);
}

// -- from the coarser mesh ----------------------------------------------------------------------------------------------------------

Block2 PolynomialSpace::of_cells(const std::vector<GlobalIndex>& ids, const Coefficients& u) const {
  const int n = functions();
  const LocalIndex owned_cells = mesh_.owned_cells;
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), structure_.element_entries);
  const auto u_host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), u);
  const auto own = algebra::map_of({mesh_.cell_id.begin(), mesh_.cell_id.begin() + owned_cells}, mesh_.comm);
  const auto needed = algebra::map_of(ids, mesh_.comm);
  algebra::MultiVector owned(own, n), fetched(needed, n);
  {
    const auto values = owned.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (LocalIndex K = 0; K < owned_cells; ++K)
      for (int l = 0; l < n; ++l) values(K, l) = u_host(entries(K, l));
  }
  fetched.doImport(owned, algebra::Import(own, needed), Tpetra::INSERT);
  const Block2 block("thixis::method::of_cells", ids.size(), n);
  const auto out = Kokkos::create_mirror_view(block);
  const auto values = fetched.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t k = 0; k < ids.size(); ++k)
    for (int l = 0; l < n; ++l) out(k, l) = values(k, l);
  Kokkos::deep_copy(block, out);
  return block;
}

Block2 PolynomialSpace::of_own_cells(const Coefficients& u) const {
  const Block2 block("thixis::method::of_cells", mesh_.owned_cells, functions());
  const auto out = Kokkos::create_mirror_view(block);
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), structure_.element_entries);
  const auto u_host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), u);
  for (LocalIndex K = 0; K < mesh_.owned_cells; ++K)
    for (int l = 0; l < functions(); ++l) out(K, l) = u_host(entries(K, l));
  Kokkos::deep_copy(block, out);
  return block;
}

View<double**> PolynomialSpace::from_coarse(const PolynomialSpace& coarse, const Coefficients& coarse_u) const {
  const int n = functions();
  const LocalIndex cells = cells_.extent_int(0);
  THIXIS_ASSERT_EQ(n, coarse.functions(), "levels have the same degree");
  const View<LocalIndex*> child("thixis::method::child", cells), parent("thixis::method::parent", cells);
  const auto child_host = Kokkos::create_mirror_view(child), parent_host = Kokkos::create_mirror_view(parent);
  bool all_here = true;
  for (LocalIndex k = 0; k < cells; ++k) {
    const LocalIndex K = cells_(k);
    child_host(k) = mesh_.cell_shape[K];
    parent_host(k) = mesh_.cell_parent[K];
    all_here = all_here && 0 <= parent_host(k) && parent_host(k) < coarse.mesh_.owned_cells;
  }

  // the parents of this rank's cells may have another owner on the coarse mesh
  Block2 of_parents;
  if (mesh_.comm.all(all_here)) {
    of_parents = coarse.of_own_cells(coarse_u);
  } else {
    std::vector<GlobalIndex> ids(cells);
    for (LocalIndex k = 0; k < cells; ++k) ids[k] = mesh_.cell_parent_id[cells_(k)];
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    for (LocalIndex k = 0; k < cells; ++k)
      parent_host(k) = static_cast<LocalIndex>(std::lower_bound(ids.begin(), ids.end(), mesh_.cell_parent_id[cells_(k)]) - ids.begin());
    of_parents = coarse.of_cells(ids, coarse_u);
  }
  Kokkos::deep_copy(child, child_host);
  Kokkos::deep_copy(parent, parent_host);
  const View<double**> fine("thixis::method::from_coarse", cells, n);
  restrict_to_children({to_children(basis_), child, parent}, of_parents, fine);
  return fine;
}

void PolynomialSpace::prolongate(const Space& coarse, const Coefficients& coarse_u, Vector& values) const {
  const auto fine =
      Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), from_coarse(dynamic_cast<const PolynomialSpace&>(coarse), coarse_u));
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), structure_.element_entries);
  const Coefficients u("thixis::method::prolonged", structure_.entries.size());
  const auto host = Kokkos::create_mirror_view(u);
  for (std::size_t k = 0; k < fine.extent(0); ++k)
    for (std::size_t l = 0; l < fine.extent(1); ++l) host(entries(k, l)) = fine(k, l);
  Kokkos::deep_copy(u, host);
  restrict_to_unknowns(u, values);
}

// -- multiplier ---------------------------------------------------------------------------------------------------------------------

Coefficients PolynomialSpace::multiplier(const Vector& X3) const {
  const Coefficients lambda("thixis::method::multiplier", structure_.entries.size());
  const int n = functions();
  const auto moments = Kokkos::subview(X3.getLocalViewDevice(Tpetra::Access::ReadOnly), Kokkos::ALL, 0);
  invert_mass(matrix_view("thixis::method::inverse_mass", n, n, reference::inverse(n, basis_.mass())), mesh_, cells_, mesh_.owned_cells,
              elements_, structure_.element_entries, moments, lambda);
  Kokkos::fence();
  return lambda;
}

void PolynomialSpace::interpolate_multiplier(const scene::Field& lambda, double t, Vector& X3) const {
  X3.putScalar(0);
  mesh_.comm.together([&] { add_moments(lambda, t, X3); });
}

void PolynomialSpace::prolongate_multiplier(const Space& coarse, const Vector& coarse_X3, Vector& X3) const {
  const auto lambda = from_coarse(dynamic_cast<const PolynomialSpace&>(coarse), coarse.multiplier(coarse_X3));
  const int n = functions();
  const auto M = matrix_view("thixis::method::mass", n, n, basis_.mass());
  const Block2 local("thixis::method::moments", std::min(block_size, cells_.extent_int(0)), n);
  X3.putScalar(0);
  over_blocks(block_size, [&](LocalIndex first, LocalIndex count) {
    const Block2 part = Kokkos::subview(local, std::pair(0, count), Kokkos::ALL);
    moments_of(M, mesh_, cells_, first, lambda, part);
    scatter(elements_, first, part, X3);
  });
}

// -- for error estimates ------------------------------------------------------------------------------------------------------------

void PolynomialSpace::share(const Vector& R, const View<double**>& moments) const {
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), structure_.element_entries);
  const auto column = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), numbering_.column_of_entry);
  if (sharers_.empty()) {  // all cells of an unknown of this rank are patch cells
    sharers_.assign(algebra::local_size(*numbering_.rows), 0);
    for (int k = 0; k < cells_.extent_int(0); ++k)
      for (int l = 0; l < functions(); ++l) {
        const LocalIndex row = column(entries(k, l));
        if (row >= 0 && row < static_cast<LocalIndex>(sharers_.size())) ++sharers_[row];
      }
  }
  Vector part(R, Teuchos::Copy);
  {
    const auto values = algebra::host_view(part);
    for (std::size_t row = 0; row < sharers_.size(); ++row)
      if (sharers_[row] > 1) values(row) /= sharers_[row];
  }
  const Coefficients nothing("thixis::method::nothing", structure_.entries.size());
  gather(structure_.element_entries, functions(), complete(part, nothing), moments);
}

void PolynomialSpace::native_flux(const scene::Field&, const scene::Field&, const Coefficients&, const BoundaryValues&, double,
                                  const HeldSource&, const View<double**>&) const {
  throw core::Error(core::ExitCode::internal, "This method has no flux of its own.");
}

// -- errors -------------------------------------------------------------------------------------------------------------------------

double PolynomialSpace::error(const scene::Field& tension, const Coefficients& u, const Gradient* exact, double t) const {
  const double sum = mesh_.comm.together([&] {
    const int length = quadrature_.largest_block, known_length = exact ? length : 0;
    const View<double*> mu("thixis::method::tension", length), x("thixis::method::gradient_x", known_length),
        y("thixis::method::gradient_y", known_length);
    const CellFunctions basis = cell_functions(basis_);
    double here = 0;
    for_each_block(quadrature_, [&](const QuadratureBlock& block) {
      const LocalIndex owned = std::min(block.cells, mesh_.owned_cells - block.first);
      if (owned <= 0) return;
      evaluate(tension, t, block, mu);
      if (exact) {
        evaluate(*(*exact)[0], t, block, x);
        evaluate(*(*exact)[1], t, block, y);
      }
      here += gradient_error(basis, mesh_, block, owned, {mu, x, y}, structure_.element_entries, u);
    });
    return here;
  });
  return mesh_.comm.sum(sum);
}

double PolynomialSpace::energy(const scene::Field& tension, const Coefficients& u) const { return error(tension, u, nullptr, 0); }

double PolynomialSpace::energy_error(const scene::Field& tension, const Coefficients& u, const Gradient& exact, double t) const {
  return error(tension, u, &exact, t);
}

double PolynomialSpace::l2_error(const Coefficients& u, const scene::Field& exact, double t) const {
  const double sum = mesh_.comm.together([&] {
    const View<double*> known("thixis::method::exact", quadrature_.largest_block);
    const CellFunctions basis = cell_functions(basis_);
    double here = 0;
    for_each_block(quadrature_, [&](const QuadratureBlock& block) {
      const LocalIndex owned = std::min(block.cells, mesh_.owned_cells - block.first);
      if (owned <= 0) return;
      evaluate(exact, t, block, known);
      here += value_error(basis, block, owned, known, structure_.element_entries, u);
    });
    return here;
  });
  return mesh_.comm.sum(sum);
}

double PolynomialSpace::penetration(const Coefficients& u, const scene::Field* obstacle, double t) const {
  const int sides = 8 * basis_.degree();
  std::vector<double> lattice;
  for (int i = 0; i <= sides; ++i)
    for (int j = 0; i + j <= sides; ++j)
      for (const int k : {i, j, sides - i - j}) lattice.push_back(static_cast<double>(k) / sides);
  const int points = static_cast<int>(lattice.size()) / 3;
  const auto lambda = matrix_view("thixis::method::lattice", points, 3, lattice);
  const CellFunctions basis = cell_functions(basis_);
  const LocalIndex most = 256;
  const double depth = mesh_.comm.together([&] {
    double here = 0;
    std::vector<double> x(obstacle ? most * points : 0), y(x.size());
    const Block2 psi("thixis::method::obstacle", obstacle ? most : 0, points);
    const auto host = Kokkos::create_mirror_view(psi);
    for (LocalIndex first = 0; first < mesh_.owned_cells; first += most) {
      const LocalIndex count = std::min(most, mesh_.owned_cells - first);
      if (obstacle) {
        for (LocalIndex e = 0; e < count; ++e)
          for (int q = 0; q < points; ++q)
            for (int d = 0; d < 2; ++d) {
              double& coordinate = (d == 0 ? x : y)[e * points + q];
              coordinate = 0;
              for (int a = 0; a < 3; ++a) coordinate += lattice[3 * q + a] * host_.coordinates(host_.cell_vertices(first + e, a), d);
            }
        obstacle->evaluate({static_cast<std::size_t>(count) * points, x.data(), y.data()}, t, host.data());
        Kokkos::deep_copy(psi, host);
      }
      here = std::max(here, deepest(basis, first, count, lambda, psi, structure_.element_entries, u));
    }
    return here;
  });
  return mesh_.comm.max(depth);
}

// -- output -------------------------------------------------------------------------------------------------------------------------

output::Grid PolynomialSpace::display() const {
  output::Grid grid;
  const int n = functions(), p = basis_.degree();
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), structure_.element_entries);
  grid.global_points = structure_.global_cell_entries;
  grid.global_triangles = mesh_.global_cells * p * p;
  grid.points.resize(structure_.cell_entries);
  grid.point_id.assign(structure_.entries.id.begin(), structure_.entries.id.begin() + structure_.cell_entries);
  grid.point_owner.assign(structure_.entries.owner.begin(), structure_.entries.owner.begin() + structure_.cell_entries);
  for (LocalIndex k = 0; k < cells_.extent_int(0); ++k) {
    const LocalIndex K = cells_(k);
    for (int l = 0; l < n; ++l) {
      const double xi = basis_.lattice()[2 * l], eta = basis_.lattice()[2 * l + 1], lambda[3] = {1 - xi - eta, xi, eta};
      for (int d = 0; d < 2; ++d) {
        double& coordinate = grid.points[entries(k, l)][d] = 0;
        for (int a = 0; a < 3; ++a) coordinate += lambda[a] * host_.coordinates(host_.cell_vertices(K, a), d);
      }
    }
  }
  // the p² pieces of a cell in its lattice
  std::vector<std::array<int, 3>> pieces;
  std::vector<int> at((p + 1) * (p + 1));
  for (int l = 0; l < n; ++l) at[std::lround(p * basis_.lattice()[2 * l]) * (p + 1) + std::lround(p * basis_.lattice()[2 * l + 1])] = l;
  const auto point = [&](int i, int j) { return at[i * (p + 1) + j]; };
  for (int i = 0; i < p; ++i)
    for (int j = 0; i + j < p; ++j) {
      pieces.push_back({point(i, j), point(i + 1, j), point(i, j + 1)});
      if (i + j + 1 < p) pieces.push_back({point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
    }
  for (LocalIndex K = 0; K < mesh_.owned_cells; ++K)
    for (int s = 0; s < p * p; ++s) {
      grid.triangles.push_back({entries(K, pieces[s][0]), entries(K, pieces[s][1]), entries(K, pieces[s][2])});
      grid.triangle_id.push_back(mesh_.cell_id[K] * p * p + s);
      grid.triangle_owner.push_back(mesh_.comm.rank());
    }
  return grid;
}

std::vector<double> PolynomialSpace::shown(const Coefficients& u) const {
  const int n = functions();
  const auto table = basis_.tabulate(n, basis_.lattice().data());
  const Coefficients values("thixis::method::shown", structure_.entries.size());
  transform(matrix_view("thixis::method::at_lattice", n, n, table.value), mesh_.owned_cells, structure_.element_entries, u, values);
  return coefficients_shown(values);
}

std::vector<double> PolynomialSpace::coefficients_shown(const Coefficients& u) const {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), u);
  return std::vector<double>(host.data(), host.data() + structure_.cell_entries);
}

}  // namespace thixis::method
