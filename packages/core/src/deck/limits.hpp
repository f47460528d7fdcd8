#pragma once
#include <cstddef>

/// How large a deck may be: far above what any scene needs, and small enough that nothing which is done for every entry takes long.
namespace thixis::core::limits {

constexpr std::size_t deck_bytes = std::size_t{1} << 24;
constexpr int nested_lists = 16;
constexpr int entries = 10000;             ///< lists and parameters of a deck
constexpr std::size_t assignments = 1000;  ///< --set
constexpr std::size_t name_bytes = 200;
constexpr std::size_t text_bytes = 10000;  ///< of a text or an expression
constexpr std::size_t array_entries = 100000;

constexpr std::size_t shown_mistakes = 100;
constexpr std::size_t shown_of_array = 10;  ///< wrong entries of one array
constexpr std::size_t shown_bytes = 2000;   ///< of a sentence

}  // namespace thixis::core::limits
