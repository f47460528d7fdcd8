#include <algorithm>
#include <cmath>
#include <sstream>

#include "lengths.hpp"
#include "thixis/mesh/build.hpp"

namespace thixis::mesh {
namespace {

/// Cells of a coarsest mesh that a rank can be asked to hold whole.
constexpr double whole_limit = 2e7;

/// Cells of a length between two coordinates, before they are refined. Of more refinements than that no mesh can be held.
std::optional<Mistake> length_mistake(double lower, double upper, double length, int refinements) {
  const double finest = length / std::exp2(std::min(refinements, 30));
  const std::string mistake = lengths_mistake(std::max(std::abs(lower), std::abs(upper)), finest);
  if (mistake.empty()) return std::nullopt;
  return Mistake{"upper", mistake};
}

std::optional<Mistake> corners_mistake(const MeshParams& params) {
  if (params.lower.size() != 2) return Mistake{"lower", "write two coordinates, such as {0, 0}."};
  if (params.upper.size() != 2) return Mistake{"upper", "write two coordinates, such as {1, 1}."};
  const double width = params.upper[0] - params.lower[0], height = params.upper[1] - params.lower[1];
  if (!(width > 0 && height > 0 && std::isfinite(width) && std::isfinite(height)))
    return Mistake{"upper", "write finite coordinates, each larger than that of 'lower'."};
  return std::nullopt;
}

std::optional<Mistake> rectangle_mistake(const MeshParams& params) {
  if (params.cells_per_side < 1) return Mistake{"cells per side", "write a number from 1."};
  if (auto found = corners_mistake(params)) return found;
  const double width = params.upper[0] - params.lower[0], height = params.upper[1] - params.lower[1];
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
  for (int d = 0; d < 2; ++d)
    if (auto found = length_mistake(params.lower[d], params.upper[d], shorter / params.cells_per_side, params.refinements)) return found;
  return std::nullopt;
}

/// The ends of an interval: one entry each. The defaults have two, of which the first one counts.
bool is_end(const std::vector<double>& entries, const std::vector<double>& by_default) {
  return entries.size() == 1 || entries == by_default;
}

std::optional<Mistake> interval_mistake(const MeshParams& params) {
  const MeshParams defaults;
  if (params.cells.size() != 1 || params.cells[0] < 1) return Mistake{"cells", "write the number of intervals, such as {100}."};
  if (!is_end(params.lower, defaults.lower)) return Mistake{"lower", "an interval begins at one coordinate; write it, such as {0}."};
  if (!is_end(params.upper, defaults.upper)) return Mistake{"upper", "an interval ends at one coordinate; write it, such as {1}."};
  if (!(params.upper[0] > params.lower[0] && std::isfinite(params.upper[0] - params.lower[0])))
    return Mistake{"upper", "write a finite coordinate larger than that of 'lower'."};
  return length_mistake(params.lower[0], params.upper[0], (params.upper[0] - params.lower[0]) / params.cells[0], params.refinements);
}

std::optional<Mistake> tensor_mistake(const MeshParams& params) {
  if (params.cells.size() != 2 || params.cells[0] < 1 || params.cells[1] < 1)
    return Mistake{"cells", "write the numbers of rectangles along x and along y, such as {40, 20}."};
  if (auto found = corners_mistake(params)) return found;
  for (int d = 0; d < 2; ++d)
    if (auto found =
            length_mistake(params.lower[d], params.upper[d], (params.upper[d] - params.lower[d]) / params.cells[d], params.refinements))
      return found;
  return std::nullopt;
}

}  // namespace

std::optional<Mistake> not_triangles(const MeshParams& params) {
  const bool interval = params.generator == Generator::interval;
  if (!interval && params.generator != Generator::tensor) return std::nullopt;
  return Mistake{"generator", std::string(interval ? "an interval" : "a tensor grid") +
                                  " has no triangles, and only the method fv can do without; write method/name = fv, or one of the "
                                  "generators criss-cross, rectangle, disk, file."};
}

std::optional<Mistake> mistake(const MeshParams& params) {
  if (params.refinements < 0) return Mistake{"refinements", "write a number from 0."};
  if (params.cells_per_rank < 1) return Mistake{"cells per rank", "write a number from 1."};
  if (params.generator != Generator::file && !params.file.empty())
    return Mistake{"file", "only the generator 'file' reads a mesh; write that, or leave out the file."};
  const bool counted = params.generator == Generator::interval || params.generator == Generator::tensor;
  if (!counted && !params.cells.empty())
    return Mistake{"cells", "only the generators 'interval' and 'tensor' are counted in cells; write one of them, or leave out the cells."};
  switch (params.generator) {
    case Generator::interval:
      return interval_mistake(params);
    case Generator::tensor:
      return tensor_mistake(params);
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
               {"file", Generator::file},
               {"interval", Generator::interval},
               {"tensor", Generator::tensor}},
              "criss-cross: squares cut by both diagonals; rectangle: squares cut from lower left to upper right; disk: rings of triangles "
              "on the unit disk; file: a Gmsh mesh. For the method fv alone: interval, in one dimension; tensor: equal rectangles.")
          .parameter("cells per side", &MeshParams::cells_per_side, at_least(1),
                     "Equal squares along the shorter side of the rectangle, before refinement.")
          .parameter("lower", &MeshParams::lower, core::entries(1, 2), "Lower left corner of the rectangle; interval: its lower end.")
          .parameter("upper", &MeshParams::upper, core::entries(1, 2),
                     "Upper right corner of the rectangle, whose longer side must be a whole number of squares unless it is a tensor grid; "
                     "interval: its upper end.")
          .parameter("cells", &MeshParams::cells, at_least(1).entries(1, 2),
                     "Before refinement; interval: the number of cells; tensor: the numbers along x and along y.")
          .parameter("rings", &MeshParams::rings, at_least(1), "N rings of the disk make 6 N^2 triangles; a refinement doubles N.")
          .parameter("refinements", &MeshParams::refinements, core::between(0, 20),
                     "Uniform refinements; each makes four triangles or rectangles of one, or two intervals.")
          .parameter("file", &MeshParams::file,
                     "Gmsh mesh (format 2.2 or 4.1, text or binary) of straight triangles, relative to the deck; its physical curves name "
                     "the parts of the boundary.")
          .parameter("cells per rank", &MeshParams::cells_per_rank, at_least(1),
                     "The coarsest level with so many cells per rank is the one that is partitioned.")
          .check([](const MeshParams& params, core::Problems& problems) {
            if (const auto found = mistake(params)) problems.add(found->parameter, found->sentence);
          });
  return s;
}

}  // namespace thixis::mesh
