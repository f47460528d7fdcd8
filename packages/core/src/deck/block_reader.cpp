#include "deck/block_reader.hpp"

#include <fmt/core.h>

#include "deck/values.hpp"
#include "thixis/core/text.hpp"

namespace thixis::core {

namespace {

using Entry = Deck::Entry;

std::vector<std::string> parameter_names(const Description& description) {
  std::vector<std::string> names;
  for (const auto& parameter : description.parameters()) names.push_back(parameter.name);
  return names;
}
std::vector<std::string> block_names(const Description& description) {
  std::vector<std::string> names;
  for (const auto& block : description.blocks()) names.push_back(block.name);
  return names;
}

/// The block that has a parameter (or block) of exactly this name: "" for none.
std::string home_of(const Description& description, const Entry& entry, const std::string& path) {
  const bool here = entry.list ? description.block(entry.name) != nullptr : description.parameter(entry.name) != nullptr;
  if (here && !path.empty()) return path;
  for (const auto& block : description.blocks()) {
    if (!block.inside || !block.single) continue;
    std::string home = home_of(*block.inside, entry, joined_path(path, block.name));
    if (!home.empty()) return home;
  }
  return "";
}

class BlockProblems : public Problems {
 public:
  BlockProblems(BlockReader& reader, const Entry* list, const Entry& place, std::string path)
      : reader_(reader), list_(list), place_(place), path_(std::move(path)) {}

  void add(const std::string& path, const std::string& sentence) override {
    const std::string full = path.empty() ? path_ : joined_path(path_, path);
    bool exact = false;
    if (!reader_.wrong(full)) reader_.add(list_ != nullptr ? list_->along(path, exact) : place_, full, sentence);
  }
  bool given(const std::string& path) const override {
    bool exact = false;
    if (list_ != nullptr) list_->along(path, exact);
    return exact;
  }

