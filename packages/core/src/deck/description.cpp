#include "thixis/core/description.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "deck/values.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/text.hpp"

namespace thixis::core {

Range& Range::entries(int least, int most) {
  least_entries = least;
  most_entries = most;
  return *this;
}

bool Range::holds(double value) const {
  if (!numbers.empty()) return std::find(numbers.begin(), numbers.end(), value) != numbers.end();
  return (lower_open ? value > lower : value >= lower) && (upper_open ? value < upper : value <= upper);
}

std::string Range::rule() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!names.empty()) return "one of " + join(names);
  if (!numbers.empty()) {
    std::vector<std::string> texts;
    for (const double number : numbers) texts.push_back(to_text(number));
    return "one of " + join(texts);
  }
  const std::string from = lower == -infinity ? "" : (lower_open ? "above " : "at least ") + to_text(lower);
  const std::string to = upper == infinity ? "" : (upper_open ? "below " : "at most ") + to_text(upper);
  if (!from.empty() && !to.empty() && !lower_open && !upper_open) return fmt::format("between {} and {}", to_text(lower), to_text(upper));
  return from + (from.empty() || to.empty() ? "" : " and ") + to;
}

Range at_least(double bound) { return between(bound, std::numeric_limits<double>::infinity()); }
Range at_most(double bound) { return between(-std::numeric_limits<double>::infinity(), bound); }
Range above(double bound) { return strictly_between(bound, std::numeric_limits<double>::infinity()); }
Range below(double bound) { return strictly_between(-std::numeric_limits<double>::infinity(), bound); }
Range between(double lower, double upper) {
  Range range;
  range.lower = lower;
  range.upper = upper;
  return range;
}
Range strictly_between(double lower, double upper) {
  Range range = between(lower, upper);
  range.lower_open = range.upper_open = true;
  return range;
}
Range one_of(std::initializer_list<const char*> names) {
  Range range;
  range.names.assign(names.begin(), names.end());
  return range;
}
Range one_of(std::initializer_list<int> numbers) {
  Range range;
  range.numbers.assign(numbers.begin(), numbers.end());
  return range;
}
Range entries(int count) { return entries(count, count); }
Range entries(int least, int most) { return Range{}.entries(least, most); }

void Description::must_be_new(const std::string& name) const {
  if (parameter(name) != nullptr || block(name) != nullptr)
    throw Error(ExitCode::internal, fmt::format("the schema '{}' describes '{}' twice", name_, name));
}

void Description::add(Parameter parameter) {
  must_be_new(parameter.name);
  const auto defaults = make();
  const auto written = write_value(parameter, defaults.get());
  std::vector<std::string> complaints;
  if (written && !parameter.required) read_value(parameter, written->type, written->text, complaints);
  if (!complaints.empty())
    throw Error(ExitCode::internal, fmt::format("the default of '{}/{}' is not allowed: {}", name_, parameter.name, complaints.front()));
  parameters_.push_back(std::move(parameter));
  last_is_block_ = false;
}

void Description::add(Block block) {
  must_be_new(block.name);
  blocks_.push_back(std::move(block));
  last_is_block_ = true;
}

void Description::adopt(const Description& of_part, const std::function<void*(void*)>& open,
                        const std::function<const void*(const void*)>& look) {
  for (Parameter p : of_part.parameters_) {
    p.set = [open, set = p.set](void* object, const Value& value) { set(open(object), value); };
    p.get = [look, get = p.get](const void* object) { return get(look(object)); };
    add(std::move(p));
  }
  for (Block b : of_part.blocks_) {
    b.open = [open, inner = b.open](void* object, const std::string& member) { return inner(open(object), member); };
    b.members = [look, inner = b.members](const void* object) { return inner(look(object)); };
    add(std::move(b));
  }
  for (const auto& check : of_part.checks_)
    checks_.push_back([look, check](const void* object, Problems& problems) { check(look(object), problems); });
}

void Description::require_last() {
  if (last_is_block_) blocks_.back().required = true;
  else parameters_.back().required = true;
}

const Description::Parameter* Description::parameter(const std::string& name) const {
  const auto found = std::find_if(parameters_.begin(), parameters_.end(), [&](const Parameter& p) { return p.name == name; });
  return found == parameters_.end() ? nullptr : &*found;
}

const Description::Block* Description::block(const std::string& name) const {
  const auto found = std::find_if(blocks_.begin(), blocks_.end(), [&](const Block& b) { return b.name == name; });
  return found == blocks_.end() ? nullptr : &*found;
}

void Description::check(const void* object, Problems& problems) const {
  for (const auto& check : checks_) check(object, problems);
}

}  // namespace thixis::core
