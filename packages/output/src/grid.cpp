#include "grid.hpp"

#include <fmt/core.h>

#include <set>

#include "hash.hpp"
#include "hdf5/hdf5_file.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::output {
namespace {

[[noreturn]] void wrong(const std::string& sentence) { throw core::Error(core::ExitCode::internal, sentence); }

std::size_t end_of_owned(const std::vector<int>& owner, int rank) {
  std::size_t end = owner.size();
  while (end > 0 && owner[end - 1] != rank) --end;
  return end;
}

void check_values(const FieldData& field, std::size_t owned_end) {
  if (field.components < 1 || field.components > 3)
    wrong(fmt::format("The field '{}' has {} components; it must have 1, 2 or 3.", field.name, field.components));
  const std::size_t needed = owned_end * field.components;
  if (field.values.size() < needed || field.values.size() % field.components != 0)
    wrong(fmt::format("The field '{}' has {} values where {} are needed ({} components).", field.name, field.values.size(), needed,
                      field.components));
}

void check_arrays(const Grid& grid, const Cells& cells) {
  if (grid.others.corners != 0 && (grid.global_triangles != 0 || !grid.triangles.empty()))
    wrong("A grid must have cells of one kind, not triangles and others.");
  if (cells.corners < 2 || cells.corners > 4) wrong(fmt::format("The cells of a grid must have 2, 3 or 4 corners, not {}.", cells.corners));
  if (grid.point_id.size() != grid.points.size() || grid.point_owner.size() != grid.points.size() ||
      cells.points.size() != cells.id.size() * cells.corners || cells.id.size() != cells.owner.size())
    wrong(fmt::format("A grid must have as many numbers and owners as points and {}s.", cell_name(cells.corners)));
  const auto points = static_cast<LocalIndex>(grid.points.size());
  for (const LocalIndex point : cells.points)
    if (point < 0 || point >= points)
      wrong(fmt::format("A {} of a grid refers to the point {} of {}.", cell_name(cells.corners), point, points));
}

long long description_hash(const std::vector<FieldData>& fields) {
  std::uint64_t hash = fields.size();
  for (const FieldData& field : fields) {
    for (const char c : field.name) hash = mixed(hash, static_cast<unsigned char>(c));
    hash = mixed(hash, static_cast<std::uint64_t>(field.centre) * 4 + field.components);
  }
  return static_cast<long long>(hash >> 1);
}

}  // namespace

Grid grid_of(const mesh::Mesh& mesh) {
  const auto coordinates = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), mesh.coordinates);
  const auto cell_vertices = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), mesh.cell_vertices);
  Grid grid;
  grid.global_points = mesh.global_vertices;
  grid.global_triangles = mesh.global_cells;
  grid.points.resize(mesh.vertices);
  for (LocalIndex a = 0; a < mesh.vertices; ++a) grid.points[a] = {coordinates(a, 0), coordinates(a, 1)};
  grid.triangles.resize(mesh.cells);
  for (LocalIndex K = 0; K < mesh.cells; ++K) grid.triangles[K] = {cell_vertices(K, 0), cell_vertices(K, 1), cell_vertices(K, 2)};
  grid.point_id = mesh.vertex_id;
  grid.point_owner = mesh.vertex_owner;
  grid.triangle_id = mesh.cell_id;
  grid.triangle_owner = mesh.cell_owner;
  return grid;
}

Cells cells_of(const Grid& grid) {
  if (grid.others.corners != 0) return grid.others;
  Cells cells{3, grid.global_triangles, {}, grid.triangle_id, grid.triangle_owner};
  cells.points.reserve(3 * grid.triangles.size());
  for (const auto& triangle : grid.triangles) cells.points.insert(cells.points.end(), triangle.begin(), triangle.end());
  return cells;
}

const char* cell_name(int corners) { return corners == 2 ? "segment" : corners == 3 ? "triangle" : "quadrilateral"; }

std::uint64_t fingerprint(const Grid& grid, const Cells& cells, const core::Comm& comm) {
  std::uint64_t sum = comm.root() ? mixed(mixed(0, grid.global_points), cells.global) : 0;
  for (std::size_t a = 0; a < grid.points.size(); ++a)
    if (grid.point_owner[a] == comm.rank())
      sum += mixed(mixed(mixed(1, grid.point_id[a]), bits(grid.points[a][0])), bits(grid.points[a][1]));
  for (std::size_t K = 0; K < cells.id.size(); ++K) {
    if (cells.owner[K] != comm.rank()) continue;
    std::uint64_t hash = mixed(2, cells.id[K]);
    for (int i = 0; i < cells.corners; ++i) hash = mixed(hash, grid.point_id[cells.points[K * cells.corners + i]]);
    sum += hash;
  }
  std::uint64_t total = 0;
  MPI_Allreduce(&sum, &total, 1, MPI_UINT64_T, MPI_SUM, comm.mpi());
  return total;
}

void check(const Grid& grid, const Cells& cells, const std::vector<FieldData>& fields, const core::Comm& comm) {
  comm.together([&] {
    check_arrays(grid, cells);
    const std::size_t owned_points = end_of_owned(grid.point_owner, comm.rank()), owned_cells = end_of_owned(cells.owner, comm.rank());
    std::set<std::string> names;
    for (const FieldData& field : fields) {
      check_entry_name("field", field.name);
      check_values(field, field.centre == Centre::vertex ? owned_points : owned_cells);
      if (!names.insert(field.name).second) wrong(fmt::format("Two fields are called '{}'.", field.name));
    }
  });
  if (comm.min(cells.corners) != comm.max(cells.corners)) wrong("The cells of a grid must be of the same kind on all ranks.");
  const long long hash = description_hash(fields);
  if (comm.min(hash) != comm.max(hash)) wrong("All ranks must write the same fields in the same order.");
}

}  // namespace thixis::output
