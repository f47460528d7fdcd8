#pragma once
#include <string>
#include <vector>

#include "thixis/core/deck.hpp"

namespace thixis::core {

/// The outermost list of a Teuchos XML text and its mistakes of form: unknown elements and attributes, missing ones, duplicates.
/// Throws InputError if the text is no XML or its outermost element no list. `file` stands in the message.
Deck::Entry read_xml(const std::string& text, const std::string& file, std::vector<Deck::Mistake>& mistakes);

}  // namespace thixis::core
