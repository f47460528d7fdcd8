#include <gtest/gtest.h>

#include "thixis/algebra/solver.hpp"
#include "thixis/core/deck.hpp"

namespace thixis::algebra::testing {

namespace {

LinearParams read(const std::string& entries) {
  return core::Deck::from_text("<ParameterList name=\"linear\">" + entries + "</ParameterList>", "x.xml").parse(LinearParams::schema());
}
std::string entry(const std::string& name, const std::string& value) {
  return "<Parameter name=\"" + name + "\" type=\"string\" value=\"" + value + "\"/>";
}
/// What the reader says about these entries.
std::string complaint(const std::string& entries) {
  try {
    read(entries);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(LinearParams, are_described_with_the_names_of_the_deck) {
  const core::Description& description = LinearParams::schema().description();
  EXPECT_EQ(description.name(), "linear");
  for (const char* name :
       {"solver", "form", "preconditioner", "ilu level", "overlap", "ilut fill", "restart", "max iterations", "check every"})
    EXPECT_NE(description.parameter(name), nullptr) << name;
}

TEST(LinearParams, are_read_from_a_deck) {
  const LinearParams p = read(entry("solver", "cg") + entry("form", "reduced") + entry("preconditioner", "muelu"));
  EXPECT_EQ(p.solver, SolverKind::cg);
  EXPECT_EQ(p.form, SystemForm::reduced);
  EXPECT_EQ(p.preconditioner, PreconditionerKind::muelu);
  EXPECT_EQ(p.restart, LinearParams().restart);
}
TEST(LinearParams, that_can_not_work_together_are_refused_with_what_to_write_instead) {
  EXPECT_NE(complaint(entry("solver", "cg") + entry("form", "reduced") + entry("preconditioner", "ilut"))
                .find("write 'multigrid', 'muelu' or 'ilu'"),
            std::string::npos);
  EXPECT_EQ(complaint(entry("solver", "direct")), "");
}

}  // namespace thixis::algebra::testing
