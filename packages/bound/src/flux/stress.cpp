#include "flux/stress.hpp"

#include "data/tables.hpp"
#include "flux/gradient_flux.hpp"

namespace thixis::bound {
namespace {

/// (d dim P_{p-1} + m, l): modal coefficients of d psi_l/d xi_d.
std::vector<double> reference_gradient(const reference::CellBasis& basis) {
  const reference::Modal modal(basis.degree());
  const int n = basis.size(), few = reference::dimension(basis.degree() - 1);
  const auto T = to_modal(basis, modal);
  std::vector<double> D(2 * few * n, 0.0);
  for (int d = 0; d < 2; ++d)
    for (int m = 0; m < few; ++m)
      for (int k = 0; k < n; ++k)
        for (int l = 0; l < n; ++l) D[(d * few + m) * n + l] += modal.derivative(d)[m * n + k] * T[k * n + l];
  return D;
}

}  // namespace

StressBase::StressBase(const method::Space& space) : cells_(space.cells().extent_int(0)), owned_(space.mesh().owned_cells) {
  gradient_.entries = space.coefficients().element_entries;
  gradient_.D = matrix_view("thixis::bound::gradient", 2 * reference::dimension(space.basis().degree() - 1), space.basis().size(),
                            reference_gradient(space.basis()));
  gradient_.metric = metrics(space.mesh(), space.cells());
}

std::unique_ptr<Stress> make_stress(const method::Space& space, int q, const scene::Field& tension, const TensionBounds& bounds) {
  if (const double* constant = tension.constant()) return constant_stress(space, *constant);
  return varying_stress(space, q, bounds);
}

}  // namespace thixis::bound
