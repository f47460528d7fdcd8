#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "thixis/core/error.hpp"
#include "thixis/fv/grid.hpp"
#include "thixis/fv/host.hpp"

namespace thixis::fv {

inline mesh::MeshParams interval_params(int cells, double lower = 0, double upper = 1) {
  mesh::MeshParams params;
  params.generator = mesh::Generator::interval;
  params.cells = {cells};
  params.lower = {lower};
  params.upper = {upper};
  return params;
}

inline mesh::MeshParams tensor_params(int nx, int ny, std::vector<double> lower = {-1, 2}, std::vector<double> upper = {3, 5}) {
  mesh::MeshParams params;
  params.generator = mesh::Generator::tensor;
  params.cells = {nx, ny};
  params.lower = std::move(lower);
  params.upper = std::move(upper);
  return params;
}

/// A Gmsh 2.2 file of the parallelogram spanned by (n, 0) and (n s, n h), cut into 2 n² equal triangles; acute for s = 0.45, h = 0.85.
/// Returns its folder. Collective.
inline std::string parallelogram(int n, double s, double h, const core::Comm& comm) {
  int root = core::Comm().rank();  // several ranks may ask, each on its own communicator
  comm.broadcast(root);
  const std::string folder = "fv_" + std::to_string(core::Comm().size()) + "/" + std::to_string(comm.size()) + "_" + std::to_string(root);
  comm.on_root([&] {
    std::filesystem::create_directories(folder);
    std::ofstream file(folder + "/parallelogram.msh");
    file.precision(17);
    file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n1 1 \"bottom\"\n1 2 \"right\"\n1 3 \"top\"\n1 4 \"left\"\n"
         << "$EndPhysicalNames\n$Nodes\n"
         << (n + 1) * (n + 1) << "\n";
    const auto node = [&](int i, int j) { return 1 + j * (n + 1) + i; };
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) file << node(i, j) << ' ' << i + s * j << ' ' << h * j << " 0\n";
    file << "$EndNodes\n$Elements\n" << 4 * n + 2 * n * n << "\n";
    int element = 0;
    const auto side = [&](int tag, int a, int b) { file << ++element << " 1 2 " << tag << ' ' << tag << ' ' << a << ' ' << b << "\n"; };
    for (int k = 0; k < n; ++k) {
      side(1, node(k, 0), node(k + 1, 0));
      side(2, node(n, k), node(n, k + 1));
      side(3, node(k, n), node(k + 1, n));
      side(4, node(0, k), node(0, k + 1));
    }
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        file << ++element << " 2 2 5 5 " << node(i, j) << ' ' << node(i + 1, j) << ' ' << node(i, j + 1) << "\n";
        file << ++element << " 2 2 5 5 " << node(i + 1, j) << ' ' << node(i + 1, j + 1) << ' ' << node(i, j + 1) << "\n";
      }
    file << "$EndElements\n";
  });
  return folder;
}

inline mesh::MeshParams file_params(int refinements = 1) {
  mesh::MeshParams params;
  params.generator = mesh::Generator::file;
  params.file = "parallelogram.msh";
  params.refinements = refinements;
  params.cells_per_rank = 20;
  return params;
}

/// Acute triangles: 2 (4n)² cells.
inline Grid acute_grid(int n, const core::Comm& comm) {
  const std::string folder = parallelogram(n, 0.45, 0.85, comm);
  return fv::build(file_params(2), comm, folder);
}

/// The sentence with which a grid is refused; empty if it is built.
inline std::string refusal(const mesh::MeshParams& params, const std::string& folder = ".") {
  try {
    fv::build(params, core::Comm(), folder);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

/// A grid with its length or area.
struct Sample {
  std::string name;
  std::function<Grid(const core::Comm&)> make;
  double volume;
  GlobalIndex cells;
};

inline std::vector<Sample> samples() {
  const auto of = [](const mesh::MeshParams& params) { return [params](const core::Comm& comm) { return fv::build(params, comm, "."); }; };
  mesh::MeshParams refined = tensor_params(3, 4);
  refined.refinements = 1;
  return {{"interval", of(interval_params(17, -2, 5)), 7, 17},
          {"interval of one cell", of(interval_params(1)), 1, 1},
          {"tensor, longer along x", of(tensor_params(11, 4)), 12, 44},
          {"tensor, longer along y", of(tensor_params(2, 9)), 12, 18},
          {"tensor, refined", of(refined), 12, 48},
          {"triangles", [](const core::Comm& comm) { return acute_grid(2, comm); }, 4 * 0.85, 128}};
}

/// Everything that one rank knows, for ranks that know all: the grid on one rank.
inline Grid whole(const Sample& sample) { return sample.make(core::Comm(MPI_COMM_SELF)); }

}  // namespace thixis::fv
