#include "thixis/method/space.hpp"

#include "space/columns.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/assert.hpp"

namespace thixis::method {
namespace {

using algebra::Vector;

constexpr LocalIndex cells_of_block = 16384;  ///< many: forms make their buffers anew for each block of an energy

std::vector<LocalIndex> positions(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells) {
  std::vector<LocalIndex> position(mesh.cells, -1);
  const auto K = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), cells);
  for (LocalIndex k = 0; k < K.extent_int(0); ++k) position[K(k)] = k;
  return position;
}

/// Those of the unknowns that are coefficients of cells: the first ones.
algebra::MapPtr contact_points(const Structure& structure, const Numbering& numbering, const core::Comm& comm) {
  const auto entry = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), numbering.entry_of_column);
  const LocalIndex rows = algebra::local_size(*numbering.rows);
  LocalIndex points = 0;
  while (points < rows && entry(points) < structure.cell_entries) ++points;
  return comm.all(points == rows) ? numbering.rows : algebra::contiguous_map(points, comm);
}

}  // namespace

ElementUnknowns columns_of(const Kokkos::View<LocalIndex**, Kokkos::LayoutRight>& entries, const mesh::View<LocalIndex*>& column_of_entry) {
  Kokkos::View<LocalIndex**, Kokkos::LayoutRight> columns("thixis::method::element_columns", entries.extent(0), entries.extent(1));
  Kokkos::parallel_for(
      "thixis::method::element_columns", Kokkos::RangePolicy<>(0, entries.extent_int(0)), KOKKOS_LAMBDA(int e) {
        for (int i = 0; i < entries.extent_int(1); ++i) columns(e, i) = entries(e, i) < 0 ? -1 : column_of_entry(entries(e, i));
      });
  return columns;
}

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

Space::Space(const mesh::Mesh& mesh, const SpaceOptions& options, Structure structure, std::unique_ptr<const Layout> layout)
    : mesh_(mesh),
      host_(mesh::on_host(mesh)),
      options_(options),
      layout_(std::move(layout)),
      basis_(options.params.degree, family(options.params.nodes)),
      structure_(std::move(structure)),
      numbering_(number(structure_.entries, mesh.comm)),
      cells_(patch_cells(mesh)),
      position_(positions(mesh, cells_)),
      quadrature_(make_quadrature(mesh, cells_, options.params.order(), options.level_set, 0, cells_of_block)),
      elements_(columns_of(structure_.element_entries, numbering_.column_of_entry)),
      coupled_(columns_of(structure_.coupled_entries, numbering_.column_of_entry)),
      graph_(make_graph(numbering_.rows, numbering_.columns, coupled_.extent(0) > 0 ? coupled_ : elements_)),
      points_(contact_points(structure_, numbering_, mesh.comm)) {
  const auto D = Teuchos::rcp(new Vector(points_));
  if (nodal_multiplier()) {
    const std::vector<scene::FieldPtr> ones(components(), scene::constant(1));
    mesh.comm.together([&] { add_moments(ones, 0, *D); });
  } else {
    D->putScalar(1);
  }
  pairing_ = D;
}

Space::~Space() = default;

std::vector<GlobalIndex> Space::unknown_ids() const {
  const auto entry = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), numbering_.entry_of_column);
  std::vector<GlobalIndex> ids(algebra::local_size(*numbering_.rows));
  for (std::size_t row = 0; row < ids.size(); ++row) ids[row] = structure_.entries.id[entry(row)];
  return ids;
}

Teuchos::RCP<const algebra::MultiVector> Space::coordinates() const {
  const auto entry = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), numbering_.entry_of_column);
  auto coordinates = Teuchos::rcp(new algebra::MultiVector(numbering_.rows, 2));
  const auto out = coordinates->getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (std::size_t row = 0; row < out.extent(0); ++row)
    for (int d = 0; d < 2; ++d) out(row, d) = structure_.entries.point[entry(row)][d];
  return coordinates;
}

void Space::move_interface(double t) {
  if (options_.level_set) quadrature_ = make_quadrature(mesh_, cells_, options_.params.order(), options_.level_set, t, cells_of_block);
}

Vector Space::with_ghosts(const Vector& u) const {
  const auto import = graph_->getImporter();
  if (import.is_null()) return u;  // the same values, not a copy of them
  Vector ghosted(numbering_.columns);
  ghosted.doImport(u, *import, Tpetra::INSERT);
  return ghosted;
}

Coefficients Space::complete(const Vector& u, const Coefficients& lift) const {
  const Coefficients values("thixis::method::coefficients", structure_.entries.size());
  Kokkos::deep_copy(values, lift);
  const Vector ghosted = with_ghosts(u);
  const auto unknowns = ghosted.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto entry = numbering_.entry_of_column;
  Kokkos::parallel_for(
      "thixis::method::complete", Kokkos::RangePolicy<>(0, entry.extent_int(0)),
      KOKKOS_LAMBDA(int c) { values(entry(c)) = unknowns(c, 0); });
  return values;
}

void Space::restrict_to_unknowns(const Coefficients& u, Vector& values) const {
  const auto out = values.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const auto entry = numbering_.entry_of_column;
  Kokkos::parallel_for(
      "thixis::method::restrict_to_unknowns", Kokkos::RangePolicy<>(0, out.extent_int(0)),
      KOKKOS_LAMBDA(int row) { out(row, 0) = u(entry(row)); });
}

Coefficients Space::multiplier(const Vector& X3) const {
  if (nodal_multiplier()) return complete(X3, Coefficients("thixis::method::nothing", structure_.entries.size()));
  return layout_->multiplier(*this, X3);
}

void Space::interpolate_multiplier(const scene::Field& lambda, double t, Vector& X3) const {
  if (nodal_multiplier()) return interpolate(lambda, t, X3);
  X3.putScalar(0);
  mesh_.comm.together([&] { add_moments(lambda, t, X3); });
}

}  // namespace thixis::method
