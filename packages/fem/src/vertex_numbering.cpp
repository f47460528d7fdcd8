#include "vertex_numbering.hpp"

#include <algorithm>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/method/quadrature.hpp"

namespace thixis::fem {
namespace {

/// For each local vertex the lowest Dirichlet tag among its boundary faces on this rank, -1 if there is none.
std::vector<LocalIndex> local_dirichlet_tags(const mesh::Mesh& mesh, const std::vector<bool>& dirichlet) {
  const auto face_tag = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), mesh.face_tag);
  const auto face_vertices = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), mesh.face_vertices);
  std::vector<LocalIndex> tag(mesh.vertices, -1);
  for (LocalIndex F = 0; F < mesh.faces; ++F) {
    if (face_tag(F) < 0 || !dirichlet[face_tag(F)]) continue;
    for (int i = 0; i < 2; ++i) {
      LocalIndex& lowest = tag[face_vertices(F, i)];
      if (lowest < 0 || face_tag(F) < lowest) lowest = face_tag(F);
    }
  }
  return tag;
}

}  // namespace

VertexNumbering number_vertices(const mesh::Mesh& mesh, const std::vector<bool>& dirichlet) {
  VertexNumbering numbering;
  const int rank = mesh.comm.rank();
  const auto cell_vertices = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), mesh.cell_vertices);
  const auto patch_cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), method::patch_cells(mesh));
  const std::size_t patch_count = patch_cells.extent(0);

  // vertices that this rank needs: its own first, then the ghosts by owner and id
  std::vector<bool> needed(mesh.vertices, false);
  for (std::size_t k = 0; k < patch_count; ++k)
    for (int i = 0; i < 3; ++i) needed[cell_vertices(patch_cells(k), i)] = true;
  std::vector<LocalIndex> ghosts;
  for (LocalIndex v = 0; v < mesh.vertices; ++v) {
    if (mesh.vertex_owner[v] == rank) numbering.owned_vertices.push_back(v);
    else if (needed[v]) ghosts.push_back(v);
  }
  std::sort(ghosts.begin(), ghosts.end(), [&](LocalIndex v, LocalIndex w) {
    return std::pair(mesh.vertex_owner[v], mesh.vertex_id[v]) < std::pair(mesh.vertex_owner[w], mesh.vertex_id[w]);
  });

  std::vector<GlobalIndex> ids;
  ids.reserve(numbering.owned_vertices.size() + ghosts.size());
  for (const LocalIndex v : numbering.owned_vertices) ids.push_back(mesh.vertex_id[v]);
  numbering.vertex_map = algebra::map_of(ids, mesh.comm);
  for (const LocalIndex v : ghosts) ids.push_back(mesh.vertex_id[v]);
  const auto all_vertices = algebra::map_of(ids, mesh.comm);

  // owned unknowns
  numbering.dirichlet_tag = local_dirichlet_tags(mesh, dirichlet);
  LocalIndex unknowns = 0;
  for (const LocalIndex v : numbering.owned_vertices) unknowns += numbering.dirichlet_tag[v] < 0;
  numbering.rows = algebra::contiguous_map(unknowns, mesh.comm);

  // one number per vertex tells the ghosts: the id of the unknown, or -1 - tag
  algebra::Vector code(numbering.vertex_map), ghost_code(all_vertices);
  {
    const auto values = code.getLocalViewHost(Tpetra::Access::OverwriteAll);
    LocalIndex row = 0;
    for (std::size_t k = 0; k < numbering.owned_vertices.size(); ++k) {
      const LocalIndex tag = numbering.dirichlet_tag[numbering.owned_vertices[k]];
      values(k, 0) = tag < 0 ? static_cast<double>(numbering.rows->getGlobalElement(row++)) : -1.0 - tag;
    }
  }
  ghost_code.doImport(code, algebra::Import(numbering.vertex_map, all_vertices), Tpetra::INSERT);

  // columns
  std::vector<GlobalIndex> columns;
  numbering.column_of_vertex = mesh::View<LocalIndex*>("thixis::fem::column_of_vertex", mesh.vertices);
  const auto column_of_vertex = Kokkos::create_mirror_view(numbering.column_of_vertex);
  Kokkos::deep_copy(column_of_vertex, -1);
  {
    const auto values = ghost_code.getLocalViewHost(Tpetra::Access::ReadOnly);
    const std::size_t owned = numbering.owned_vertices.size();
    for (std::size_t k = 0; k < owned + ghosts.size(); ++k) {
      const LocalIndex v = k < owned ? numbering.owned_vertices[k] : ghosts[k - owned];
      numbering.dirichlet_tag[v] = values(k, 0) < 0 ? static_cast<LocalIndex>(-1 - values(k, 0)) : -1;
      if (values(k, 0) < 0) continue;
      column_of_vertex(v) = static_cast<LocalIndex>(columns.size());
      numbering.vertex_of_column.push_back(v);
      columns.push_back(static_cast<GlobalIndex>(values(k, 0)));
    }
  }
  numbering.columns = algebra::map_of(columns, mesh.comm);
  Kokkos::deep_copy(numbering.column_of_vertex, column_of_vertex);

  numbering.cell_columns = mesh::View<LocalIndex* [3]>("thixis::fem::cell_columns", patch_count);
  const auto cell_columns = Kokkos::create_mirror_view(numbering.cell_columns);
  for (std::size_t k = 0; k < patch_count; ++k)
    for (int i = 0; i < 3; ++i) cell_columns(k, i) = column_of_vertex(cell_vertices(patch_cells(k), i));
  Kokkos::deep_copy(numbering.cell_columns, cell_columns);
  return numbering;
}

}  // namespace thixis::fem
