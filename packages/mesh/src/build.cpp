#include "thixis/mesh/build.hpp"

#include <cmath>
#include <filesystem>

#include "distribute.hpp"
#include "thixis/core/error.hpp"
#include "triangulation.hpp"

namespace thixis::mesh {
namespace {

void broadcast(const core::Comm& comm, Triangulation& triangulation) {
  comm.broadcast(triangulation.points);
  comm.broadcast(triangulation.cells);
  comm.broadcast(triangulation.boundary);
  comm.broadcast(triangulation.name);
  auto tags = static_cast<int>(triangulation.tags.size());
  comm.broadcast(tags);
  triangulation.tags.resize(tags);
  for (std::string& tag : triangulation.tags) comm.broadcast(tag);
}

Triangulation read_on_root(const std::string& file, const core::Comm& comm, const std::string& folder) {
  Triangulation triangulation;
  comm.on_root([&] { triangulation = read_gmsh((std::filesystem::path(folder) / file).lexically_normal().string()); });
  broadcast(comm, triangulation);
  return triangulation;
}

Mesh coarsest_mesh(const MeshParams& params, const core::Comm& comm, const std::string& folder) {
  switch (params.generator) {
    case Generator::criss_cross:
    case Generator::rectangle:
      return make_mesh(rectangle_mesh(params), comm);
    case Generator::disk:
      return make_mesh(disk_mesh(params), comm);
    default:
      break;
  }
  const Triangulation triangulation = read_on_root(params.file, comm, folder);
  Mesh mesh = make_mesh(triangulation, comm);
  require_simple_boundary(mesh, triangulation.name);
  return mesh;
}

/// A mesh that every rank holds whole, as the only rank of a communicator sees it.
std::shared_ptr<const Mesh> alone(Mesh whole) {
  whole.comm = core::Comm(MPI_COMM_SELF);
  whole.owned_cells = whole.cells;
  return std::make_shared<const Mesh>(std::move(whole));
}

/// Local numbers are 32 bit: cells, 1.5 times as many faces and the ghosts of a rank must fit.
void require_size(const MeshParams& params, const Mesh& coarsest) {
  const double limit = 5e8, cells = static_cast<double>(coarsest.global_cells) * std::pow(4.0, params.refinements);
  if (cells / coarsest.comm.size() > limit)
    throw core::InputError("mesh/refinements: a rank would hold more than 500 million cells; write fewer refinements or use more ranks.");
}

}  // namespace

Hierarchy build(const MeshParams& params, const core::Comm& comm, const std::string& folder) {
  for (const auto& found : {mistake(params), not_triangles(params)})
    if (found) throw core::InputError("mesh/" + found->parameter + ": " + found->sentence);

  Hierarchy hierarchy;
  std::deque<Mesh>& levels = hierarchy.levels;
  levels.push_back(coarsest_mesh(params, comm, folder));
  require_size(params, levels[0]);
  hierarchy.root = alone(levels[0]);

  const auto count = static_cast<std::size_t>(params.refinements) + 1;
  const GlobalIndex enough = static_cast<GlobalIndex>(params.cells_per_rank) * comm.size();
  while (levels.size() < count && levels.back().global_cells < enough) levels.push_back(refine(levels.back()));
  hierarchy.partitioned = static_cast<int>(levels.size()) - 1;
  distribute(hierarchy);
  while (levels.size() < count) levels.push_back(refine(levels.back()));
  return hierarchy;
}

}  // namespace thixis::mesh
