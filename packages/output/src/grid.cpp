#include "grid.hpp"

#include <fmt/core.h>

#include <set>

#include "hash.hpp"
#include "hdf5_file.hpp"
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

void check_arrays(const Grid& grid) {
  if (grid.point_id.size() != grid.points.size() || grid.point_owner.size() != grid.points.size() ||
      grid.triangle_id.size() != grid.triangles.size() || grid.triangle_owner.size() != grid.triangles.size())
    wrong("A grid must have as many numbers and owners as points and triangles.");
  const auto points = static_cast<LocalIndex>(grid.points.size());
  for (const auto& triangle : grid.triangles)
    for (const LocalIndex point : triangle)
      if (point < 0 || point >= points) wrong(fmt::format("A triangle of a grid refers to the point {} of {}.", point, points));
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

std::uint64_t fingerprint(const Grid& grid, const core::Comm& comm) {
  std::uint64_t sum = comm.root() ? mixed(mixed(0, grid.global_points), grid.global_triangles) : 0;
  for (std::size_t a = 0; a < grid.points.size(); ++a)
    if (grid.point_owner[a] == comm.rank())
      sum += mixed(mixed(mixed(1, grid.point_id[a]), bits(grid.points[a][0])), bits(grid.points[a][1]));
  for (std::size_t K = 0; K < grid.triangles.size(); ++K) {
    if (grid.triangle_owner[K] != comm.rank()) continue;
    std::uint64_t hash = mixed(2, grid.triangle_id[K]);
    for (const LocalIndex point : grid.triangles[K]) hash = mixed(hash, grid.point_id[point]);
    sum += hash;
  }
  std::uint64_t total = 0;
  MPI_Allreduce(&sum, &total, 1, MPI_UINT64_T, MPI_SUM, comm.mpi());
  return total;
}

void check(const Grid& grid, const std::vector<FieldData>& fields, const core::Comm& comm) {
  comm.together([&] {
    check_arrays(grid);
    const std::size_t points = end_of_owned(grid.point_owner, comm.rank()), triangles = end_of_owned(grid.triangle_owner, comm.rank());
    std::set<std::string> names;
    for (const FieldData& field : fields) {
      check_entry_name("field", field.name);
      check_values(field, field.centre == Centre::vertex ? points : triangles);
      if (!names.insert(field.name).second) wrong(fmt::format("Two fields are called '{}'.", field.name));
    }
  });
  const long long hash = description_hash(fields);
  if (comm.min(hash) != comm.max(hash)) wrong("All ranks must write the same fields in the same order.");
}

}  // namespace thixis::output
