#include <algorithm>

#include "gmsh/msh_sections.hpp"

namespace thixis::mesh {
namespace {

/// What begins the sections of nodes and of elements: their blocks and their number.
struct Header {
  std::int64_t blocks, count;
  explicit Header(MshSource& source, std::size_t numbers_each) : blocks(source.size()), count(source.size()) {
    source.count(count, numbers_each);
    source.size(), source.size();  // lowest and highest number
    source.end_row();
  }
};

/// A block of nodes or elements of one entity.
struct Block {
  int dimension, entity, kind;
  std::size_t count;
  Block(MshSource& source, std::size_t numbers_each)
      : dimension(source.integer()), entity(source.integer()), kind(source.integer()), count(source.count(source.size(), numbers_each)) {
    source.end_row();
  }
  bool ghost(const MshEntities& entities) const { return dimension == 2 && entities.ghosts.count(entity) > 0; }
};

void require_all(std::int64_t read, std::int64_t promised, const char* what, const MshSource& source) {
  if (read != promised)
    source.fail("the blocks hold " + std::to_string(read) + " " + what + ", not the " + std::to_string(promised) +
                " that the section promises");
}

template <class Number>
std::vector<Number> integers(MshSource& source) {
  std::vector<Number> found(source.count(source.size(), 1));
  for (Number& value : found) value = source.integer();
  return found;
}

void read_entity(MshSource& source, int dimension, bool partitioned, MshEntities& entities) {
  const int tag = source.integer();
  if (partitioned) {
    source.integer(), source.integer();  // the entity it is a part of
    std::vector<int> parts = integers<int>(source);
    if (dimension == 2) entities.parts[tag] = std::move(parts);
  }
  for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) source.real();  // the place or the box around it
  std::vector<std::int64_t> groups = integers<std::int64_t>(source);
  if (dimension > 0) integers<int>(source);  // what bounds it
  source.end_row();
  for (std::int64_t& group : groups) group = std::abs(group);
  if (dimension == 1) entities.groups[tag] = std::move(groups);
}

}  // namespace

void read_entities_41(MshSource& source, MshContent& content, MshEntities& entities, bool partitioned) {
  if (!content.nodes.empty() || !content.elements.empty()) source.fail("entities must come before nodes and elements");
  if (partitioned) {
    content.count_of_parts = source.size();
    source.end_row();
    std::size_t ghosts = source.count(source.size(), 2);
    for (source.end_row(); ghosts > 0; --ghosts) {
      entities.ghosts.insert(source.integer());
      source.integer();
      source.end_row();
    }
  }
  std::size_t counts[4];
  for (std::size_t& count : counts) count = source.count(source.size(), 4);
  source.end_row();
  for (int dimension = 0; dimension < 4; ++dimension)
    for (std::size_t k = 0; k < counts[dimension]; ++k) read_entity(source, dimension, partitioned, entities);
}

void read_nodes_41(MshSource& source, MshContent& content, const MshEntities& entities) {
  const Header header(source, 4);
  content.nodes.reserve(static_cast<std::size_t>(header.count));
  std::int64_t read = 0;
  std::vector<std::int64_t> numbers;
  for (std::int64_t b = 0; b < header.blocks; ++b) {
    const Block block(source, 4);
    numbers.resize(block.count);
    for (std::int64_t& number : numbers) {
      number = source.size();
      source.end_row();
    }
    for (const std::int64_t number : numbers) {
      const double x = source.coordinate(), y = source.coordinate(), z = source.coordinate();
      for (int d = 0; d < block.dimension && block.kind != 0; ++d) source.real();  // on the curve or surface
      source.end_row();
      if (!block.ghost(entities)) content.nodes.push_back({number, {x, y, z}});
    }
    read += static_cast<std::int64_t>(block.count);
  }
  require_all(read, header.count, "nodes", source);
}

void read_elements_41(MshSource& source, MshContent& content, const MshEntities& entities) {
  const Header header(source, 2);
  content.elements.reserve(static_cast<std::size_t>(header.count));
  std::int64_t read = 0;
  MshContent ghosts;
  const std::vector<std::int64_t> none;
  const auto next_node = [&] { return source.size(); };
  for (std::int64_t b = 0; b < header.blocks; ++b) {
    const Block block(source, 2);
    const MshKind& kind = msh_kind(block.kind, source);
    if (kind.dimension != block.dimension)
      source.fail(std::string("the kind '") + kind.name + "' does not belong to an entity of this dimension");
    const auto curve = block.dimension == 1 ? entities.groups.find(block.entity) : entities.groups.end();
    for (std::size_t k = 0; k < block.count; ++k) {
      const std::int64_t number = source.size();
      add_element(kind, number, block.entity, curve == entities.groups.end() ? none : curve->second, source, next_node,
                  block.ghost(entities) ? ghosts : content);
      source.end_row();
    }
    ghosts = MshContent();
    if (const auto parts = entities.parts.find(block.entity); block.dimension == 2 && parts != entities.parts.end())
      content.parts.insert(parts->second.begin(), parts->second.end());
    read += static_cast<std::int64_t>(block.count);
  }
  require_all(read, header.count, "elements", source);
}

}  // namespace thixis::mesh
