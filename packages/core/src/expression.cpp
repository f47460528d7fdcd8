#include "thixis/core/expression.hpp"

#include <fmt/core.h>
#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "thixis/core/assert.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/text.hpp"

namespace thixis::core {

struct Expression::Compiled {
  std::string text;
  mu::Parser parser;
  std::vector<std::string> variables;
  std::vector<double> point;  ///< the parser reads the variables here
  std::vector<bool> used;
};

namespace {

/// What the parser's own grammar lets pass or calls by another name.
std::string mistake_of_form(const std::string& text) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) return "is empty; write a number or an expression";
  int open = 0;
  for (const char c : text) {
    open += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (open < 0) return "has a ')' without its '('; remove it or open the parenthesis before";
  }
  if (open > 0) return fmt::format("lacks {}; close every parenthesis", open == 1 ? "a ')'" : fmt::format("{} times ')'", open));
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool part_of_comparison =
        (i > 0 && std::string("=<>!").find(text[i - 1]) != std::string::npos) || (i + 1 < text.size() && text[i + 1] == '=');
    if (text[i] == '=' && !part_of_comparison) return "has a single '='; write == to compare";
  }
  return "";
}

/// A name in the text and what stands around it.
struct Name {
  std::string text;
  std::string number;   ///< directly before it: "2" of "2x"
  bool called = false;  ///< a parenthesis follows
};

/// The names in the text; numbers such as 1e-3 are skipped as a whole.
std::vector<Name> names_in(const std::string& text) {
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.'; };
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  std::vector<Name> names;
  std::string number;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i;
    if (is_digit(text[i])) {
      while (end < text.size() && is_digit(text[end])) ++end;
      std::size_t exponent = end + 1;
      if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
      if (exponent < text.size() && (text[end] == 'e' || text[end] == 'E') && is_digit(text[exponent])) end = exponent;
      while (end < text.size() && is_digit(text[end])) ++end;
      number = text.substr(i, end - i);
      i = end;
      continue;
    }
    if (is_letter(text[i])) {
      while (end < text.size() && (is_letter(text[end]) || (is_digit(text[end]) && text[end] != '.'))) ++end;
      const auto next = text.find_first_not_of(" \t\r\n", end);
      names.push_back({text.substr(i, end - i), number, next != std::string::npos && text[next] == '('});
    } else {
      ++end;
    }
    number.clear();
    i = end;
  }
  return names;
}

/// What other languages write for an operator of ours.
std::string foreign_operator(const std::string& text) {
  if (text.find("**") != std::string::npos) return "has a '**'; write ^ for powers";
  if (text.find('%') != std::string::npos) return "has a '%', which means nothing here; the remainder of a by b is a - b*rint(a/b - 0.5)";
  const std::map<std::string, std::string> words = {{"and", "&&"}, {"or", "||"}, {"not", "!"}};
  for (const Name& name : names_in(text))
    if (const auto found = words.find(name.text); found != words.end())
      return fmt::format("has the word '{}'; write {}", name.text, found->second);
  return "";
}

/// A product or a call as mathematicians write them.
std::string missing_sign(const std::string& text, const mu::Parser& parser) {
  for (const auto& [name, number, called] : names_in(text)) {
    if (!number.empty()) return fmt::format("has '{0}{1}'; write {0}*{1}", number, name);
    if (!called && parser.GetFunDef().count(name) != 0) return fmt::format("has '{0}' without a '('; write {0}(...)", name);
  }
  return "";
}

/// The first name in the text that means nothing, with the nearest known one. The parser would stumble over what follows the name.
std::string unknown_name(const std::string& text, const mu::Parser& parser, const std::vector<std::string>& names) {
  for (const auto& [name, number, called] : names_in(text)) {
    if (std::find(names.begin(), names.end(), name) != names.end() || parser.GetFunDef().count(name) != 0) continue;
    std::vector<std::string> known = names;
    for (const auto& function : parser.GetFunDef()) known.push_back(function.first);
    const auto near = nearest(name, known);
    return fmt::format(
        "has the unknown name '{}'; {}", name,
        near ? fmt::format("did you mean '{}'?", *near) : fmt::format("known are {} and functions such as sin", join(names)));
  }
  return "";
}

