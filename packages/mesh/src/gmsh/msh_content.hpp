#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace thixis::mesh {

/// What a file in the format MSH of Gmsh says, as far as a plane mesh of triangles has a use for it. Numbers are those of the file.
struct MshContent {
  struct Node {
    std::int64_t number;
    std::array<double, 3> x;
  };
  struct Triangle {
    std::int64_t number;
    std::array<std::int64_t, 3> nodes;
    int surface;         ///< the entity of Gmsh it belongs to
    std::int64_t group;  ///< format 2.2, which writes it once for each: the physical group; else 0
  };
  struct Line {
    std::int64_t number;
    std::array<std::int64_t, 2> nodes;
    std::int64_t group;  ///< a line in several physical groups stands here once for each
  };
  std::vector<Node> nodes;
  std::vector<Triangle> triangles;
  std::vector<Line> lines;                    ///< those in a physical group
  std::vector<std::int64_t> elements;         ///< the numbers of all elements, of whatever kind
  std::map<std::int64_t, std::string> names;  ///< of physical groups of curves, as far as they have one
  std::set<int> parts;                        ///< of a partitioned mesh: those with triangles
  std::int64_t count_of_parts = 0;            ///< how many it has, as far as the file lets know
};

/// Reads formats 2.2 and 4.1, text and binary of either byte order. Sections without a use here are skipped. Throws InputError where the
/// file breaks the format or has other elements than points, lines and straight triangles.
MshContent read_msh(std::string bytes, const std::string& name);

}  // namespace thixis::mesh
