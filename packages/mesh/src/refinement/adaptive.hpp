#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

/// What a hierarchy with adaptive levels knows besides its levels. Never changed once it is made: copies of a hierarchy share it.
///
/// A **tree** is a cell of the partitioned level with its descendants: what moves between ranks. On one rank, where the levels themselves
/// are whole, only `uniform_levels` and `edge` are filled.
struct Adaptive {
  /// An adaptive level, whole: entries by id.
  struct Step {
    std::vector<LocalIndex> parent;  ///< id
    std::vector<ChildShape> shape;
    std::vector<int> tree_owner;  ///< of each tree
  };
  int uniform_levels = 0;                          ///< the levels before the first adaptive one
  std::vector<std::shared_ptr<const Step>> steps;  ///< of the adaptive levels
  std::shared_ptr<const Mesh> trees;               ///< the partitioned level, whole, alone on its communicator
  std::shared_ptr<const Mesh> finest;              ///< the finest level, likewise
  std::vector<std::uint8_t> edge;                  ///< refinement edge of each cell of the finest level: number of the face
  std::vector<LocalIndex> tree;                    ///< of each cell of the finest level
  std::vector<int> tree_owner;                     ///< of each tree, on the finest level
};

}  // namespace thixis::mesh
