#pragma once
#include <optional>
#include <string>
#include <vector>

#include "thixis/core/comm.hpp"
#include "thixis/core/schema.hpp"

namespace thixis::mesh {

struct Hierarchy;
struct Mesh;

enum class Generator { criss_cross, rectangle, disk, file, interval, tensor };

/// Block `mesh` of the deck.
struct MeshParams {
  Generator generator = Generator::criss_cross;
  int cells_per_side = 4;
  std::vector<double> lower = {0, 0}, upper = {1, 1};
  std::vector<int> cells;  ///< interval: n; tensor: nx, ny
  int rings = 4;
  int refinements = 0;
  std::string file;
  int cells_per_rank = 1000;  ///< the coarsest level with that many cells per rank is partitioned
  static const core::Schema<MeshParams>& schema();
};

/// What is wrong with the parameters taken together, and what to write instead: the parameter and a sentence. Nothing if they describe a
/// mesh. Needs no file. Part of the check of the schema.
struct Mistake {
  std::string parameter, sentence;
};
std::optional<Mistake> mistake(const MeshParams& params);

/// What is wrong where triangles are needed: `interval` and `tensor` make none.
std::optional<Mistake> not_triangles(const MeshParams& params);

/// Builds the mesh of triangles and its uniform refinements, partitioned over the ranks. Throws InputError (parameters, and generators that
/// make no triangles), FileError (mesh file).
/// `folder`: that of the deck; relative mesh files start there.
Hierarchy build(const MeshParams& params, const core::Comm& comm, const std::string& folder);

/// The next finer level: one vertex on each face (its midpoint in the parameter domain), four children of each cell: 4K..4K+3 for the
/// local cell K, so that owned cells stay first. No communication; global numbers and owners follow from those of the coarse level:
///   vertices: those of the coarse level keep local and global number, the one on face F is local number vertices + F, id global_vertices +
///   id(F); cells:    child c of K has id 4 id(K) + c; faces:    the half of F at its end vertex h = 0, 1 is 2F + h, id 2 id(F) + h; the
///   interior face k of K is 2 faces + 3K + k, id 2 global_faces + 3 id(K) + k.
/// Children have the owner of the cell, halves and midpoint of a face that of the face, interior faces that of the cell.
///   red:       child i = 0, 1, 2 keeps vertex i of K as its vertex i, child 3 is the middle one;
///   bisection: with M, P, Q the midpoints of the faces 0, 2, 1 of K = (v0, v1, v2): (P, M, v0), (P, v1, M), (Q, M, v2), (Q, v0, M).
Mesh refine(const Mesh& coarse);

}  // namespace thixis::mesh
