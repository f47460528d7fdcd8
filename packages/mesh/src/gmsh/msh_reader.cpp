#include <algorithm>

#include "gmsh/msh_sections.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/groups.hpp"

namespace thixis::mesh {
namespace {

constexpr MshKind kinds[] = {{msh_triangle, 2, 3, "Triangle 3"},
                             {msh_line, 1, 2, "Line 2"},
                             {15, 0, 1, "Point"},
                             {8, 1, 3, "Line 3"},
                             {26, 1, 4, "Line 4"},
                             {27, 1, 5, "Line 5"},
                             {28, 1, 6, "Line 6"},
                             {62, 1, 7, "Line 7"},
                             {63, 1, 8, "Line 8"},
                             {64, 1, 9, "Line 9"},
                             {65, 1, 10, "Line 10"},
                             {66, 1, 11, "Line 11"},
                             {3, 2, 4, "Quadrilateral 4"},
                             {9, 2, 6, "Triangle 6"},
                             {10, 2, 9, "Quadrilateral 9"},
                             {16, 2, 8, "Quadrilateral 8"},
                             {20, 2, 9, "Triangle 9"},
                             {21, 2, 10, "Triangle 10"},
                             {4, 3, 4, "Tetrahedron 4"},
                             {5, 3, 8, "Hexahedron 8"},
                             {6, 3, 6, "Prism 6"},
                             {7, 3, 5, "Pyramid 5"},
                             {11, 3, 10, "Tetrahedron 10"}};

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// Reads the sections of a file one after the other.
class Reader {
 public:
  explicit Reader(MshSource& source) : source_(source) {}

  MshContent content() {
    for (std::string section = source_.next_section(); !section.empty(); section = source_.next_section()) {
      const bool repeated = !sections_.insert(section).second;
      if (section == "MeshFormat" || section == "NOD") read_format(section);
      else if (!is_known(section)) source_.skip_section();
      else if (version_.empty()) source_.fail("the section $MeshFormat must come before $" + section);
      else if (repeated) source_.fail("the section $" + section + " is there twice");
      else read(section);
    }
    if (version_.empty()) refuse(" is not a Gmsh mesh");
    return std::move(content_);
  }

  [[noreturn]] void refuse(const std::string& why) const {
    throw core::InputError(source_.name() + why + "; save it as Gmsh mesh in format 4.1 or 2.2 (gmsh -save -format msh41).");
  }

 private:
  bool newer() const { return version_ == "4.1"; }

  bool is_known(const std::string& section) const {
    if (section == "PhysicalNames" || section == "Nodes" || section == "Elements") return true;
    return newer() ? section == "Entities" || section == "PartitionedEntities" : section == "ParametricNodes";
  }

  void read(const std::string& section) {
    if (section == "PhysicalNames") read_names();
    else if (section == "Elements" && newer()) read_elements_41(source_, content_, entities_);
    else if (section == "Elements") read_elements_22(source_, content_);
    else if (section == "Nodes" && newer()) read_nodes_41(source_, content_, entities_);
    else if (newer()) read_entities_41(source_, content_, entities_, section == "PartitionedEntities");
    else read_nodes_22(source_, content_, section == "ParametricNodes");
    source_.end_section();
  }

  void read_format(const std::string& section) {
    if (section == "NOD") refuse(" has format 1");
    if (!version_.empty()) source_.fail("the section $MeshFormat is there twice");
    version_ = source_.word();
    if (version_ != "2.2" && !newer()) refuse(" has format " + printable(version_));
    const int kind = source_.text_integer(), bytes = source_.text_integer();
    source_.end_line();
    if (kind != 0 && kind != 1) source_.fail("the file is text (0) or binary (1), not " + std::to_string(kind));
    if (kind == 1 && bytes != 8) source_.fail("numbers of " + std::to_string(bytes) + " bytes can not be read, only those of 8");
    if (kind == 1) source_.enter_binary();
    source_.end_section();
  }

  void read_names() {
    std::size_t names = source_.count(source_.text_integer(), 2);
    for (source_.end_line(); names > 0; --names) {
      const int dimension = source_.text_integer(), group = source_.text_integer();
      const std::string_view name = source_.text();
      if (name.size() < 2 || name.front() != '"' || name.back() != '"' || std::any_of(name.begin(), name.end(), is_control) ||
          name.find(intersection) != std::string_view::npos)
        source_.fail("the name of a physical group stands in quotes, without control characters and without '" + std::string(intersection) +
                     "'");
      source_.end_line();
      if (dimension == 1 && !content_.names.emplace(group, name.substr(1, name.size() - 2)).second)
        source_.fail("the physical group " + std::to_string(group) + " of curves has two names");
    }
  }

  MshSource& source_;
  MshContent content_;
  MshEntities entities_;
  std::string version_;
  std::set<std::string> sections_;
};

}  // namespace

const MshKind& msh_kind(int type, const MshSource& source) {
  const auto* kind = std::find_if(std::begin(kinds), std::end(kinds), [&](const MshKind& candidate) { return candidate.type == type; });
  if (kind == std::end(kinds)) refuse_kind("type " + std::to_string(type), source);
  if (kind->dimension >= 2 && type != msh_triangle) refuse_kind(kind->name, source);
  return *kind;
}

void refuse_kind(const std::string& kind, const MshSource& source) {
  throw core::InputError(source.name() + " has elements of the kind '" + kind +
                         "'; give a plane mesh of straight triangles (in Gmsh: element order 1, no recombination).");
}

MshContent read_msh(std::string bytes, const std::string& name) {
  const bool begins = bytes[std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size())] == '$';
  MshSource source(begins ? std::move(bytes) : std::string(), name);
  return Reader(source).content();
}

}  // namespace thixis::mesh