std::string reason(const mu::ParserError& error) {
  const std::string& token = error.GetToken();
  switch (error.GetCode()) {
    case mu::ecUNEXPECTED_EOF:
      return "ends too early; complete it";
    case mu::ecTOO_FEW_PARAMS:
      return fmt::format("gives too few arguments to '{}'", token);
    case mu::ecTOO_MANY_PARAMS:
      return fmt::format("gives too many arguments to '{}'", token);
    case mu::ecMISSING_ELSE_CLAUSE:
    case mu::ecMISPLACED_COLON:
      return "has a '?' without its ':' or the other way round; write condition ? a : b";
    case mu::ecEXPRESSION_TOO_LONG:
      return "is too long; use named constants";
    default:
      return fmt::format("can not be read at '{}' (character {}); is an operator missing?", token, error.GetPos() + 1);
  }
}

/// Constants come with names that a user has chosen.
void define_constants(mu::Parser& parser, const std::string& text, const std::map<std::string, double>& constants) {
  parser.DefineConst("pi", std::acos(-1.0));
  for (const auto& [name, value] : constants) {
    const bool taken = name == "pi" || parser.GetVar().count(name) != 0 || parser.GetFunDef().count(name) != 0;
    if (taken)
      throw InputError(fmt::format("the constant '{}' of the expression '{}' has the name of something else; rename it.", name, text));
    try {
      parser.DefineConst(name, value);
    } catch (const mu::ParserError&) {
      throw InputError(fmt::format("'{}' can not be the name of a constant; use letters, digits and _, a letter first.", name));
    }
  }
}

std::string sentence(const std::string& text, const std::string& what) {
  return fmt::format("the expression '{}' {}{}", text, what, what.back() == '?' ? "" : ".");
}

}  // namespace

Expression::Expression(const std::string& text, const std::vector<std::string>& variables, const std::map<std::string, double>& constants)
    : compiled_(std::make_unique<Compiled>()) {
  const WithoutFloatingPointTraps quiet;  // the parser folds constants: 1/0 is inf, not a signal
  Compiled& c = *compiled_;
  c.text = text;
  c.variables = variables;
  c.point.assign(variables.size(), 0.0);
  c.used.assign(variables.size(), false);
  if (const std::string mistake = mistake_of_form(text); !mistake.empty()) throw InputError(sentence(text, mistake));
  if (const std::string mistake = foreign_operator(text); !mistake.empty()) throw InputError(sentence(text, mistake));
  c.parser.DefineInfixOprt("!", [](double value) { return value == 0 ? 1.0 : 0.0; });
  for (std::size_t i = 0; i < variables.size(); ++i) c.parser.DefineVar(variables[i], &c.point[i]);
  define_constants(c.parser, text, constants);
  std::vector<std::string> names = variables;
  names.emplace_back("pi");
  for (const auto& constant : constants) names.push_back(constant.first);
  if (const std::string mistake = unknown_name(text, c.parser, names); !mistake.empty()) throw InputError(sentence(text, mistake));
  if (const std::string mistake = missing_sign(text, c.parser); !mistake.empty()) throw InputError(sentence(text, mistake));
  try {
    c.parser.SetExpr(text);
    const auto used = c.parser.GetUsedVar();
    for (std::size_t i = 0; i < variables.size(); ++i) c.used[i] = used.count(variables[i]) != 0;
    c.parser.Eval();
  } catch (const mu::ParserError& error) {
    throw InputError(sentence(text, reason(error)));
  }
  if (c.parser.GetNumResults() != 1) throw InputError(sentence(text, "has a ',' outside of a function; write a decimal point as '.'"));
}

Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;

void Expression::evaluate(std::size_t n, const double* const* variables, double* values) const {
  const WithoutFloatingPointTraps quiet;
  Compiled& c = *compiled_;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t v = 0; v < c.point.size(); ++v) c.point[v] = variables[v][i];
    try {
      values[i] = c.parser.Eval();
    } catch (const mu::ParserError& error) {
      throw InputError(sentence(c.text, fmt::format("has no value at one of its points ({})", error.GetMsg())));
    }
  }
}

double Expression::operator()(const std::vector<double>& point) const {
  if (point.size() != compiled_->point.size())
    throw Error(ExitCode::internal, fmt::format("the expression '{}' has {} variables, but {} values are given", compiled_->text,
                                                compiled_->point.size(), point.size()));
  std::vector<const double*> variables;
  for (const double& x : point) variables.push_back(&x);
  double value = 0;
  evaluate(1, variables.data(), &value);
  return value;
}

const std::string& Expression::text() const { return compiled_->text; }

bool Expression::uses(const std::string& variable) const {
  for (std::size_t i = 0; i < compiled_->variables.size(); ++i)
    if (compiled_->variables[i] == variable) return compiled_->used[i];
  return false;
}

bool Expression::constant() const { return std::find(compiled_->used.begin(), compiled_->used.end(), true) == compiled_->used.end(); }

}  // namespace thixis::core
