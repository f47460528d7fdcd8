#pragma once
#include <set>
#include <vector>

#include "gmsh/msh_content.hpp"
#include "gmsh/msh_source.hpp"

/// The sections in which the formats differ. Each is entered, read and ended.
namespace thixis::mesh {

/// A kind of elements, by its number in Gmsh.
struct MshKind {
  int type, dimension, nodes;
  const char* name;
};
constexpr int msh_line = 1, msh_triangle = 2;

/// Throws InputError for kinds that a plane mesh of straight triangles does not have.
const MshKind& msh_kind(int type, const MshSource& source);
[[noreturn]] void refuse_kind(const std::string& kind, const MshSource& source);

/// Reads the nodes of an element, which come next, and adds it to the content, in these physical groups.
template <class NextNode>
void add_element(const MshKind& kind, std::int64_t number, int entity, const std::vector<std::int64_t>& groups, const MshSource& source,
                 const NextNode& next_node, MshContent& content) {
  content.elements.push_back(number);
  if (kind.type == msh_triangle) {
    content.triangles.push_back({number, {}, entity, groups.empty() ? 0 : groups.front()});
    for (std::int64_t& node : content.triangles.back().nodes) node = next_node();
  } else if (kind.type == msh_line) {
    const std::int64_t first = next_node(), second = next_node();
    for (const std::int64_t group : groups) content.lines.push_back({number, {first, second}, group});
  } else {
    if (kind.dimension == 1 && !groups.empty()) refuse_kind(kind.name, source);
    for (int k = 0; k < kind.nodes; ++k) next_node();
  }
}

void read_nodes_22(MshSource& source, MshContent& content, bool parametric);
void read_elements_22(MshSource& source, MshContent& content);

/// Entities of format 4.1: the groups of curves, and what belongs to which part of a partitioned mesh.
struct MshEntities {
  std::map<int, std::vector<std::int64_t>> groups;  ///< of each curve that has some
  std::map<int, std::vector<int>> parts;            ///< of each surface of a partitioned mesh
  std::set<int> ghosts;                             ///< surfaces that hold copies of the cells of other parts
};
void read_entities_41(MshSource& source, MshContent& content, MshEntities& entities, bool partitioned);
void read_nodes_41(MshSource& source, MshContent& content, const MshEntities& entities);
void read_elements_41(MshSource& source, MshContent& content, const MshEntities& entities);

}  // namespace thixis::mesh
