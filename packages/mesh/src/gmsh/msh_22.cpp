#include <algorithm>
#include <cstdlib>

#include "gmsh/msh_sections.hpp"

namespace thixis::mesh {
namespace {

/// How many nodes or elements come: a line of text even in a binary file.
std::size_t announced(MshSource& source, std::size_t numbers_each) {
  const std::size_t count = source.count(source.text_integer(), numbers_each);
  source.end_line();
  return count;
}

/// number-of-tags tags: physical group, entity, and of a partitioned mesh the number of parts, the one that owns the element, and with
/// negative sign those that have it as a ghost. All but the first two may be missing.
class Tags {
 public:
  void read(MshSource& source, std::size_t count) {
    tags_.clear();
    for (std::size_t k = 0; k < count; ++k) tags_.push_back(source.integer());
    groups_.clear();
    if (count > 0 && tags_[0] != 0) groups_.push_back(std::abs(static_cast<std::int64_t>(tags_[0])));
  }
  int entity() const { return tags_.size() > 1 ? tags_[1] : 0; }
  const std::vector<std::int64_t>& groups() const { return groups_; }

  void note_parts(MshContent& content) const {
    if (tags_.size() < 4 || static_cast<std::size_t>(tags_[2]) != tags_.size() - 3) return;
    content.parts.insert(tags_[3]);
    for (std::size_t k = 3; k < tags_.size(); ++k)
      content.count_of_parts = std::max(content.count_of_parts, std::abs(static_cast<std::int64_t>(tags_[k])));
  }

 private:
  std::vector<int> tags_;
  std::vector<std::int64_t> groups_;
};

}  // namespace

void read_nodes_22(MshSource& source, MshContent& content, bool parametric) {
  const std::size_t count = announced(source, 4);
  content.nodes.reserve(content.nodes.size() + count);
  for (std::size_t k = 0; k < count; ++k) {
    const int number = source.integer();
    if (number < 0) source.fail(std::to_string(number) + " is no number of a node");
    const double x = source.coordinate(), y = source.coordinate(), z = source.coordinate();
    content.nodes.push_back({number, {x, y, z}});
    if (parametric) {
      const int dimension = source.integer();
      source.integer();
      for (int d = 0; d < dimension && dimension < 3; ++d) source.real();
    }
    source.end_row();
  }
}

void read_elements_22(MshSource& source, MshContent& content) {
  const std::size_t count = announced(source, 2);
  content.elements.reserve(count);
  Tags tags;
  const auto next_node = [&] { return std::int64_t(source.integer()); };
  for (std::size_t read = 0; read < count;) {
    // text: number type tags; binary: a header with the type, how many elements follow, and their number of tags
    const int first = source.integer(), second = source.integer();
    const std::size_t elements = source.binary() ? source.count(second, 1) : 1, tag_count = source.count(source.integer(), 1);
    const MshKind& kind = msh_kind(source.binary() ? first : second, source);
    if (elements == 0 || elements > count - read) source.fail("the elements are not as many as the section says");
    for (std::size_t k = 0; k < elements; ++k) {
      const int number = source.binary() ? source.integer() : first;
      if (number < 0) source.fail(std::to_string(number) + " is no number of an element");
      tags.read(source, tag_count);
      add_element(kind, number, tags.entity(), tags.groups(), source, next_node, content);
      if (kind.type == msh_triangle) tags.note_parts(content);
      source.end_row();
    }
    read += elements;
  }
}

}  // namespace thixis::mesh
