#pragma once
#include <array>
#include <vector>

#include "data/cell_energy.hpp"
#include "lift/lift_tables.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/method/quadrature.hpp"

namespace thixis::bound {

constexpr int degree_of_v = 4;                              ///< of the correction v of lifts
constexpr int lift_order = 2 * LiftInCell::resolution + 4;  ///< exact for |grad l|²

/// A rule for the cells of a layer, with what is known at its points. The functions are those of LiftTable; derivatives are in xi, eta.
struct LiftRule {
  using Derivatives = std::array<std::vector<double>, 2>;  ///< (point, k) of Bernstein polynomials
  using Tabulated = std::vector<double>[3];                ///< values and derivatives of a lift at the points

  method::CellQuadrature quadrature;
  Tension mu;
  LiftTable table;

  /// Collective; throws InputError where a tension is not positive.
  LiftRule(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, int order, const reference::Bernstein& of_v,
           const std::array<scene::FieldPtr, 2>& tension, int count);

  /// Makes of the derivatives of L in cell k the weights f with (mu grad L, grad w)_K = sum_q f_1 ∂w/∂xi + f_2 ∂w/∂eta; returns |||L|||²_K.
  double weigh(int alpha, LocalIndex k, const mesh::CellGeometry& K, Tabulated& L) const;
  Derivatives derivatives(const reference::Bernstein& B) const;
};

/// sum[k] += factor sum_q f_1(q) ∂B_k/∂xi + f_2(q) ∂B_k/∂eta.
void add_products(double factor, const LiftRule::Tabulated& f, const LiftRule::Derivatives& dB, int n, double* sum);

}  // namespace thixis::bound
