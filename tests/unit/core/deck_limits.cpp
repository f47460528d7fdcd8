/// Decks that are too large, nested too deep, or no text: a sentence each.
#include <gtest/gtest.h>

#include "core/params.hpp"

namespace thixis::core::test {
namespace {

std::string nested(int depth) {
  std::string text;
  for (int i = 0; i < depth; ++i) text += "<ParameterList name=\"a\">\n";
  for (int i = 0; i < depth; ++i) text += "</ParameterList>\n";
  return text;
}
std::string constant(const std::string& name, const std::string& value) {
  return "<ParameterList name=\"scene\"><Parameter name=\"model\" type=\"string\" value=\"obstacle\"/><ParameterList name=\"constants\">"
         "<Parameter name=\"" +
         name + "\" type=\"double\" value=\"" + value + "\"/></ParameterList></ParameterList>\n";
}
std::string error_of_constant(const std::string& name, const std::string& value) {
  return error_of("<ParameterList name=\"thixis\">\n" + constant(name, value) + "</ParameterList>\n");
}
bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
std::string error_of_set(const std::string& assignment) {
  return input_error([&] {
    Deck deck = Deck::from_text(deck_with(""), "x.xml");
    deck.set(assignment);
    deck.parse(RunParams::schema());
  });
}

}  // namespace

TEST(DeckLimits, lists_are_nested_so_deep_and_no_deeper) {
  EXPECT_FALSE(contains(error_of(nested(16)), "nested"));
  for (const int depth : {17, 8000, 200000})
    EXPECT_EQ(error_of(nested(depth)), "x.xml:17: the lists are nested too deep; no block of a deck lies in more than 15 others.") << depth;
}

TEST(DeckLimits, decks_are_so_large_and_no_larger) {
  EXPECT_EQ(error_of(deck_with(std::string(1 << 24, ' '))),
            "x.xml:1: the deck is larger than 16 MB; decks are small, and meshes stand in files of their own (mesh/file).");
  std::string many;
  for (int i = 0; i < 10001; ++i) many += "<Parameter name=\"x\" type=\"int\" value=\"1\"/>\n";
  EXPECT_TRUE(contains(error_in(many), "the deck is too long; it may have 10000 entries.")) << error_in(many);
}

TEST(DeckLimits, many_mistakes_are_counted) {
  std::string many;
  for (int i = 0; i < 500; ++i) many += "<Parameter name=\"x" + std::to_string(i) + "\" type=\"int\" value=\"1\"/>\n";
  const std::string error = error_in(many);
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 100);
  EXPECT_TRUE(contains(error, "\n... and 400 more mistakes.")) << error;
}

TEST(DeckLimits, names_texts_and_arrays_are_so_long_and_no_longer) {
  EXPECT_EQ(error_of_constant(std::string(200, 'a'), "1"), "");
  EXPECT_EQ(error_of_constant(std::string(201, 'a'), "1"),
            "x.xml:2: scene/constants: a name of 201 letters is too long; write at most 200.");
  EXPECT_EQ(error_of_constant("a", std::string(10001, '1')),
            "x.xml:2: scene/constants/a: has 10001 letters, which are too many; write at most 10000.");
  std::string array = "{1";
  for (int i = 0; i < 100000; ++i) array += ",x";
  const auto of_array = [](const std::string& values) {
    return error_in("<ParameterList name=\"mesh\"><Parameter name=\"lower\" type=\"Array(double)\" value=\"" + values +
                    "\"/></ParameterList>\n");
  };
  EXPECT_EQ(of_array(array + "}"), "x.xml:3: mesh/lower: has 100001 entries, which are too many; write at most 100000.");
  const std::string wrong = of_array(array.substr(0, 20001) + "}");
  EXPECT_EQ(std::count(wrong.begin(), wrong.end(), '\n'), 9) << wrong;
  EXPECT_LT(of_array(array).size(), 4100u) << "what is shown of a long value is short";
}

