/// Every kind of mistake in a deck and the exact sentence it gets.
#include <gtest/gtest.h>

#include "core/params.hpp"

namespace thixis::core::test {

namespace {
std::string newton(const std::string& parameters) { return "<ParameterList name=\"newton\">\n" + parameters + "\n</ParameterList>\n"; }
std::string mesh(const std::string& parameters) { return "<ParameterList name=\"mesh\">\n" + parameters + "\n</ParameterList>\n"; }
std::string entry(const std::string& name, const std::string& type, const std::string& value) {
  return "<Parameter name=\"" + name + "\" type=\"" + type + "\" value=\"" + value + "\"/>";
}
std::string error_set(std::initializer_list<const char*> assignments) {
  return input_error([&] {
    Deck deck = Deck::from_text(deck_with(""), "x.xml");
    for (const char* assignment : assignments) deck.set(assignment);
    deck.parse(RunParams::schema());
  });
}
}  // namespace

TEST(DeckErrors, an_unknown_name_gets_the_nearest_one) {
  EXPECT_EQ(error_in(newton(entry("max iteration", "int", "3"))),
            "x.xml:4: newton/max iteration: no such parameter. Did you mean 'max iterations'?");
  EXPECT_EQ(error_in("<ParameterList name=\"newtn\"/>"), "x.xml:3: newtn: no such block. Did you mean 'newton'?");
  EXPECT_EQ(error_in(newton("<ParameterList name=\"Initial\"/>")), "x.xml:4: newton/Initial: no such block. Did you mean 'initial'?");
}

TEST(DeckErrors, without_a_near_name_all_are_listed) {
  EXPECT_EQ(error_in(newton(entry("relaxation", "int", "3"))),
            "x.xml:4: newton/relaxation: no such parameter. Valid here: max iterations, damping, nested, c-function, target.");
  EXPECT_EQ(error_in("<ParameterList name=\"output\"/>"), "x.xml:3: output: no such block. Valid here: scene, mesh, newton, linear, time.");
  EXPECT_EQ(error_in(entry("degree", "int", "3")),
            "x.xml:3: degree: no such parameter. There are only blocks here: scene, mesh, newton, linear, time.");
}

TEST(DeckErrors, a_name_of_another_block_is_sent_home) {
  EXPECT_EQ(error_in(newton(entry("preconditioner", "string", "ilu"))),
            "x.xml:4: newton/preconditioner: no such parameter. It belongs to 'linear'.");
  EXPECT_EQ(error_in(entry("restart", "int", "3")), "x.xml:3: restart: no such parameter. It belongs to 'linear'.");
}

TEST(DeckErrors, blocks_and_parameters_are_not_confused) {
  EXPECT_EQ(error_in(entry("newton", "int", "3")),
            "x.xml:3: newton: is a block; write <ParameterList name=\"newton\"> ... </ParameterList>.");
  EXPECT_EQ(error_in(newton("<ParameterList name=\"damping\"/>")),
            "x.xml:4: newton/damping: is a parameter; write <Parameter name=\"damping\" type=\"double\" value=\"...\"/>.");
}

TEST(DeckErrors, numbers_that_are_none) {
  for (const char* text : {"1e-8x", "nan", "inf", "0x10", "", "1,5"})
    EXPECT_EQ(error_in(newton(entry("damping", "double", text))),
              "x.xml:4: newton/damping: '" + std::string(text) + "' is not a number; write e.g. 1e-8.");
  EXPECT_EQ(error_in(newton(entry("max iterations", "int", "3.5"))),
            "x.xml:4: newton/max iterations: '3.5' is not an integer; write e.g. 3.");
  EXPECT_EQ(error_in(newton(entry("max iterations", "int", "3000000000"))),
            "x.xml:4: newton/max iterations: '3000000000' is too large; integers here lie between -2147483648 and 2147483647.");
  EXPECT_EQ(error_in(newton(entry("damping", "int", "1.5"))),
            "x.xml:4: newton/damping: '1.5' is not an integer; write e.g. 3, or a type for numbers with a fraction.");
  EXPECT_EQ(error_in(newton(entry("nested", "bool", "yes"))), "x.xml:4: newton/nested: 'yes' is not a bool; write true or false.");
}

TEST(DeckErrors, a_type_that_does_not_fit) {
  EXPECT_EQ(error_in(newton(entry("damping", "string", "1.5"))),
            "x.xml:4: newton/damping: type=\"string\" is wrong here; write type=\"double\".");
  EXPECT_EQ(error_in(newton(entry("max iterations", "double", "3"))),
            "x.xml:4: newton/max iterations: type=\"double\" is wrong here; write type=\"int\".");
  EXPECT_EQ(error_in(newton(entry("max iterations", "itn", "3"))),
            "x.xml:4: newton/max iterations: type=\"itn\" is wrong here; write type=\"int\".");
  EXPECT_EQ(error_in(newton("<ParameterList name=\"initial\">" + entry("u1", "bool", "true") + "</ParameterList>")),
            "x.xml:4: newton/initial/u1: type=\"bool\" is wrong here; write type=\"string\" or type=\"double\".");
}

TEST(DeckErrors, values_out_of_range) {
  EXPECT_EQ(error_in(newton(entry("max iterations", "int", "-1"))), "x.xml:4: newton/max iterations: must be at least 0, but is -1.");
  EXPECT_EQ(error_in(newton(entry("damping", "double", "2"))), "x.xml:4: newton/damping: must be above 0 and below 2, but is 2.");
  EXPECT_EQ(error_in(newton(entry("target", "double", "0"))), "x.xml:4: newton/target: must be above 0, but is 0.");
  EXPECT_EQ(error_in(newton(entry("c-function", "string", "Min"))), "x.xml:4: newton/c-function: no such value 'Min'. Did you mean 'min'?");
  EXPECT_EQ(error_in(newton(entry("c-function", "string", "smooth"))),
            "x.xml:4: newton/c-function: no such value 'smooth'. Write one of min, fischer-burmeister.");
}

TEST(DeckErrors, arrays) {
  EXPECT_EQ(error_in(mesh(entry("lower", "Array(double)", "0, 0"))), "x.xml:4: mesh/lower: '0, 0' is not an array; write e.g. {0.5, 1}.");
  EXPECT_EQ(error_in(mesh(entry("lower", "Array(double)", "{0, 0, 1}"))), "x.xml:4: mesh/lower: must have 2 entries, but has 3.");
  EXPECT_EQ(error_in(mesh(entry("cells", "Array(int)", "{}"))), "x.xml:4: mesh/cells: must have 1 to 2 entries, but has 0.");
  EXPECT_EQ(error_in(mesh(entry("lower", "Array(double)", "{0, zero}"))),
            "x.xml:4: mesh/lower: entry 2 ('zero') is not a number; write e.g. 1e-8.");
  EXPECT_EQ(error_in(mesh(entry("lower", "Array(double)", "{0, }"))),
            "x.xml:4: mesh/lower: entry 2 ('') is not a number; write e.g. 1e-8.");
  EXPECT_EQ(error_in(mesh(entry("cells", "Array(int)", "{4, 0}"))), "x.xml:4: mesh/cells: entry 2 must be at least 1, but is 0.");
  EXPECT_EQ(error_in(mesh(entry("cells", "Array(double)", "{4}"))),
            "x.xml:4: mesh/cells: type=\"Array(double)\" is wrong here; write type=\"Array(int)\".");
}

TEST(DeckErrors, duplicates_name_the_line_of_the_first) {
  EXPECT_EQ(error_in(newton(entry("damping", "double", "1") + "\n\n" + entry("damping", "double", "1"))),
            "x.xml:6: newton/damping: already given on line 4; remove one of the two.");
  EXPECT_EQ(error_in(newton("") + newton("")), "x.xml:6: newton: already given on line 3; remove one of the two.");
}

TEST(DeckErrors, what_is_required_is_asked_for) {
  EXPECT_EQ(error_of("<ParameterList name=\"thixis\">\n<ParameterList name=\"scene\">\n</ParameterList></ParameterList>"),
            "x.xml:2: scene: 'model' is required; write <Parameter name=\"model\" type=\"string\" value=\"...\"/> with one of membranes, "
            "obstacle.");
  EXPECT_EQ(error_of("\n<ParameterList name=\"thixis\"/>"),
            "x.xml:2: scene: 'model' is required; write <Parameter name=\"model\" type=\"string\" value=\"...\"/> with one of membranes, "
            "obstacle.");
  EXPECT_EQ(error_in("<ParameterList name=\"time\"/>"),
            "x.xml:3: time: 'end' is required; write <Parameter name=\"end\" type=\"double\" value=\"...\"/> with a value above 0.");
}

TEST(DeckErrors, a_misspelt_required_name_is_reported_once) {
  EXPECT_EQ(error_of("<ParameterList name=\"thixis\"><ParameterList name=\"scene\">\n" + entry("modle", "string", "obstacle") +
                     "</ParameterList></ParameterList>"),
            "x.xml:2: scene/modle: no such parameter. Did you mean 'model'?");
}

TEST(DeckErrors, sublists_with_free_names_hold_one_kind_of_thing) {
  const auto scene = [](const std::string& inside) {
    return "<ParameterList name=\"thixis\"><ParameterList name=\"scene\">\n" + entry("model", "string", "obstacle") + "\n" + inside +
           "</ParameterList></ParameterList>";
  };
  EXPECT_EQ(error_of(scene("<ParameterList name=\"constants\"><ParameterList name=\"R\"/></ParameterList>")),
            "x.xml:3: scene/constants/R: is a list, but 'constants' holds parameters only.");
  EXPECT_EQ(error_of(scene("<ParameterList name=\"boundary\">" + entry("left", "double", "0") + "</ParameterList>")),
            "x.xml:3: scene/boundary/left: is a parameter, but 'boundary' holds lists; write <ParameterList name=\"left\"> ... "
            "</ParameterList>.");
  EXPECT_EQ(error_of(scene("<ParameterList name=\"boundary\"><ParameterList name=\"left\">\n" + entry("kind", "string", "newman") +
                           "</ParameterList></ParameterList>")),
            "x.xml:4: scene/boundary/left/kind: no such value 'newman'. Did you mean 'neumann'?");
}

TEST(DeckErrors, a_check_of_the_schema_points_at_the_line) {
  EXPECT_EQ(error_of("<ParameterList name=\"thixis\"><ParameterList name=\"scene\">\n" + entry("model", "string", "obstacle") +
                     "<ParameterList name=\"boundary\"><ParameterList name=\"left\">\n" + entry("value", "string", "sin(x") +
                     "</ParameterList></ParameterList></ParameterList></ParameterList>"),
            "x.xml:3: scene/boundary/left/value: the expression 'sin(x' lacks a ')'; close every parenthesis.");
}

TEST(DeckErrors, all_are_reported_at_once_in_the_order_of_the_lines) {
  EXPECT_EQ(
      error_in(newton(entry("dampng", "double", "1") + "\n" + entry("max iterations", "int", "x") + "\n" +
                      entry("c-function", "string", "mix")) +
               "<ParameterList name=\"linear\">\n" + entry("restart", "int", "0") + "\n</ParameterList>\n<ParameterList name=\"tmie\"/>"),
      "x.xml:4: newton/dampng: no such parameter. Did you mean 'damping'?\n"
      "x.xml:5: newton/max iterations: 'x' is not an integer; write e.g. 3.\n"
      "x.xml:6: newton/c-function: no such value 'mix'. Did you mean 'min'?\n"
      "x.xml:9: linear/restart: must be at least 1, but is 0.\n"
      "x.xml:11: tmie: no such block. Did you mean 'time'?");
}

TEST(DeckErrors, what_shows_only_later_gets_its_place_line_by_line) {
  Deck deck = Deck::from_text(deck_with(newton(entry("damping", "double", "1"))), "x.xml");
  deck.set("mesh/lower={0,0}");
  const auto located = [&](const std::string& text) { return std::string(deck.located(InputError(text)).what()); };
  EXPECT_EQ(located("newton/damping: is too small."), "x.xml:4: newton/damping: is too small.");
  EXPECT_EQ(located("newton/initial/u1: is not finite."), "x.xml:3: newton/initial/u1: is not finite.");  // the block it would stand in
  EXPECT_EQ(located("newton/damping: first.\nmesh/lower: second."),
            "x.xml:4: newton/damping: first.\n--set mesh/lower={0,0}: mesh/lower: second.");
  EXPECT_EQ(located("linear/restart: a block that is not given."), "linear/restart: a block that is not given.");
  EXPECT_EQ(located("The output directory 'x' can not be used: it is a file."), "The output directory 'x' can not be used: it is a file.");
  EXPECT_EQ(deck.located(FileError("mesh: no file.")).code(), ExitCode::input_output);
}

TEST(DeckErrors, mistakes_of_form) {
  EXPECT_EQ(error_in("<Paramter name=\"a\"/>"), "x.xml:3: thixis: no such element <Paramter>. Did you mean 'Parameter'?");
  EXPECT_EQ(error_in(newton("<Parameter name=\"damping\" type=\"double\" vlaue=\"1\"/>")),
            "x.xml:4: newton/damping: no such attribute 'vlaue'. Did you mean 'value'?\n"
            "x.xml:4: newton/damping: the attribute 'value' is missing; write <Parameter name=\"...\" type=\"...\" value=\"...\"/>.");
  EXPECT_EQ(error_in(newton("<Parameter name=\"damping\" value=\"1\"/>")),
            "x.xml:4: newton/damping: the attribute 'type' is missing; write <Parameter name=\"...\" type=\"...\" value=\"...\"/>.");
  EXPECT_EQ(error_in(newton("<Parameter type=\"double\" value=\"1\"/>")),
            "x.xml:4: newton: a <Parameter> has no name; write <Parameter name=\"...\" type=\"...\" value=\"...\"/>.");
  EXPECT_EQ(error_in("<ParameterList/>"), "x.xml:3: thixis: a <ParameterList> has no name; write <ParameterList name=\"...\">.");
  EXPECT_EQ(error_in(newton("damping = 3")),
            "x.xml:4: newton: 'damping' stands between the tags; write values as <Parameter name=\"...\" type=\"...\" value=\"...\"/>.");
  EXPECT_EQ(
      error_in(newton("<Parameter name=\"damping\" type=\"double\" value=\"1\">2</Parameter>")),
      "x.xml:4: newton/damping: a <Parameter> holds nothing between its tags; write <Parameter name=\"...\" type=\"...\" value=\"...\"/>.");
  EXPECT_EQ(error_in(newton("<Parameter name=\"damping\" type=\"double\" value=\"1\" value=\"2\"/>")),
            "x.xml:4: newton/damping: the attribute 'value' stands there twice; remove one of the two.");
}

TEST(DeckErrors, texts_that_are_no_deck) {
  EXPECT_EQ(error_of(""), "x.xml:1: the deck is empty; write <ParameterList name=\"...\"> ... </ParameterList>.");
  EXPECT_EQ(error_of("<!-- nothing -->"), "x.xml:1: the deck holds no list; write <ParameterList name=\"...\"> ... </ParameterList>.");
  EXPECT_EQ(error_of("<Deck/>"), "x.xml:1: the outermost element is <Deck>; write <ParameterList name=\"...\"> ... </ParameterList>.");
  EXPECT_EQ(error_of("{\"scene\": 1}"),
            "x.xml:1: there is text outside of the outermost list; write <ParameterList name=\"...\"> ... </ParameterList>.");
  EXPECT_EQ(error_of("<ParameterList name=\"thixis\">\n<ParameterList name=\"a\">\n</ParameterLst>\n</ParameterList>"),
            "x.xml:3: this is no XML, here or just before: start-end tags mismatch.");
  EXPECT_NE(error_of("<ParameterList name=\"thixis\">\n").find("this is no XML"), std::string::npos);
  EXPECT_EQ(error_of(deck_with("") + "<ParameterList name=\"more\"/>"),
            "x.xml:4: a second outermost element begins here; put everything into one <ParameterList>.");
  EXPECT_EQ(error_of("<ParameterList name=\"thixs\">" + deck_with("").substr(30)),
            "x.xml:1: thixs: the outermost list is called 'thixs'; write <ParameterList name=\"thixis\">.");
}

TEST(DeckErrors, assignments_are_named_in_place_of_the_line_and_come_last) {
  EXPECT_EQ(error_set({"newton/max iterations=x"}),
            "--set newton/max iterations=x: newton/max iterations: 'x' is not an integer; write e.g. 3.");
  EXPECT_EQ(error_set({"newtn/damping=1"}), "--set newtn/damping=1: newtn: no such block. Did you mean 'newton'?");
  EXPECT_EQ(error_set({"newton/dampng=1"}), "--set newton/dampng=1: newton/dampng: no such parameter. Did you mean 'damping'?");
  EXPECT_EQ(error_set({"newton=1"}), "--set newton=1: newton: is a block; set one of its parameters, newton/<name>=<value>.");
  EXPECT_EQ(error_set({"newton/damping"}), "--set newton/damping: this is no assignment; write path=value, e.g. --set method/degree=3.");
  EXPECT_EQ(error_set({"=1"}), "--set =1: this is no assignment; write path=value, e.g. --set method/degree=3.");
  EXPECT_EQ(error_set({"newton/c-function=mix", "mesh/lower=0"}),
            "--set newton/c-function=mix: newton/c-function: no such value 'mix'. Did you mean 'min'?\n"
            "--set mesh/lower=0: mesh/lower: '0' is not an array; write e.g. {0.5, 1}.");
}

}  // namespace thixis::core::test
