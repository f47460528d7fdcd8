#pragma once
#include <vector>

#include "thixis/bound/cell_fields.hpp"
#include "thixis/method/space.hpp"

namespace thixis::bound {

/// What belongs to vertex i of patch cell k: the density of lambda_h(a) psi_a for p = 1, of lambda_h psi_a otherwise.
CellTable of_vertices(const method::Space& space, const method::Coefficients& lambda, int q);

/// Integrals over all cells of what two polynomials say, by a rule of high order: lambda and g, with more multipliers.
struct Integrals {
  double positive = 0, negative = 0;  ///< |lambda^pos|², |lambda^neg|²
  double rest = 0;                    ///< |lambda^neg - other|²
  double contact = 0, whole = 0;      ///< (lambda^pos, g), (lambda, g)
};

Integrals integrals(const method::Space& space, const method::Coefficients& lambda, const method::Coefficients& other,
                    const method::Coefficients& gap);

/// What closing the gap adds to it: -min(·, 0) of its coefficients in this basis (matrix: coefficients -> those), back in the space.
method::Coefficients closing(const method::Space& space, const method::Coefficients& gap, const std::vector<double>& to);
/// The same where the basis is that of the space.
method::Coefficients closing(const method::Space& space, const method::Coefficients& gap);

}  // namespace thixis::bound
