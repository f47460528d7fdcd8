#pragma once
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace thixis::core {

/// A real function given as text, e.g. "r < R ? sin(pi*x) : 0". Operators + - * / ^, comparisons, && ||, cond ? a : b; functions sin cos
/// tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp ln log (natural) log2 log10 sqrt abs sign rint min max sum avg; the
/// constant pi. Independent of the locale.
class Expression {
 public:
  /// Throws InputError with a sentence that holds the text, if it is no expression of these variables and constants (names of letters,
  /// digits and _; a variable or constant must not be called like a function).
  Expression(const std::string& text, const std::vector<std::string>& variables, const std::map<std::string, double>& constants = {});
  ~Expression();
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;

  /// values[i] = f(variables[0][i], variables[1][i], ...) for i < n. The values may be inf or nan: the caller judges. Not thread safe.
  void evaluate(std::size_t n, const double* const* variables, double* values) const;
  double operator()(const std::vector<double>& point) const;

  const std::string& text() const;
  bool uses(const std::string& variable) const;  ///< whether the text contains this variable
  bool constant() const;                         ///< whether it contains none

 private:
  struct Compiled;
  std::unique_ptr<Compiled> compiled_;
};

}  // namespace thixis::core
