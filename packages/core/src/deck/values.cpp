#include "deck/values.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <type_traits>

#include "deck/limits.hpp"
#include "thixis/core/text.hpp"

namespace thixis::core {

namespace {

using Kind = Description::Kind;
using Value = Description::Value;
using Parameter = Description::Parameter;
using Complaints = std::vector<std::string>;

std::optional<double> read_real(const std::string& text, bool whole, const std::string& who, Complaints& complaints) {
  if (whole && !to_integer(text)) {
    complaints.push_back(fmt::format("{} is not an integer; write e.g. 3, or a type for numbers with a fraction.", who));
    return std::nullopt;
  }
  const auto value = to_double(text);
  if (!value) complaints.push_back(fmt::format("{} is not a number; write e.g. 1e-8.", who));
  return value;
}

std::optional<long long> read_integer(const std::string& text, bool is_long, const std::string& who, Complaints& complaints) {
  const auto value = to_integer(text);
  const bool digits = text.find_first_not_of("+-0123456789 ") == std::string::npos && text.find_first_of("0123456789") != std::string::npos;
  if (!value) complaints.push_back(fmt::format(digits ? "{} is no integer of 64 bits." : "{} is not an integer; write e.g. 3.", who));
  else if (!is_long && (*value < INT_MIN || *value > INT_MAX))
    complaints.push_back(fmt::format("{} is too large; integers here lie between {} and {}.", who, INT_MIN, INT_MAX));
  else return value;
  return std::nullopt;
}

void check_range(const Range& range, double value, const std::string& shown, const std::string& who, Complaints& complaints) {
  if (!range.holds(value)) complaints.push_back(fmt::format("{}must be {}, but is {}.", who, range.rule(), shown));
}

void check_name(const Range& range, const std::string& text, const std::string& who, Complaints& complaints) {
  if (range.names.empty() || std::find(range.names.begin(), range.names.end(), text) != range.names.end()) return;
  complaints.push_back(fmt::format("{}no such value '{}'. {}", who, text, did_you_mean(text, range.names, "Write one of")));
}

std::string blank_free(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t\r\n");
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

/// "{a, b}" -> a, b
std::optional<std::vector<std::string>> split_array(const std::string& text) {
  const std::string trimmed = blank_free(text);
  if (trimmed.size() < 2 || trimmed.front() != '{' || trimmed.back() != '}') return std::nullopt;
  const std::string inside = trimmed.substr(1, trimmed.size() - 2);
  std::vector<std::string> items;
  if (blank_free(inside).empty()) return items;
  std::size_t begin = 0;
  for (std::size_t comma = inside.find(','); comma != std::string::npos; begin = comma + 1, comma = inside.find(',', begin))
    items.push_back(blank_free(inside.substr(begin, comma - begin)));
  items.push_back(blank_free(inside.substr(begin)));
  return items;
}

void check_entries(const Range& range, std::size_t count, Complaints& complaints) {
  const int least = range.least_entries, most = range.most_entries;
  if (static_cast<long long>(count) >= least && static_cast<long long>(count) <= most) return;
  const std::string wanted = least == most     ? fmt::format("{}", least)
                             : most == INT_MAX ? fmt::format("at least {}", least)
                                               : fmt::format("{} to {}", least, most);
  complaints.push_back(fmt::format("must have {} entries, but has {}.", wanted, count));
}

const char* example_array(Kind kind) { return kind == Kind::texts ? "{a, b}" : kind == Kind::integers ? "{2, 3}" : "{0.5, 1}"; }

/// `item(text, who)` reads and checks one entry; it gives nothing if the entry is wrong.
template <class T, class Item>
std::optional<Value> read_array(const Parameter& parameter, const std::string& text, Complaints& complaints, Item item) {
  const auto items = split_array(text);
  if (!items) {
    complaints.push_back(fmt::format("'{}' is not an array; write e.g. {}.", text, example_array(parameter.kind)));
    return std::nullopt;
  }
  if (items->size() > limits::array_entries) {
    complaints.push_back(fmt::format("has {} entries, which are too many; write at most {}.", items->size(), limits::array_entries));
    return std::nullopt;
  }
  const std::size_t before = complaints.size();
  std::vector<T> values;
  for (std::size_t i = 0; i < items->size() && complaints.size() < before + limits::shown_of_array; ++i)
    if (const auto value = item((*items)[i], fmt::format("entry {} ", i + 1))) values.push_back(static_cast<T>(*value));
  if (complaints.size() == before) check_entries(parameter.range, items->size(), complaints);
  return complaints.size() == before ? std::optional<Value>(values) : std::nullopt;
}

std::optional<Value> read_bool(const std::string& text, Complaints& complaints) {
  if (text == "true" || text == "false") return Value(text == "true");
  complaints.push_back(fmt::format("'{}' is not a bool; write true or false.", text));
  return std::nullopt;
}

std::optional<Value> read_formula(const Parameter& parameter, const std::string& type, const std::string& text, Complaints& complaints) {
  if (blank_free(text).empty()) {
    complaints.push_back("the value is empty; write a number or an expression.");
    return std::nullopt;
  }
  const auto number = to_double(text);
  if (type != "string" && !type.empty() && !read_real(text, type != "double", fmt::format("'{}'", text), complaints)) return std::nullopt;
  if (number) check_range(parameter.range, *number, blank_free(text), "", complaints);
  return Value(blank_free(text));
}

bool is_array(Kind kind) { return kind == Kind::reals || kind == Kind::integers || kind == Kind::texts; }

std::optional<Value> read_any_array(const Parameter& parameter, const std::string& type, const std::string& text, Complaints& complaints) {
  const Range& range = parameter.range;
  if (parameter.kind == Kind::texts)
    return read_array<std::string>(parameter, text, complaints, [&](const std::string& item, const std::string& who) {
      check_name(range, item, who + ": ", complaints);
      return std::optional<std::string>(item);
    });
  const auto named = [](const std::string& item, const std::string& who) { return fmt::format("{}('{}')", who, item); };
  if (parameter.kind == Kind::integers)
    return read_array<int>(parameter, text, complaints, [&](const std::string& item, const std::string& who) {
      const auto value = read_integer(item, false, named(item, who), complaints);
      if (value) check_range(range, static_cast<double>(*value), item, who, complaints);
      return value;
    });
  return read_array<double>(parameter, text, complaints, [&](const std::string& item, const std::string& who) {
    const auto value = read_real(item, type == "Array(int)", named(item, who), complaints);
    if (value) check_range(range, *value, item, who, complaints);
    return value;
  });
}

std::string array_text(const std::vector<std::string>& items) { return "{" + join(items) + "}"; }

template <class T, class ToText>
std::string array_text(const std::vector<T>& values, ToText text_of) {
  std::vector<std::string> items;
  for (const T value : values) items.push_back(text_of(value));
  return array_text(items);
}

/// An empty text or array where the deck must not hold one: the parameter is not given.
bool absent(const Range& range, const Value& value) {
  const auto empty = [&](const auto& x) {
    if constexpr (std::is_same_v<std::decay_t<decltype(x)>, std::string>) return x.empty() && !range.names.empty();
    else if constexpr (std::is_arithmetic_v<std::decay_t<decltype(x)>>) return false;
    else return x.empty() && range.least_entries > 0;
  };
  return std::visit(empty, value);
}

bool finite(const Value& value) {
  if (const auto* x = std::get_if<double>(&value)) return std::isfinite(*x);
  if (const auto* xs = std::get_if<std::vector<double>>(&value))
    return std::all_of(xs->begin(), xs->end(), [](double x) { return std::isfinite(x); });
  return true;
}

struct ToText {
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(long long value) const { return fmt::format("{}", value); }
  std::string operator()(double value) const { return to_text(value); }
  std::string operator()(const std::string& value) const { return value; }
  std::string operator()(const std::vector<std::string>& values) const { return array_text(values); }
  std::string operator()(const std::vector<double>& values) const {
    return array_text(values, [](double x) { return to_text(x); });
  }
  std::string operator()(const std::vector<int>& values) const {
    return array_text(values, [](int i) { return fmt::format("{}", i); });
  }
};

double example_number(const Range& range) {
  if (!range.numbers.empty()) return range.numbers.front();
  const bool from = std::isfinite(range.lower), to = std::isfinite(range.upper);
  if (from && !range.lower_open) return range.lower;
  if (to && !range.upper_open) return range.upper;
  if (from && to) return 0.5 * (range.lower + range.upper);
  return from ? range.lower + 1 : to ? range.upper - 1 : 1;
}

}  // namespace

const std::vector<std::string>& types_of(Kind kind) {
  static const std::vector<std::string> boolean{"bool"}, integer{"int", "long long"}, long_integer{"long long", "int"},
      real{"double", "int", "long long"}, text{"string"}, formula{"string", "double", "int", "long long"},
      reals{"Array(double)", "Array(int)"}, integers{"Array(int)"}, texts{"Array(string)"};
  switch (kind) {
    case Kind::boolean:
      return boolean;
    case Kind::integer:
      return integer;
    case Kind::long_integer:
      return long_integer;
    case Kind::real:
      return real;
    case Kind::text:
      return text;
    case Kind::formula:
      return formula;
    case Kind::reals:
      return reals;
    case Kind::integers:
      return integers;
    case Kind::texts:
      return texts;
  }
  return text;
}

std::string kind_name(Kind kind) { return kind == Kind::formula ? "double or expression" : types_of(kind).front(); }

std::optional<Value> read_value(const Parameter& parameter, const std::string& type, const std::string& text, Complaints& complaints) {
  const auto& types = types_of(parameter.kind);
  if (!type.empty() && std::find(types.begin(), types.end(), type) == types.end()) {
    complaints.push_back(fmt::format("type=\"{}\" is wrong here; write type=\"{}\"{}.", type, types.front(),
                                     parameter.kind == Kind::formula ? " or type=\"double\"" : ""));
    return std::nullopt;
  }
  const bool array = is_array(parameter.kind);
  if (!array && text.size() > limits::text_bytes) {
    complaints.push_back(fmt::format("has {} letters, which are too many; write at most {}.", text.size(), limits::text_bytes));
    return std::nullopt;
  }
  const std::size_t before = complaints.size();
  const std::string who = fmt::format("'{}'", text);
  std::optional<Value> value;
  if (array) {
    value = read_any_array(parameter, type, text, complaints);
  } else if (parameter.kind == Kind::boolean) {
    value = read_bool(text, complaints);
  } else if (parameter.kind == Kind::integer || parameter.kind == Kind::long_integer) {
    if (const auto number = read_integer(text, parameter.kind == Kind::long_integer, who, complaints)) {
      check_range(parameter.range, static_cast<double>(*number), blank_free(text), "", complaints);
      value = *number;
    }
  } else if (parameter.kind == Kind::real) {
    if (const auto number = read_real(text, type == "int" || type == "long long", who, complaints)) {
      check_range(parameter.range, *number, blank_free(text), "", complaints);
      value = *number;
    }
  } else if (parameter.kind == Kind::formula) {
    value = read_formula(parameter, type, text, complaints);
  } else {
    check_name(parameter.range, text, "", complaints);
    value = text;
  }
  return complaints.size() == before ? value : std::nullopt;
}

std::optional<Written> write_value(const Parameter& parameter, const void* object) {
  const auto value = parameter.get(object);
  if (!value || !finite(*value) || absent(parameter.range, *value)) return std::nullopt;
  const std::string text = std::visit(ToText{}, *value);
  if (parameter.kind != Kind::formula) return Written{types_of(parameter.kind).front(), text};
  if (text.empty()) return std::nullopt;
  return Written{to_double(text) ? "double" : "string", text};
}

Written example_value(const Parameter& parameter) {
  const std::string type = parameter.kind == Kind::formula ? "double" : types_of(parameter.kind).front();
  const std::string name = parameter.range.names.empty() ? "..." : parameter.range.names.front();
  const std::string number = to_text(example_number(parameter.range));
  const std::vector<std::string> repeated(parameter.range.least_entries, parameter.kind == Kind::texts ? name : number);
  if (is_array(parameter.kind)) return {type, array_text(repeated)};
  if (parameter.kind == Kind::boolean) return {type, "false"};
  return {type, parameter.kind == Kind::text ? name : number};
}

}  // namespace thixis::core
