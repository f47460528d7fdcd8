#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "thixis/core/deck.hpp"

namespace thixis::core {

/// A parameter or block of the deck that takes part in some runs only.
struct Use {
  std::string path;  ///< from the root of the deck
  std::function<bool(const void* params)> holds;
  std::string condition;  ///< what to set: "method/name = dg"
  std::string sentence;   ///< what to write instead; empty: "this is used only with <condition>; leave it out, or write <condition>."
  std::string advice() const;
};

/// The conditions under which entries of a deck take part in a run. Where one does not hold, a deck that gives the entry is refused
/// (check_used), and decks that are written leave it out. Of several conditions of a path the first one that does not hold speaks.
///
///     static const auto uses = core::Uses<RunParams>()
///         .when("method/penalty", [](const RunParams& p) { return p.method.name == "dg"; }, "method/name = dg");
template <class P>
class Uses {
 public:
  Uses& when(const std::string& path, const std::function<bool(const P&)>& holds, const std::string& condition,
             const std::string& sentence = "") {
    all_.push_back({path, [holds](const void* params) { return holds(*static_cast<const P*>(params)); }, condition, sentence});
    return *this;
  }
  const std::vector<Use>& all() const { return all_; }

 private:
  std::vector<Use> all_;
};

/// What takes no part in the run that `params` describes, by path; the pointers are those of `uses`.
using Unused = std::map<std::string, const Use*>;
Unused unused(const std::vector<Use>& uses, const void* params);

/// Throws InputError with one line for each entry that is given, but takes no part, in the order of the deck:
/// "inputs/x.xml:14: method/penalty: this is used only with method/name = dg; leave it out, or write method/name = dg."
/// `set_alone`: judges the entries of Deck::set alone, for a deck in which the others are defaults that were filled in.
void check_used(const Deck& deck, const Unused& unused, bool set_alone = false);

/// The whole deck of `params`, defaults filled in, without what takes no part; reading it gives a run equal to that of `params`.
std::string to_xml(const Description& root, const void* params, const Unused& unused);
/// A deck to start from, filled with `params`: every parameter that takes part in it, as a comment where it has no value.
std::string skeleton(const Description& root, const void* params, const Unused& unused);
/// As describe without `uses`; says the conditions, and decks to start from hold as comments what takes no part in them.
std::string describe(const Description& root, const std::string& path, Format format, const std::vector<Use>& uses);

// The same for a schema.
template <class P>
void check_used(const Deck& deck, const Uses<P>& uses, const P& params, bool set_alone = false) {
  check_used(deck, unused(uses.all(), &params), set_alone);
}
template <class P>
std::string to_xml(const Schema<P>& schema, const P& params, const Uses<P>& uses) {
  return to_xml(schema.description(), &params, unused(uses.all(), &params));
}
template <class P>
std::string skeleton(const Schema<P>& schema, const P& params, const Uses<P>& uses) {
  return skeleton(schema.description(), &params, unused(uses.all(), &params));
}
template <class P>
std::string describe(const Schema<P>& schema, const std::string& path, Format format, const Uses<P>& uses) {
  return describe(schema.description(), path, format, uses.all());
}

}  // namespace thixis::core
