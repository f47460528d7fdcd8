#include "patch_data.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>

namespace thixis::equilibration {
namespace {

double number(GlobalIndex id, int place) {
  const double x = std::sin(12.9898 * static_cast<double>(id + 1) + 78.233 * (place + 1)) * 43758.5453;
  return 2 * (x - std::floor(x)) - 1;
}

/// A file with 70 triangles around one vertex, one for each rank.
std::string wheel() {
  constexpr int count = 70;
  const std::string name = "wheel_" + std::to_string(core::Comm().size()) + "_" + std::to_string(core::Comm().rank()) + ".msh";
  std::ofstream file(name);
  file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << count + 1 << "\n1 0.1 0 0\n";
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * 3.14159265358979323846 * i / count;
    file << i + 2 << ' ' << std::cos(angle) << ' ' << std::sin(angle) << " 0\n";
  }
  file << "$EndNodes\n$Elements\n" << 2 * count << '\n';
  for (int i = 0; i < count; ++i) {
    const int a = i + 2, b = (i + 1) % count + 2;
    file << 2 * i + 1 << " 1 2 1 1 " << a << ' ' << b << '\n' << 2 * i + 2 << " 2 2 2 1 1 " << a << ' ' << b << '\n';
  }
  file << "$EndElements\n";
  return name;
}

}  // namespace

mesh::Hierarchy hierarchy(const std::string& name, int refinements, const core::Comm& comm) {
  mesh::MeshParams params;
  params.cells_per_side = 2;
  params.rings = 2;
  params.refinements = refinements;
  params.cells_per_rank = 4;
  if (name == "rectangle") params.generator = mesh::Generator::rectangle, params.lower = {-1, 0.5}, params.upper = {2, 2};
  if (name == "disk") params.generator = mesh::Generator::disk;
  if (name == "file") params.generator = mesh::Generator::file, params.file = "l_shape_22.msh";
  if (name == "wheel") params.generator = mesh::Generator::file, params.file = std::filesystem::absolute(wheel()).string();
  return mesh::build(params, comm, MESH_FILES);
}

std::vector<bool> held_tags(const mesh::Mesh& mesh, Held held) {
  std::vector<bool> tags(mesh.tags.size(), held != Held::none);
  for (std::size_t tag = (tags.size() + 1) / 2; held == Held::some && tag < tags.size(); ++tag) tags[tag] = false;
  return tags;
}

PatchData random_data(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, const std::vector<bool>& held, int q) {
  const auto host = mesh::on_host(mesh);
  const int n = reference::dimension(q), count = cells.extent_int(0);
  const PatchData data = {CellTable("density", count, 3 * n), CellTable("target", count, 2 * n),
                          CellTable("traction", mesh.faces, 2 * (q + 1))};
  std::vector<double> excess(mesh.vertices, 0);  // integral of the density minus what leaves by given fluxes
  std::vector<int> around(mesh.vertices, 0);
  std::vector<bool> free(mesh.vertices, false);
  for (int k = 0; k < count; ++k) {
    const LocalIndex K = cells(k);
    for (int e = 0; e < 3 * n; ++e) data.density(k, e) = number(mesh.cell_id[K], e);
    for (int e = 0; e < 2 * n; ++e) data.target(k, e) = number(mesh.cell_id[K], 3 * n + e);
    for (int i = 0; i < 3; ++i) {
      excess[host.cell_vertices(K, i)] += data.density(k, i * n) / std::sqrt(2);
      ++around[host.cell_vertices(K, i)];
    }
  }
  for (LocalIndex F = 0; F < mesh.faces; ++F) {
    if (host.face_tag(F) < 0) continue;
    for (int end = 0; end < 2; ++end) {
      const LocalIndex a = host.face_vertices(F, end);
      if (held[host.face_tag(F)]) {
        free[a] = true;
        continue;
      }
      for (int j = 0; j <= q; ++j) data.traction(F, end * (q + 1) + j) = number(mesh.face_id[F], end * (q + 1) + j);
      excess[a] -= data.traction(F, end * (q + 1));
    }
  }
  for (int k = 0; k < count; ++k)
    for (int i = 0; i < 3; ++i) {
      const LocalIndex a = host.cell_vertices(cells(k), i);
      if (!free[a]) data.density(k, i * n) -= std::sqrt(2) * excess[a] / around[a];
    }
  return data;
}

}  // namespace thixis::equilibration
