/// Damaged decks: what `thixis check` does, for mutants of every deck in inputs. Each is accepted or refused with a sentence.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "mutate.hpp"
#include "registry.hpp"
#include "thixis/core/deck.hpp"
#include "thixis/core/text.hpp"
#include "thixis/drive/run.hpp"

namespace thixis::fuzz {
namespace {

namespace fs = std::filesystem;

/// Whether the program has the method that a deck names.
bool built(const std::string& deck) {
  const std::string entry = "<Parameter name=\"name\" type=\"string\" value=\"";
  const auto at = deck.find(entry);
  if (at == std::string::npos) return true;
  const auto begin = at + entry.size();
  const std::string name = deck.substr(begin, deck.find('"', begin) - begin);
  const auto& methods = catalogue().methods();
  return std::any_of(methods.begin(), methods.end(), [&](const method::Method& known) { return known.name == name; });
}

std::vector<std::string> decks() {
  std::vector<std::string> texts;
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(THIXIS_INPUTS))
    if (entry.path().extension() == ".xml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    if (built(text.str())) texts.push_back(text.str());
  }
  return texts;
}

/// The sentences about a deck; none if it is a good one.
std::string judged(const std::string& text, const std::string& assignment = "") {
  try {
    core::Deck deck = core::Deck::from_text(text, "mutant.xml");
    if (!assignment.empty()) deck.set(assignment);
    const auto params = deck.parse(catalogue().schema());
    drive::check_served(params);
    catalogue().make(params);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

void expect_words(const std::string& sentences) {
  EXPECT_EQ(core::printable(sentences), sentences);
  EXPECT_LT(sentences.size(), 1000000u);
}

}  // namespace

TEST(mutants, of_decks_are_accepted_or_refused_with_a_sentence) {
  const auto whole = decks();
  ASSERT_GT(whole.size(), 20u);
  for (const std::string& text : whole) EXPECT_EQ(judged(text), "");
  int accepted = 0;
  const int count = mutants(1500);
  for (int seed = 0; seed < count; ++seed) {
    const std::string sentences = judged(mutant(whole[seed % whole.size()], static_cast<std::uint64_t>(seed)));
    expect_words(sentences);
    accepted += sentences.empty() ? 1 : 0;
  }
  EXPECT_GT(accepted, count / 20) << "some damage is harmless: a comment, a number";
  EXPECT_LT(accepted, count / 2);
}

TEST(mutants, of_assignments_are_accepted_or_refused_with_a_sentence) {
  const auto whole = decks();
  const std::vector<std::string> assignments = {
      "method/degree=3",      "mesh/lower={0, 0}",   "scene/data/f1=x < 0.5 ? sin(pi*y) : -1e-3*t^2", "scene/boundary/left/kind=neumann",
      "time/also={0.1, 0.2}", "output/fields=u1, u2"};
  for (int seed = 0; seed < mutants(1500); ++seed)
    expect_words(judged(whole[seed % whole.size()], mutant(assignments[seed % assignments.size()], static_cast<std::uint64_t>(seed))));
}

}  // namespace thixis::fuzz
