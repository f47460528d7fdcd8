#pragma once
#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace thixis::scene {

/// Many points at once, structure of arrays.
struct Points {
  std::size_t count = 0;
  const double* x = nullptr;
  const double* y = nullptr;
};

/// What is known of a function that is a polynomial in every cell of the mesh, or on either side of the interface in a cell that it cuts.
struct Degree {
  static constexpr int most = 1000;  ///< stands for itself and all above: larger ones are not told apart
  int space = 0;                     ///< at most, in x and y together
  int time = 0;                      ///< at most, in t
  bool whole = true;                 ///< the same polynomial everywhere
};

/// A scalar function of place and time, asked for at many points at once. Not to be evaluated by several threads at a time.
class Field {
 public:
  virtual ~Field() = default;
  /// values[i] = f(x_i, y_i, t); throws InputError where a value is not finite (naming the function and the point), on this rank only:
  /// evaluate inside Comm::together before anything collective.
  virtual void evaluate(const Points& points, double t, double* values) const = 0;
  /// The value if the function is constant in place and time, so that kernels may skip the evaluation.
  virtual const double* constant() const { return nullptr; }
  /// Whether it is known not to depend on time: what is made of it may be kept.
  virtual bool steady() const { return constant() != nullptr; }
  /// Nothing where it is not known to be a polynomial.
  virtual std::optional<Degree> degree() const { return {}; }
  /// The size of what cancels in the values: they carry the rounding of numbers of that size.
  virtual double cancelled() const { return 0; }
};
using FieldPtr = std::shared_ptr<const Field>;

FieldPtr constant(double value);

/// An expression of x, y, t, r (distance to `centre`), pi and named constants (core::Expression, `cond ? a : b` allowed).
/// `name` is used in messages, e.g. "scene/data/f1". Throws InputError "<name>: ..." for text that is no such expression.
/// Its degree is what the text proves where that is one polynomial. Of others, pieces put together by conditions, abs, min, max included,
/// it is what the user names: a polynomial of degree `named` at most in every cell.
FieldPtr expression(const std::string& name, const std::string& text, const std::vector<double>& centre,
                    const std::map<std::string, double>& constants, std::optional<int> named = {});

/// f(x, y) or f(x, y, t) compiled in: the catalogue's functions. `name` is used in messages; `degree`: if f is a polynomial.
template <class F>
FieldPtr formula(F f, std::string name = "a function of the scene", std::optional<Degree> degree = {});

/// Gradient of a function by sixth-order central differences of step `step`: for exact solutions given without their derivatives.
///
/// The error is step^6/140 times a seventh derivative + about 2e-16 |u|/step; where the stencil crosses a curve on which the second
/// derivative jumps by J it is up to J step. u is asked for within 3 steps of the points, beyond the domain as well.
std::array<FieldPtr, 2> difference_gradient(FieldPtr u, double step);

/// Largest absolute value of a datum. Energies are products of up to four data and their reciprocals, and double precision ends at 1e308.
constexpr double largest_value = 1e60;

/// Throws InputError if one of the values at these points is not finite, or larger than `largest_value`.
void require_finite(const std::string& name, const Points& points, double t, const double* values);

// ---------------------------------------------------------------------------------------------------------------------------------

namespace detail {
template <class F>
class Formula final : public Field {
 public:
  Formula(F f, std::string name, std::optional<Degree> degree) : f_(std::move(f)), name_(std::move(name)), degree_(degree) {}
  void evaluate(const Points& points, double t, double* values) const override {
    for (std::size_t i = 0; i < points.count; ++i) {
      if constexpr (std::is_invocable_v<const F&, double, double, double>) values[i] = f_(points.x[i], points.y[i], t);
      else values[i] = f_(points.x[i], points.y[i]);
    }
    require_finite(name_, points, t, values);
  }
  bool steady() const override { return !std::is_invocable_v<const F&, double, double, double>; }
  std::optional<Degree> degree() const override { return degree_; }

 private:
  F f_;
  std::string name_;
  std::optional<Degree> degree_;
};
}  // namespace detail

template <class F>
FieldPtr formula(F f, std::string name, std::optional<Degree> degree) {
  return std::make_shared<detail::Formula<F>>(std::move(f), std::move(name), degree);
}

}  // namespace thixis::scene
