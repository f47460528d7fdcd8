#pragma once
#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/// A second look at files of Gmsh, in which nothing is checked: what does the file list? It shares no line with the reader.
namespace thixis::fuzz {

/// The numbers of a section, as text or binary.
class Numbers {
 public:
  Numbers(const std::string& bytes, bool binary, bool swapped) : bytes_(bytes), binary_(binary), swapped_(swapped) {}

  double word() {  // of text, whatever the file is
    std::size_t begin = bytes_.find_first_not_of(" \t\r\n", at_);
    at_ = std::min(bytes_.find_first_of(" \t\r\n", begin), bytes_.size());
    return std::strtod(bytes_.substr(begin, at_ - begin).c_str(), nullptr);
  }
  void line() { at_ = bytes_.find('\n', at_) + 1; }
  long integer() { return binary_ ? raw<int>() : static_cast<long>(word()); }
  long size() { return binary_ ? raw<long>() : static_cast<long>(word()); }
  double real() { return binary_ ? raw<double>() : word(); }

 private:
  template <class T>
  T raw() {
    std::string part = bytes_.substr(at_, sizeof(T));
    if (swapped_) std::reverse(part.begin(), part.end());
    T value{};
    std::memcpy(&value, part.data(), part.size());
    at_ += sizeof(T);
    return value;
  }

  const std::string& bytes_;
  bool binary_, swapped_;
  std::size_t at_ = 0;
};

class Listing {
 public:
  using Point = std::array<double, 2>;
  using Triangle = std::array<Point, 3>;

  explicit Listing(const std::string& bytes) {
    const std::string format = section(bytes, "MeshFormat");
    old_ = format.substr(0, 3) == "2.2";
    binary_ = format.substr(4, 1) == "1";
    swapped_ = binary_ && format[format.find_first_not_of("\r\n", format.find('\n'))] == 0;
    const std::string parts = section(bytes, "PartitionedEntities"),
                      nodes = section(bytes, old_ && section(bytes, "Nodes").empty() ? "ParametricNodes" : "Nodes"),
                      elements = section(bytes, "Elements");
    if (!old_ && !parts.empty()) find_ghosts({parts, binary_, swapped_});
    old_ ? nodes_22({nodes, binary_, swapped_}, section(bytes, "Nodes").empty()) : nodes_41({nodes, binary_, swapped_});
    old_ ? elements_22({elements, binary_, swapped_}) : elements_41({elements, binary_, swapped_});
  }

  std::multiset<Triangle> triangles() const {
    std::multiset<Triangle> found;
    for (const auto& [surface, groups] : listed_)
      for (const auto& [nodes, copies] : groups) {
        Triangle corners = {points_.at(nodes[0]), points_.at(nodes[1]), points_.at(nodes[2])};
        std::sort(corners.begin(), corners.end());
        found.insert(corners);
      }
    return found;
  }

 private:
  static std::string section(const std::string& bytes, const std::string& name) {
    const auto begin = bytes.find("$" + name), end = bytes.find("$End" + name);
    if (begin == std::string::npos) return "";
    const auto first = bytes.find('\n', begin) + 1;
    return bytes.substr(first, end - first);
  }

  void find_ghosts(Numbers in) {
    in.size();
    for (long ghosts = in.size(); ghosts > 0; --ghosts) {
      ghosts_.insert(in.integer());
      in.integer();
    }
  }
  void nodes_22(Numbers in, bool parametric) {
    const auto count = static_cast<long>(in.word());
    in.line();
    for (long k = 0; k < count; ++k) {
      const long number = in.integer();
      const double x = in.real(), y = in.real();
      in.real();
      points_[number] = {x, y};
      if (!parametric) continue;
      const long dimension = in.integer();
      in.integer();
      for (long d = 0; d < dimension && dimension < 3; ++d) in.real();
    }
  }
  void nodes_41(Numbers in) {
    const long blocks = in.size();
    for (int k = 0; k < 3; ++k) in.size();
    for (long b = 0; b < blocks; ++b) {
      const long dimension = in.integer(), entity = in.integer(), parametric = in.integer(), count = in.size();
      std::vector<long> numbers;
      for (long k = 0; k < count; ++k) numbers.push_back(in.size());
      for (const long number : numbers) {
        const double x = in.real(), y = in.real();
        for (long d = 0; d < 1 + (parametric != 0 ? dimension : 0); ++d) in.real();
        if (dimension != 2 || ghosts_.count(entity) == 0) points_[number] = {x, y};
      }
    }
  }
  void add(long surface, std::array<long, 3> nodes, long group) {
    std::sort(nodes.begin(), nodes.end());
    listed_[surface].insert({nodes, group});
  }
  void elements_22(Numbers in) {
    const auto count = static_cast<long>(in.word());
    in.line();
    for (long read = 0; read < count;) {
      const long first = in.integer(), second = in.integer(), tags = in.integer(), type = binary_ ? first : second;
      for (long k = binary_ ? second : 1; k > 0; --k, ++read) {
        if (binary_) in.integer();
        std::vector<long> tag(std::max(tags, 2L), 0);
        for (long t = 0; t < tags; ++t) tag[t] = in.integer();
        std::vector<long> nodes;
        for (long i = nodes_of(type); i > 0; --i) nodes.push_back(in.integer());
        if (type == 2) add(tag[1], {nodes[0], nodes[1], nodes[2]}, 0);
      }
    }
  }
  void elements_41(Numbers in) {
    const long blocks = in.size();
    for (int k = 0; k < 3; ++k) in.size();
    for (long b = 0; b < blocks; ++b) {
      in.integer();
      const long entity = in.integer(), type = in.integer();
      for (long k = in.size(); k > 0; --k) {
        const long number = in.size();
        std::vector<long> nodes;
        for (long i = nodes_of(type); i > 0; --i) nodes.push_back(in.size());
        if (type == 2 && ghosts_.count(entity) == 0) add(entity, {nodes[0], nodes[1], nodes[2]}, number);
      }
    }
  }
  static long nodes_of(long type) {
    static const std::map<long, long> known = {{1, 2},  {2, 3},  {8, 3},  {15, 1}, {26, 4},  {27, 5},
                                               {28, 6}, {62, 7}, {63, 8}, {64, 9}, {65, 10}, {66, 11}};
    return known.at(type);
  }

  bool old_ = false, binary_ = false, swapped_ = false;
  std::set<long> ghosts_;
  std::map<long, Point> points_;
  std::map<long, std::set<std::pair<std::array<long, 3>, long>>> listed_;  ///< by surface: nodes; in format 4.1 each with its number
};

}  // namespace thixis::fuzz
