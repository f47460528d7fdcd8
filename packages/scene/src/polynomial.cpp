#include "polynomial.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

namespace thixis::scene {
namespace {

enum class Powers { even, odd, both };  ///< of r: r² alone is a polynomial of x and y

/// A part of the text: a polynomial of x, y, t and r.
struct Part {
  Degree degree;
  Powers of_r = Powers::even;
  std::optional<double> value;  ///< of a constant that is written down as a number

  bool constant() const { return degree.space == 0 && degree.time == 0 && degree.whole; }
};
using Known = std::optional<Part>;

/// Powers of powers leave every range of integers; from `most` on it makes no difference how high a degree is.
Degree bounded(int space, int time, bool whole) { return {std::min(space, Degree::most), std::min(time, Degree::most), whole}; }

Known number(double value) { return Part{{}, Powers::even, value}; }
Known variable(int in_space, int in_time) { return Part{{in_space, in_time, true}, Powers::even, {}}; }

Powers sum(Powers a, Powers b) { return a == b ? a : Powers::both; }
Powers product(Powers a, Powers b) {
  if (a == Powers::both || b == Powers::both) return Powers::both;
  return a == b ? Powers::even : Powers::odd;
}

Known sum(const Known& a, const Known& b) {
  if (!a || !b) return {};
  return Part{{std::max(a->degree.space, b->degree.space), std::max(a->degree.time, b->degree.time), a->degree.whole && b->degree.whole},
              sum(a->of_r, b->of_r),
              {}};
}
Known pieces(const Known& a, const Known& b) {
  Known both = sum(a, b);
  if (both) both->degree.whole = false;
  return both;
}
Known product(const Known& a, const Known& b) {
  if (!a || !b) return {};
  return Part{bounded(a->degree.space + b->degree.space, a->degree.time + b->degree.time, a->degree.whole && b->degree.whole),
              product(a->of_r, b->of_r),
              {}};
}
Known quotient(const Known& a, const Known& b) { return a && b && b->constant() ? product(a, b) : Known(); }
Known power(const Known& a, const Known& b) {
  if (!a || !b || !b->constant()) return {};
  if (a->constant()) return Part{};
  constexpr int most = 100;
  if (!b->value || *b->value < 0 || *b->value > most || *b->value != std::floor(*b->value)) return {};
  const int n = static_cast<int>(*b->value);
  const bool even = n == 0 || (n % 2 == 0 && a->of_r == Powers::odd);
  return Part{bounded(n * a->degree.space, n * a->degree.time, a->degree.whole), even ? Powers::even : a->of_r, {}};
}

/// Reads the text by the precedences of core::Expression; gives up where it meets something else.
class Reader {
 public:
  Reader(const std::string& text, const std::map<std::string, double>& constants) : constants_(constants) {
    for (const char c : text)
      if (std::isspace(static_cast<unsigned char>(c)) == 0) text_ += c;
  }
  Known all() {
    Known part = choice();
    return at_ == text_.size() ? part : Known();
  }

 private:
  static constexpr int deepest = 200;  ///< parentheses in each other

  char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool next(const std::string& token) {
    if (at_ >= text_.size() || text_.compare(at_, token.size(), token) != 0) return false;
    at_ += token.size();
    return true;
  }
  Known give_up() {
    at_ = text_.size() + 1;
    return {};
  }

  /// condition ? yes : no
  Known choice() {
    if (depth_ == deepest) return give_up();
    ++depth_;
    Known part = comparisons();
    if (next("?")) {
      const Known yes = choice();
      part = next(":") ? pieces(yes, choice()) : give_up();
    }
    --depth_;
    return part;
  }
  /// Comparisons, and what joins them, are 0 or 1, whatever they compare.
  Known comparisons() {
    Known part = terms();
    while (compares()) {
      terms();
      part = Part{{0, 0, false}, Powers::even, {}};
    }
    return part;
  }
  bool compares() {
    for (const char* token : {"||", "&&", "<=", ">=", "==", "!=", "<", ">"})
      if (next(token)) return true;
    return false;
  }
  Known terms() {
    Known left = factors();
    while (here() == '+' || here() == '-') {
      ++at_;
      left = sum(left, factors());
    }
    return left;
  }
  Known factors() {
    Known left = signed_power();
    while (here() == '*' || here() == '/') {
      const bool divides = here() == '/';
      ++at_;
      const Known right = signed_power();
      left = divides ? quotient(left, right) : product(left, right);
    }
    return left;
  }
  Known signed_power() {
    if (here() == '-' || here() == '+') {
      ++at_;
      Known part = signed_power();
      if (part && part->value) part->value = {};
      return part;
    }
    const Known base = primary();
    if (here() != '^') return base;
    ++at_;
    const Known exponent = primary();
    return here() == '^' ? Known() : power(base, exponent);
  }
  Known primary() {
    const char c = here();
    if (c == '(') {
      ++at_;
      const Known inside = choice();
      return next(")") ? inside : Known();
    }
    if (std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.') return literal();
    if (std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_') return named();
    return give_up();
  }
  Known literal() {
    const char* const begin = text_.c_str() + at_;
    std::size_t length = 0;
    while (std::isdigit(static_cast<unsigned char>(begin[length])) != 0 || begin[length] == '.') ++length;
    if (begin[length] == 'e' || begin[length] == 'E') {
      std::size_t exponent = length + 1;
      if (begin[exponent] == '+' || begin[exponent] == '-') ++exponent;
      if (std::isdigit(static_cast<unsigned char>(begin[exponent])) != 0) length = exponent;
      while (std::isdigit(static_cast<unsigned char>(begin[length])) != 0) ++length;
    }
    at_ += length;
    return number(std::strtod(std::string(begin, length).c_str(), nullptr));
  }
  Known named() {
    std::size_t end = at_;
    while (end < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[end])) != 0 || text_[end] == '_')) ++end;
    const std::string name = text_.substr(at_, end - at_);
    at_ = end;
    if (here() == '(') return function(name);
    if (name == "x" || name == "y") return variable(1, 0);
    if (name == "t") return variable(0, 1);
    if (name == "r") return Part{{1, 0, true}, Powers::odd, {}};
    if (name == "pi") return Part{};
    const auto constant = constants_.find(name);
    return constant == constants_.end() ? Known() : number(constant->second);
  }
  Known function(const std::string& name) {
    ++at_;  // (
    Known together = Part{};
    bool constant = true;
    for (;;) {
      const Known argument = choice();
      constant = constant && argument && argument->constant();
      together = pieces(together, argument);
      if (next(")")) break;
      if (!next(",")) return give_up();
    }
    if (constant) return Part{};
    return name == "abs" || name == "min" || name == "max" ? together : Known();
  }

  std::string text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  const std::map<std::string, double>& constants_;
};

}  // namespace

std::optional<Degree> degree_of(const std::string& text, const std::map<std::string, double>& constants) {
  const Known all = Reader(text, constants).all();
  if (!all || all->of_r != Powers::even) return {};
  return all->degree;
}

}  // namespace thixis::scene
