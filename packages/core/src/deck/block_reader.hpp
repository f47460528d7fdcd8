#pragma once
#include <set>
#include <string>
#include <vector>

#include "thixis/core/deck.hpp"

namespace thixis::core {

/// Fills structs from the entries of a deck as their descriptions say, and collects the mistakes.
class BlockReader {
 public:
  using Entry = Deck::Entry;
  using Mistake = Deck::Mistake;

  BlockReader(const Description& root, const std::vector<Mistake>& mistakes);
  /// `list` is the block at `path`, or null if it is not given; then `around` is the innermost given list around it.
  void read(const Description& description, void* object, const Entry* list, const Entry& around, const std::string& path);
  void add(const Entry& place, const std::string& path, const std::string& sentence);
  bool wrong(const std::string& path) const { return wrong_.count(path) != 0; }
  std::vector<Mistake> mistakes() && { return std::move(mistakes_); }

 private:
  void read_parameters(const Description& description, void* object, const Entry* list, const Entry& place, const std::string& path);
  void read_blocks(const Description& description, void* object, const Entry* list, const Entry& place, const std::string& path);
  void read_members(const Description::Block& block, void* object, const Entry& list, const std::string& path);
  void read_parameter(const Description::Parameter& parameter, void* object, const Entry& entry, const std::string& path);
  std::set<std::string> report_unknown(const Description& description, const Entry& list, const std::string& path);
  std::string unknown(const Description& description, const Entry& entry, const std::string& path) const;

  const Description& root_;
  std::vector<Mistake> mistakes_;
  std::set<std::string> wrong_;
};

/// "a/b" from "a" and "b".
std::string joined_path(const std::string& path, const std::string& name);

}  // namespace thixis::core