TEST(DeckLimits, assignments_are_so_long_and_no_longer) {
  std::string path = "a";
  for (int i = 0; i < 100000; ++i) path += "/a";
  EXPECT_TRUE(contains(error_of_set(path + "=1"), "no parameter of a deck has such a long path"));
  EXPECT_LT(error_of_set(path + "=1").size(), 2200u);
  EXPECT_TRUE(contains(error_of_set(std::string(201, 'a') + "=1"), "no parameter of a deck has such a long path"));
  EXPECT_TRUE(contains(error_of_set("newton/damping=1\x1b[2J"), "a control character")) << error_of_set("newton/damping=1\x1b[2J");
  EXPECT_TRUE(contains(error_of_set("newton/damping=\xff"), "no UTF-8"));
  EXPECT_TRUE(contains(error_of_set("newton/damping=1\n2"), "\\x0a2: here is a control character"));
}

TEST(DeckLimits, texts_are_utf_8) {
  const std::string good = deck_with("");
  EXPECT_EQ(error_of("\xef\xbb\xbf" + good), "") << "a mark of UTF-8 may stand in front";
  EXPECT_EQ(error_of(deck_with("<!-- \xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80 -->")), "");
  std::string wide;
  for (const char c : good) wide += {c, '\0'};
  for (const std::string& text : {"\xff\xfe" + wide, wide, "\xfe\xff" + wide})
    EXPECT_EQ(error_of(text), "x.xml:1: the deck is no UTF-8, but UTF-16 or UTF-32; save it as UTF-8.");
  EXPECT_EQ(error_of(deck_with("<!-- \xe4 -->")),
            "x.xml:3: the byte \\xe4 here is no UTF-8, or a control character; save the deck as UTF-8.");
  for (const char* wrong : {"\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xc3", "\x80", "\xc2\x9b"})
    EXPECT_TRUE(contains(error_of(deck_with(std::string("<!-- ") + wrong + "-->")), "no UTF-8")) << wrong;
}

TEST(DeckLimits, control_characters_are_refused_wherever_they_stand) {
  EXPECT_EQ(error_of(deck_with("<!-- \x1b[2J -->")), "x.xml:3: here is the control character \\x1b; remove it.");
  EXPECT_EQ(error_of(deck_with(std::string("<!-- \0 -->", 10))), "x.xml:3: here is the control character \\x00; remove it.");
  EXPECT_EQ(error_of_constant("a&#10;b", "1"),
            "x.xml:2: scene/constants: 'a\\x0ab' holds the character &#10;, which is none to write; remove it.");
  EXPECT_EQ(error_of_constant("a", "1&#13;"),
            "x.xml:2: scene/constants/a: '1\\x0d' holds the character &#13;, which is none to write; remove it.");
  for (const char* reference : {"&#0;", "&#x0;", "&#27;", "&#x9b;", "&#4294967296;", "&#18446744073709551616;", "&#xD800;", "&#x110000;"})
    EXPECT_EQ(error_of_constant("a", std::string("1") + reference + "000"),
              "x.xml:2: '" + std::string(reference).substr(0, 12) + "' stands for no character that a text can hold; remove it.");
  EXPECT_EQ(error_of_constant("&#228;", "&#49;"), "");
}

TEST(DeckLimits, there_are_no_entities_but_those_of_xml) {
  EXPECT_EQ(error_of("<!DOCTYPE x [<!ENTITY a \"b\">]>\n" + deck_with("")),
            "x.xml:1: a deck has no document type, and no entities of its own; remove <!DOCTYPE ...>.");
}

TEST(DeckLimits, words_of_a_deck_are_shown_as_words) {
  const std::string turned = "\xe2\x80\xae";
  EXPECT_TRUE(contains(error_of(deck_with("<Parameter name=\"" + turned + "x\" type=\"int\" value=\"1\"/>\n")), "\\u202ex"));
}

}  // namespace thixis::core::test
