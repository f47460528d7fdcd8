#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "deck/block_reader.hpp"
#include "deck/writer.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/schema.hpp"
#include "thixis/core/text.hpp"
#include "thixis/core/uses.hpp"

namespace thixis::core {

namespace {

/// What is said about a parameter, column by column.
struct Row {
  std::string name, type, initial, values, sentence;
};
/// A block and its rows.
struct Section {
  std::string path, sentence;
  std::vector<Row> rows;
};

std::string values_text(const Range& range) {
  std::string text = range.names.empty() ? range.rule() : join(range.names, " | ");
  if (range.least_entries == 0 && range.most_entries == Range{}.most_entries) return text;
  const std::string count = range.least_entries == range.most_entries    ? fmt::format("{}", range.least_entries)
                            : range.most_entries == Range{}.most_entries ? fmt::format("at least {}", range.least_entries)
                                                                         : fmt::format("{} to {}", range.least_entries, range.most_entries);
  return fmt::format("{} entries{}{}", count, text.empty() ? "" : ", each ", text);
}

Row row_of(const Description::Parameter& parameter, const void* object) {
  const auto value = write_value(parameter, object);
  std::string initial = parameter.required ? "required" : !value ? "none" : value->text.empty() ? "\"\"" : value->text;
  return {parameter.name, kind_name(parameter.kind), initial, values_text(parameter.range), parameter.sentence};
}

/// The struct of a sublist with its defaults, which the struct around it may have changed; `keep` owns it if it had to be made.
const void* defaults_of(const Description::Block& block, const void* object, std::shared_ptr<void>& keep) {
  const auto members = block.members(object);
  if (block.single && !members.empty()) return members.front().second;
  keep = block.inside->make();
  return keep.get();
}

/// Says the conditions of entries and blocks; of several those of the first.
void add_conditions(const Description& root, const std::vector<Use>& uses, std::vector<Section>& sections) {
  std::map<std::string, std::string> conditions;
  for (const auto& use : uses) conditions.emplace(use.path, " Only with " + use.condition + ".");
  const auto add = [&](const std::string& path, std::string& sentence) {
    if (const auto found = conditions.find(path); found != conditions.end()) sentence += found->second;
  };
  for (auto& section : sections) {
    const std::string path = section.path == root.name() ? "" : section.path;
    add(path, section.sentence);
    for (auto& row : section.rows) add(joined_path(path, row.name), row.sentence);
  }
}

void collect(const Description& description, const void* object, const std::string& path, const std::string& sentence,
             std::vector<Section>& sections) {
  Section section{path.empty() ? description.name() : path, sentence, {}};
  for (const auto& parameter : description.parameters()) section.rows.push_back(row_of(parameter, object));
  sections.push_back(std::move(section));
  for (const auto& block : description.blocks()) {
    const std::string inside = joined_path(path, block.name) + (block.single ? "" : "/<name>");
    if (block.inside) {
      std::shared_ptr<void> keep;
      const void* defaults = defaults_of(block, object, keep);
      collect(*block.inside, defaults, inside, block.sentence, sections);
    } else {
      const Row row{"<name>", kind_name(block.value->kind), "none", values_text(block.value->range),
                    "Any number of entries with free names."};
      sections.push_back({joined_path(path, block.name), block.sentence, {row}});
    }
  }
}

/// Keeps the sections of the block at `path` and those inside.
std::vector<Section> within(std::vector<Section> sections, const std::string& path) {
  const auto outside = [&](const Section& section) { return section.path != path && section.path.rfind(path + "/", 0) != 0; };
  if (!path.empty()) sections.erase(std::remove_if(sections.begin(), sections.end(), outside), sections.end());
  return sections;
}

std::string text_table(const Section& section) {
  std::string text = fmt::format("{}: {}\n", section.path, section.sentence);
  std::size_t name = 0, type = 0, initial = 0, values = 0;
  for (const auto& row : section.rows) {
    name = std::max(name, row.name.size());
    type = std::max(type, row.type.size());
    initial = std::max(initial, row.initial.size());
    values = std::max(values, row.values.size());
  }
  for (const auto& row : section.rows)
    text += fmt::format("  {:<{}}  {:<{}}  {:<{}}  {:<{}}  {}\n", row.name, name, row.type, type, row.initial, initial, row.values, values,
                        row.sentence);
  return text;
}

std::string cell(std::string text) {
  for (auto at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) text.replace(at, 1, "\\|");
  return text;
}

std::string markdown_table(const Section& section) {
  std::string text = fmt::format("## {}\n\n{}\n\n", section.path, section.sentence);
  if (section.rows.empty()) return text;
  text += "| parameter | type | default | values | meaning |\n|---|---|---|---|---|\n";
  for (const auto& row : section.rows)
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", row.name, row.type, cell(row.initial), cell(row.values), cell(row.sentence));
  return text + "\n";
}

/// A deck that can be read: everything of the chosen block, required entries elsewhere; what has no value is a comment, and so is what
/// takes no part, unless the deck is one for a scene: then it is left out.
class Skeleton {
 public:
  Skeleton(std::string chosen, const Unused& unused, bool of_scene) : chosen_(std::move(chosen)), unused_(unused), of_scene_(of_scene) {}

  std::string of(const Description& root, const void* params) {
    xml_.open(root.name());
    block(root, params, "");
    xml_.close();
    return xml_.text();
  }