 private:
  BlockReader& reader_;
  const Entry* list_;
  const Entry& place_;
  std::string path_;
};

std::string missing(const Description::Parameter& parameter) {
  const std::string rule = parameter.range.rule();
  const std::string with = rule.empty() ? "" : parameter.range.names.empty() ? " with a value " + rule : " with " + rule;
  return fmt::format("'{0}' is required; write <Parameter name=\"{0}\" type=\"{1}\" value=\"...\"/>{2}.", parameter.name,
                     types_of(parameter.kind).front(), with);
}

}  // namespace

std::string joined_path(const std::string& path, const std::string& name) { return path.empty() ? name : path + "/" + name; }

BlockReader::BlockReader(const Description& root, const std::vector<Mistake>& mistakes) : root_(root), mistakes_(mistakes) {
  for (const auto& mistake : mistakes_) wrong_.insert(mistake.path);
}

void BlockReader::add(const Entry& place, const std::string& path, const std::string& sentence) {
  mistakes_.push_back({place.line, place.assignment, path, sentence});
  wrong_.insert(path);
}

void BlockReader::read(const Description& description, void* object, const Entry* list, const Entry& around, const std::string& path) {
  const Entry& place = list != nullptr ? *list : around;
  read_parameters(description, object, list, place, path);
  read_blocks(description, object, list, place, path);
  BlockProblems problems(*this, list, place, path);
  description.check(object, problems);
}

void BlockReader::read_parameters(const Description& description, void* object, const Entry* list, const Entry& place,
                                  const std::string& path) {
  std::set<std::string> misspelt;
  if (list != nullptr) misspelt = report_unknown(description, *list, path);
  for (const auto& parameter : description.parameters()) {
    const Entry* entry = list != nullptr ? list->find(parameter.name, false) : nullptr;
    if (entry != nullptr) read_parameter(parameter, object, *entry, joined_path(path, parameter.name));
    else if (parameter.required && misspelt.count(parameter.name) == 0) add(place, path, missing(parameter));
  }
  for (const auto& block : description.blocks())
    if (block.required && misspelt.count(block.name) == 0 && (list == nullptr || list->find(block.name, true) == nullptr))
      add(place, path, fmt::format("the block '{0}' is required; write <ParameterList name=\"{0}\"> ... </ParameterList>.", block.name));
}

void BlockReader::read_parameter(const Description::Parameter& parameter, void* object, const Entry& entry, const std::string& path) {
  if (!entry.complete) return;
  std::vector<std::string> complaints;
  const auto value = read_value(parameter, entry.type, entry.value, complaints);
  for (const auto& complaint : complaints) add(entry, path, complaint);
  if (value) parameter.set(object, *value);
}

void BlockReader::read_blocks(const Description& description, void* object, const Entry* list, const Entry& place,
                              const std::string& path) {
  for (const auto& block : description.blocks()) {
    const Entry* inside = list != nullptr ? list->find(block.name, true) : nullptr;
    const std::string block_path = joined_path(path, block.name);
    if (!block.single) {
      if (inside != nullptr) read_members(block, object, *inside, block_path);
    } else if (inside != nullptr || (block.always && !block.required)) {
      read(*block.inside, block.open(object, block.name), inside, place, block_path);
    }
  }
}

void BlockReader::read_members(const Description::Block& block, void* object, const Entry& list, const std::string& path) {
  for (const auto& entry : list.inside) {
    const std::string entry_path = joined_path(path, entry.name);
    if (entry.list != (block.inside != nullptr))
      add(entry, entry_path,
          entry.list ? fmt::format("is a list, but '{}' holds parameters only.", block.name)
                     : fmt::format("is a parameter, but '{}' holds lists; write <ParameterList name=\"{}\"> ... </ParameterList>.",
                                   block.name, entry.name));
    else if (entry.list) read(*block.inside, block.open(object, entry.name), &entry, entry, entry_path);
    else read_parameter(*block.value, block.open(object, entry.name), entry, entry_path);
  }
}

/// Returns the names that the unknown ones resemble: they are not reported as missing.
std::set<std::string> BlockReader::report_unknown(const Description& description, const Entry& list, const std::string& path) {
  std::set<std::string> meant;
  for (const auto& entry : list.inside) {
    const bool is_parameter = description.parameter(entry.name) != nullptr, is_block = description.block(entry.name) != nullptr;
    if (entry.list ? is_block : is_parameter) continue;
    add(entry, joined_path(path, entry.name), unknown(description, entry, path));
    if (is_parameter || is_block) meant.insert(entry.name);
    if (const auto near = nearest(entry.name, entry.list ? block_names(description) : parameter_names(description))) meant.insert(*near);
  }
  return meant;
}

std::string BlockReader::unknown(const Description& description, const Entry& entry, const std::string& path) const {
  if (entry.list && description.parameter(entry.name) != nullptr)
    return fmt::format("is a parameter; write <Parameter name=\"{}\" type=\"{}\" value=\"...\"/>.", entry.name,
                       types_of(description.parameter(entry.name)->kind).front());
  if (!entry.list && description.block(entry.name) != nullptr)
    return entry.assignment < 0 ? fmt::format("is a block; write <ParameterList name=\"{}\"> ... </ParameterList>.", entry.name)
                                : fmt::format("is a block; set one of its parameters, {}/<name>=<value>.", joined_path(path, entry.name));

  const auto same_kind = entry.list ? block_names(description) : parameter_names(description);
  const auto other_kind = entry.list ? parameter_names(description) : block_names(description);
  const std::string verdict = entry.list ? "no such block." : "no such parameter.";
  const std::string home = home_of(root_, entry, "");
  if (const auto near = nearest(entry.name, same_kind))
    return fmt::format("{} Did you mean '{}'{}?", verdict, *near, home.empty() ? "" : fmt::format(", or '{}/{}'", home, entry.name));
  if (!home.empty()) return fmt::format("{} It belongs to '{}'.", verdict, home);
  if (const auto near = nearest(entry.name, other_kind))
    return fmt::format("{} Did you mean the {} '{}'?", verdict, entry.list ? "parameter" : "block", *near);
  if (!same_kind.empty()) return fmt::format("{} Valid here: {}.", verdict, join(same_kind));
  return fmt::format("{} There are only {} here: {}.", verdict, entry.list ? "parameters" : "blocks", join(other_kind));
}

}  // namespace thixis::core
