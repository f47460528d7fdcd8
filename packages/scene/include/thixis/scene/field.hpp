#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <map>
#include <vector>

namespace thixis::scene {

/// Many points at once, structure of arrays.
struct Points {
  std::size_t count = 0;
  const double* x = nullptr;
  const double* y = nullptr;
};

/// A scalar function of place and time, asked for at many points at once.
class Field {
 public:
  virtual ~Field() = default;
  /// values[i] = f(x_i, y_i, t); throws InputError where a value is not finite (naming the function and the point).
  virtual void evaluate(const Points& points, double t, double* values) const = 0;
  /// The value if the function is constant in place and time, so that kernels may skip the evaluation.
  virtual const double* constant() const { return nullptr; }
};
using FieldPtr = std::shared_ptr<const Field>;

FieldPtr constant(double value);

/// An expression of x, y, t, r (distance to `centre`), pi and named constants (muParser syntax, `cond ? a : b` allowed).
/// `name` is used in messages, e.g. "scene/data/f1". Throws InputError for text that is no such expression.
FieldPtr expression(const std::string& name, const std::string& text, const std::vector<double>& centre,
                    const std::map<std::string, double>& constants);

/// f(x, y) or f(x, y, t) compiled in: the catalogue's functions.
template <class F>
FieldPtr formula(F f);

/// Gradient of a function by sixth-order central differences of step `step`: for exact solutions given without their derivatives.
std::array<FieldPtr, 2> difference_gradient(FieldPtr u, double step);

}  // namespace thixis::scene
