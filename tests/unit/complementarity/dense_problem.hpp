#pragma once
/// A small contact problem with full matrices: every rank knows all of it and solves all of it, and keeps its own part of the vectors.
#include <Tpetra_Vector.hpp>
#include <functional>
#include <string>
#include <vector>

#include "thixis/complementarity/problem.hpp"

namespace thixis::complementarity::test {

using Values = std::vector<double>;

/// n points, one or two bodies (α = 1, 2), X = (u_1 [, u_2], λ) point by point:
///
///     M_α u_α + cubic u_α³ + (-1)^α D λ = F_α,    K = u_1 - ψ  or  u_1 - u_2,    G = λ.
struct DenseData {
  int n = 0;
  std::vector<Values> M;  ///< one per body, n x n, row by row
  std::vector<Values> F;  ///< one per body
  Values psi;             ///< obstacle; one body only
  Values D;
  Values scaling;
  double cubic = 0;

  int fields() const { return static_cast<int>(M.size()) + 1; }
};

/// How the linear solver behaves: its i-th iterate is (1 - rate^i) times the exact correction, so that |R_alg| = rate^i |R|.
struct LinearBehaviour {
  double rate = 0;  ///< 0: exact after one iteration
  int max_iterations = 1000;
  double overshoot = 1;  ///< all corrections are so many times too long, and claimed to be right
  bool gives_nan = false;
  std::string reason;  ///< of NaN, as the solver tells it
};

class DenseProblem : public Problem {
 public:
  explicit DenseProblem(DenseData data);

  LinearBehaviour linear;
  double rhs_factor = 1;                ///< |B| in units of |(F, 0)|
  std::function<double(double)> spoil;  ///< applied to every entry of the equations, if set
  mutable int equations_asked = 0;      ///< calls of `equations`
  std::vector<double> tolerances;       ///< what the solves were asked for

  algebra::MapPtr map() const override { return map_; }
  algebra::MapPtr points() const override { return points_; }
  void equations(const algebra::Vector& X, algebra::Vector& R) const override;
  void arguments(const algebra::Vector& X, algebra::Vector& K, algebra::Vector& G) const override;
  void scaling(algebra::Vector& s) const override;
  void insert(const algebra::Vector& C, algebra::Vector& R) const override;
  void linearize(const algebra::Vector& X, const algebra::Vector& a, const algebra::Vector& b) override;
  algebra::LinearReport solve(const algebra::Vector& R, algebra::Vector& dX, const algebra::LinearStop& stop) override;
  double reference_norm() const override;
  double rhs_norm(const algebra::Vector& X, const algebra::Vector& R) const override { return rhs_factor * Problem::rhs_norm(X, R); }

  /// A vector on `map()` with the values (field, point).
  algebra::Vector vector(const std::function<double(int field, int point)>& value) const;
  /// All entries of X, ordered as (point, field); on every rank.
  Values gather(const algebra::Vector& X) const;
  const DenseData& data() const { return data_; }

 private:
  DenseData data_;
  algebra::MapPtr points_, map_;
  int first_ = 0, own_ = 0;  ///< points of this rank
  Values A_;
};

/// A x = b by Gaussian elimination with column pivoting.
Values eliminate(Values A, Values b);

/// String under tension over a flat obstacle, n - 1 interior points of (0, 1), n divisible by 4:
///     -μ u'' - λ = -8 μ,  u >= -1/4,  u(0) = u(1) = 0.
/// The nodal solution is exact: contact on [1/4, 3/4]; u = 4 (d - 1/4)² - 1/4 outside of it, d the distance to the nearer end; λ = 8 μ
/// inside, half of it at its two ends. D = h. Lengths and forces may be measured in other units: u, ψ multiplied by `length`, μ by
/// `tension`.
DenseData string_over_obstacle(int n, double length = 1, double tension = 1);
double string_solution(int n, int field, int point, double length = 1, double tension = 1);

/// Two strings, tensions 2 and 3, gap z as above (z = 4 (d - 1/4)², z = 1/4 at the ends) and w = 2 u_1 + 3 u_2 = 1/2 + x (1 - x).
DenseData two_strings(int n);
double two_strings_solution(int n, int field, int point);

/// The linear complementarity problem x >= 0, M x + q >= 0, x·(M x + q) = 0, with G = M x + q = λ.
DenseData linear_complementarity(const Values& M, const Values& q);

}  // namespace thixis::complementarity::test
