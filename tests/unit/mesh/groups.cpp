#include "thixis/mesh/groups.hpp"

#include <gtest/gtest.h>

#include "thixis/core/error.hpp"

namespace thixis::mesh {
namespace {

using Names = std::vector<std::string>;
const Names parts = {"south ∩ rim", "east ∩ rim", "hole"};

std::string refusal(const Names& names) {
  try {
    named_groups(parts, names, "scene/boundary");
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST(groups, of_a_tag_are_those_it_is_the_intersection_of) {
  EXPECT_EQ(groups_of("left ∩ rim ∩ wall 2"), (Names{"left", "rim", "wall 2"}));
  EXPECT_EQ(groups_of("left"), Names{"left"});
  EXPECT_TRUE(is_in_group("left ∩ rim", "rim"));
  EXPECT_FALSE(is_in_group("left ∩ rim", "left ∩ rim"));
}

TEST(named_groups, matter_alone) {
  EXPECT_EQ(named_groups(parts, {}, ""), Names(3));
  EXPECT_EQ(named_groups(parts, {"east"}, ""), (Names{"", "east", ""}));
  EXPECT_EQ(named_groups(parts, {"rim", "hole"}, ""), (Names{"rim", "rim", "hole"}));
}

TEST(named_groups, have_no_edge_in_common) {
  EXPECT_EQ(
      refusal({"east", "rim"}),
      "scene/boundary/rim: some edges of 'rim' are in the group 'east' of the mesh, too, and both are named here; name groups without "
      "a common edge.");
}

TEST(named_groups, are_those_of_the_mesh) {
  EXPECT_EQ(refusal({"north"}), "scene/boundary/north: the mesh has no such part of the boundary; write one of: south, rim, east, hole.");
}

}  // namespace thixis::mesh