 private:
  /// "", or when it is used: " Only with method/name = dg."
  std::string condition(const std::string& path) const {
    const auto found = unused_.find(path);
    return found == unused_.end() ? "" : " Only with " + found->second->condition + ".";
  }
  bool left_out(const std::string& path) const { return of_scene_ && unused_.count(path) > 0; }

  bool is_chosen(const std::string& path) const { return chosen_.empty() || path == chosen_ || path.rfind(chosen_ + "/", 0) == 0; }
  bool is_around(const std::string& path) const { return chosen_.rfind(path + "/", 0) == 0; }

  void block(const Description& description, const void* object, const std::string& path) {
    for (const auto& parameter : description.parameters())
      if (const std::string inside = joined_path(path, parameter.name);
          (is_chosen(path) || parameter.required || parameter.exemplary) && !left_out(inside))
        entry(parameter, parameter.name, object, inside);
    for (const auto& inside : description.blocks()) {
      const std::string inside_path = joined_path(path, inside.name);
      if ((is_chosen(inside_path) || is_around(inside_path) || has_required(inside)) && !left_out(inside_path))
        sublist(inside, object, inside_path);
    }
  }

  void entry(const Description::Parameter& parameter, const std::string& name, const void* object, const std::string& path) {
    const auto value = (parameter.required && !of_scene_) || object == nullptr ? std::nullopt : write_value(parameter, object);
    const std::string values = values_text(parameter.range);
    const std::string note = parameter.sentence + condition(path) + (values.empty() ? "" : " Values: " + values + ".") +
                             (parameter.required ? " Required." : "");
    const bool before = xml_.hidden();
    const bool shown = value || parameter.required || (parameter.exemplary && !of_scene_);
    if (!shown || unused_.count(path) > 0) xml_.hide(true);
    xml_.parameter(name, value ? *value : example_value(parameter), note);
    xml_.hide(before);
  }

  void sublist(const Description::Block& inside, const void* object, const std::string& path) {
    const bool before = xml_.hidden(), there = inside.single && !inside.members(object).empty();
    const bool wanted = inside.always || inside.required || chosen_ == path || is_around(path) || there;
    if (!wanted || unused_.count(path) > 0) xml_.hide(true);
    xml_.open(inside.name, is_chosen(path) ? inside.sentence + condition(path) : "");
    if (inside.single) {
      std::shared_ptr<void> keep;
      block(*inside.inside, defaults_of(inside, object, keep), path);
    } else {
      members(inside, path);
    }
    xml_.close();
    xml_.hide(before);
  }

  void members(const Description::Block& inside, const std::string& path) {
    const bool before = xml_.hidden();
    xml_.hide(true);
    if (inside.inside) {
      const auto defaults = inside.inside->make();
      xml_.open("NAME");
      block(*inside.inside, defaults.get(), path);
      xml_.close();
    } else {
      entry(*inside.value, "NAME", nullptr, path);
    }
    xml_.hide(before);
  }

  static bool has_required(const Description::Block& inside) {
    if (inside.required) return true;
    if (!inside.always || !inside.inside) return false;
    const auto& parameters = inside.inside->parameters();
    const auto& blocks = inside.inside->blocks();
    return std::any_of(parameters.begin(), parameters.end(), [](const auto& p) { return p.required; }) ||
           std::any_of(blocks.begin(), blocks.end(), has_required);
  }

  std::string chosen_;
  const Unused& unused_;
  bool of_scene_;
  XmlWriter xml_;
};

void check_path(const Description& root, const std::string& path) {
  const Description* place = &root;
  for (std::size_t begin = 0; begin < path.size();) {
    const auto end = std::min(path.find('/', begin), path.size());
    const std::string name = path.substr(begin, end - begin);
    std::vector<std::string> names;
    for (const auto& block : place != nullptr ? place->blocks() : std::vector<Description::Block>{}) names.push_back(block.name);
    const Description::Block* block = place != nullptr ? place->block(name) : nullptr;
    if (block == nullptr)
      throw InputError(names.empty() ? fmt::format("'{}' has no blocks in it; describe '{}' itself.", path.substr(0, begin - (begin > 0)),
                                                   path.substr(0, begin - (begin > 0)))
                                     : fmt::format("no block '{}'. {}", path.substr(0, end), did_you_mean(name, names, "Blocks are")));
    place = block->inside.get();
    begin = end + 1;
  }
}

}  // namespace

std::string skeleton(const Description& root, const void* params, const Unused& unused) {
  return Skeleton("", unused, true).of(root, params);
}

std::string describe(const Description& root, const std::string& path, Format format) { return describe(root, path, format, {}); }

std::string describe(const Description& root, const std::string& path, Format format, const std::vector<Use>& uses) {
  check_path(root, path);
  const auto defaults = root.make();
  if (format == Format::xml) return Skeleton(path, unused(uses, defaults.get()), false).of(root, defaults.get());
  std::vector<Section> sections;
  collect(root, defaults.get(), "", root.sentence(), sections);
  add_conditions(root, uses, sections);
  std::string text;
  for (const auto& section : within(std::move(sections), path)) {
    if (section.rows.empty() && format == Format::text && section.path != path) continue;
    text += format == Format::markdown ? markdown_table(section) : (text.empty() ? "" : "\n") + text_table(section);
  }
  return text;
}

}  // namespace thixis::core
