#include <algorithm>
#include <cmath>
#include <sstream>

#include "thixis/mesh/build.hpp"

namespace thixis::mesh {
namespace {

/// Cells of a coarsest mesh that a rank can be asked to hold whole.
constexpr double whole_limit = 2e7;

std::optional<Mistake> rectangle_mistake(const MeshParams& params) {
  if (params.cells_per_side < 1) return Mistake{"cells per side", "write a number from 1."};
  if (params.lower.size() != 2) return Mistake{"lower", "write two coordinates, such as {0, 0}."};
  if (params.upper.size() != 2) return Mistake{"upper", "write two coordinates, such as {1, 1}."};
  const double width = params.upper[0] - params.lower[0], height = params.upper[1] - params.lower[1];
  if (!(width > 0 && height > 0 && std::isfinite(width) && std::isfinite(height)))
    return Mistake{"upper", "write finite coordinates, each larger than that of 'lower'."};

  const double shorter = std::min(width, height), longer = std::max(width, height);
  const double along = params.cells_per_side * longer / shorter, whole = std::round(along);
  if (4 * whole * params.cells_per_side > whole_limit)
    return Mistake{"cells per side", "every rank holds the coarsest mesh; write fewer cells per side and more refinements."};
  if (std::abs(along - whole) > 1e-10 * whole) {
    std::ostringstream sentence;
    sentence << params.cells_per_side << " squares along the shorter side are " << along
             << " along the longer one; write another number, or corners such that the longer side is a whole multiple of "
             << shorter / params.cells_per_side << ".";
    return Mistake{"cells per side", sentence.str()};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Mistake> mistake(const MeshParams& params) {
  if (params.refinements < 0) return Mistake{"refinements", "write a number from 0."};
  if (params.cells_per_rank < 1) return Mistake{"cells per rank", "write a number from 1."};
  if (params.generator != Generator::file && !params.file.empty())
    return Mistake{"file", "only the generator 'file' reads a mesh; write that, or leave out the file."};
  switch (params.generator) {
    case Generator::file:
      if (params.file.empty()) return Mistake{"file", "write the name of a Gmsh mesh, or choose another generator."};
      break;
    case Generator::disk:
      if (params.rings < 1) return Mistake{"rings", "write a number from 1."};
      if (6.0 * params.rings * params.rings > whole_limit)
        return Mistake{"rings", "every rank holds the coarsest mesh; write fewer rings and more refinements."};
      break;
    case Generator::criss_cross:
    case Generator::rectangle:
      return rectangle_mistake(params);
  }
  return std::nullopt;
}

const core::Schema<MeshParams>& MeshParams::schema() {
  using core::at_least;
  static const auto s =
      core::Schema<MeshParams>("mesh", "The coarsest mesh and its uniform refinements.")
          .choice(
              "generator", &MeshParams::generator,
              {{"criss-cross", Generator::criss_cross},
               {"rectangle", Generator::rectangle},
               {"disk", Generator::disk},
               {"file", Generator::file}},
              "criss-cross: squares cut by both diagonals; rectangle: squares cut from lower left to upper right; disk: rings of triangles "
              "on the unit disk; file: a Gmsh mesh.")
          .parameter("cells per side", &MeshParams::cells_per_side, at_least(1),
                     "Equal squares along the shorter side of the rectangle, before refinement.")
          .parameter("lower", &MeshParams::lower, core::entries(2), "Lower left corner of the rectangle.")
          .parameter("upper", &MeshParams::upper, core::entries(2),
                     "Upper right corner of the rectangle; its longer side must be a whole number of squares.")
          .parameter("rings", &MeshParams::rings, at_least(1), "N rings of the disk make 6 N^2 triangles; a refinement doubles N.")
          .parameter("refinements", &MeshParams::refinements, core::between(0, 20),
                     "Uniform refinements; each makes four triangles of one.")
          .parameter("file", &MeshParams::file,
                     "Gmsh mesh (format 2.2 or 4.1) of straight triangles, relative to the deck; its physical curves name the parts of the "
                     "boundary.")
          .parameter("cells per rank", &MeshParams::cells_per_rank, at_least(1),
                     "The coarsest level with so many cells per rank is the one that is partitioned.")
          .check([](const MeshParams& params, core::Problems& problems) {
            if (const auto found = mistake(params)) problems.add(found->parameter, found->sentence);
          });
  return s;
}

}  // namespace thixis::mesh
