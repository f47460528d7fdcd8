#pragma once
#include <string>
#include <vector>

namespace thixis::mesh {

/// A mesh file names groups of edges, which may overlap. A part of the boundary is the edges that lie in the same groups, and its tag is
/// the intersection of them: "right", "right ∩ rim". A deck speaks of groups.
constexpr const char* intersection = " ∩ ";
std::vector<std::string> groups_of(const std::string& tag);
bool is_in_group(const std::string& tag, const std::string& group);

/// For each of the tags the one of the named groups in which its part lies; empty where there is none. `block`: the path of the block with
/// the names. Throws InputError where no part lies in a named group, or some part lies in two of them; the same on all ranks.
std::vector<std::string> named_groups(const std::vector<std::string>& tags, const std::vector<std::string>& names,
                                      const std::string& block);

}  // namespace thixis::mesh
