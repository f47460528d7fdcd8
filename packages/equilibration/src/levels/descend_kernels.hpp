#pragma once
#include "levels/families.hpp"

/// Kernels of MultilevelFlux.
namespace thixis::equilibration {

/// y += M x, M by columns.
KOKKOS_INLINE_FUNCTION void add_product(const Matrix& M, const double* x, double* y) {
  const int rows = M.extent_int(1);
  for (int k = 0; k < M.extent_int(0); ++k) {
    const double a = x[k];
    const double* const column = &M(k, 0);
    for (int i = 0; i < rows; ++i) y[i] += a * column[i];
  }
}

constexpr int most_densities = reference::dimension(4), most_fluxes = 2 * reference::dimension(5);

struct Sum {
  CutMatrices cut;
  View<const LocalIndex*> parent;
  Children child;
  int n;
  ConstCellTable fine;
  CellTable coarse;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    double x[most_children * most_densities], y[most_densities];
    for (int c = 0; c < cut.children; ++c)
      for (int k = 0; k < n; ++k) x[c * n + k] = child(e, c) < 0 ? 0 : fine(child(e, c), k);
    for (int k = 0; k < n; ++k) y[k] = 0;
    add_product(cut.sum, x, y);
    for (int k = 0; k < n; ++k) coarse(parent(e), k) = y[k];
  }
};

/// sigma of the children = restriction of that of the cell + lift of what their densities are beyond that of the cell.
struct Descend {
  CutMatrices cut;
  View<const LocalIndex*> parent;
  Children child;
  int n, flux;
  ConstCellTable fine, coarse, sigma_coarse;
  CellTable sigma_fine;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const int c_n = cut.children * n, c_flux = cut.children * flux;
    double x[most_children * most_densities], y[most_children * most_fluxes], minus[most_densities];
    for (int c = 0; c < cut.children; ++c)
      for (int k = 0; k < n; ++k) x[c * n + k] = child(e, c) < 0 ? 0 : fine(child(e, c), k);
    for (int k = 0; k < n; ++k) minus[k] = -coarse(parent(e), k);
    add_product(cut.share, minus, x);
    for (int i = 0; i < c_flux; ++i) y[i] = 0;
    add_product(cut.restrict, &sigma_coarse(parent(e), 0), y);
    bool nothing = true;
    for (int i = 0; i < c_n; ++i) nothing = nothing && x[i] == 0;
    if (cut.children > 1 && !nothing) add_product(cut.lift, x, y);
    for (int c = 0; c < cut.children; ++c)
      if (child(e, c) >= 0)
        for (int i = 0; i < flux; ++i) sigma_fine(child(e, c), i) = y[c * flux + i];
  }
};

}  // namespace thixis::equilibration
