#include "thixis/complementarity/parameters.hpp"

#include <gtest/gtest.h>

#include <string>

#include "thixis/core/deck.hpp"
#include "thixis/core/error.hpp"

namespace thixis::complementarity {
namespace {

struct Params {
  NewtonParams newton;
  StoppingParams stopping;
  static const core::Schema<Params>& schema() {
    static const auto s = core::Schema<Params>("thixis", "Test.")
                              .block("newton", &Params::newton, NewtonParams::schema())
                              .block("stopping", &Params::stopping, StoppingParams::schema());
    return s;
  }
};

std::string entry(const std::string& name, const std::string& type, const std::string& value) {
  return "<Parameter name=\"" + name + "\" type=\"" + type + "\" value=\"" + value + "\"/>";
}
Params read(const std::string& newton, const std::string& stopping) {
  const std::string text = "<ParameterList name=\"thixis\"><ParameterList name=\"newton\">" + newton +
                           "</ParameterList><ParameterList name=\"stopping\">" + stopping + "</ParameterList></ParameterList>";
  return core::Deck::from_text(text, "test.xml").parse(Params::schema());
}
/// The message of the error that reading gives.
std::string mistake(const std::string& newton, const std::string& stopping) {
  try {
    read(newton, stopping);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Parameters, every_name_of_the_newton_block_reaches_its_member) {
  const NewtonParams params =
      read(entry("c-function", "string", "fischer-burmeister") + entry("max iterations", "int", "7") + entry("start", "string", "nested") +
               entry("globalization", "string", "line search") + entry("ties", "string", "free") +
               entry("tie tolerance", "double", "1e-12") + entry("scaling", "string", "none"),
           "")
          .newton;
  EXPECT_EQ(params.c_function, CFunction::fischer_burmeister);
  EXPECT_EQ(params.max_iterations, 7);
  EXPECT_EQ(params.start, Start::nested);
  EXPECT_EQ(params.globalization, Globalization::line_search);
  EXPECT_EQ(params.ties, Ties::free);
  EXPECT_EQ(params.tie_tolerance, 1e-12);
  EXPECT_EQ(params.scaling, Scaling::none);
}

TEST(Parameters, every_name_of_the_stopping_block_reaches_its_member) {
  const StoppingParams params =
      read("", entry("rule", "string", "inexact") + entry("linear tolerance", "double", "1e-3") +
                   entry("nonlinear tolerance", "double", "1e-4") + entry("absolute tolerance", "double", "1e-5") +
                   entry("gamma algebraic", "double", "0.1") + entry("gamma linearization", "double", "0.2") +
                   entry("inexact factor", "double", "0.4") + entry("estimate", "bool", "false") + entry("target", "double", "0.01"))
          .stopping;
  EXPECT_EQ(params.rule, StoppingRule::inexact);
  EXPECT_EQ(params.linear_tolerance, 1e-3);
  EXPECT_EQ(params.nonlinear_tolerance, 1e-4);
  EXPECT_EQ(params.absolute_tolerance, 1e-5);
  EXPECT_EQ(params.gamma_algebraic, 0.1);
  EXPECT_EQ(params.gamma_linearization, 0.2);
  EXPECT_EQ(params.inexact_factor, 0.4);
  EXPECT_EQ(params.estimate, false);
  EXPECT_EQ(params.target, 0.01);
}

TEST(Parameters, what_is_not_given_keeps_its_default) {
  const Params params = read("", "");
  EXPECT_EQ(params.newton.c_function, CFunction::min);
  EXPECT_EQ(params.newton.max_iterations, NewtonParams().max_iterations);
  EXPECT_FALSE(params.stopping.estimate.has_value());
  EXPECT_FALSE(params.stopping.target.has_value());
}

TEST(Parameters, no_iterations_are_allowed_but_not_fewer) {
  EXPECT_EQ(read(entry("max iterations", "int", "0"), "").newton.max_iterations, 0);
  EXPECT_NE(mistake(entry("max iterations", "int", "-1"), "").find("at least 0"), std::string::npos);
}

TEST(Parameters, wrong_entries_are_named) {
  EXPECT_NE(mistake(entry("max iteration", "int", "5"), "").find("max iterations"), std::string::npos);
  EXPECT_NE(mistake(entry("c-function", "string", "fisher-burmeister"), "").find("fischer-burmeister"), std::string::npos);
  EXPECT_NE(mistake("", entry("linear tolerance", "double", "0")).find("stopping/linear tolerance"), std::string::npos);
  EXPECT_NE(mistake("", entry("nonlinear tolerance", "double", "1")).find("stopping/nonlinear tolerance"), std::string::npos);
  EXPECT_NE(mistake("", entry("target", "double", "0")).find("stopping/target"), std::string::npos);
  EXPECT_NE(mistake("", entry("inexact factor", "double", "1.5")).find("stopping/inexact factor"), std::string::npos);
}

}  // namespace
}  // namespace thixis::complementarity
