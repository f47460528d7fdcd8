#include "problem/jacobian.hpp"

#include "problem/around.hpp"
#include "step/vectors.hpp"

namespace thixis::flow {
namespace {

using LocalMatrix = algebra::Matrix::local_matrix_device_type;

struct Fill {
  Around around;
  TwoPhaseLaws laws;
  double unknown[unknowns_per_cell];
  fv::View<PhaseState*> states;
  fv::View<FaceFlux*> fluxes;
  fv::View<LocalIndex*> row_begin, own, place;  ///< of Pattern
  VectorIn a, b;
  LocalMatrix A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex K) const {
    const LocalIndex contact = row_begin(K), equations = contact + unknowns_per_cell;
    const LocalIndex row = (row_begin(K + 1) - equations) / components;  // entries of each equation
    for (LocalIndex k = equations; k < row_begin(K + 1); ++k) A.values(k) = 0;

    double G[unknowns_per_cell];
    laws.undersaturation_slopes(states(K), G);
    for (int u = 0; u < unknowns_per_cell; ++u) A.values(contact + u) = unknown[u] * (b(K, 0) * G[u] + (u == gas_saturation ? a(K, 0) : 0));

    const Masses l = laws.masses(states(K));
    for (int c = 0; c < components; ++c) {
      double* entries = &A.values(equations + c * row);
      double* diagonal = entries + unknowns_per_cell * own(K);
      for (int u = 0; u < unknowns_per_cell; ++u) diagonal[u] = unknown[u] * l.d[c][u] / around.mass[c];
      const double factor = around.length / (around.volume(K) * around.mass[c]);
      for (LocalIndex f = around.begin(K); f < around.begin(K + 1); ++f) {
        const LocalIndex F = around.faces(f);
        const FaceFlux& flux = fluxes(F);
        const double out = factor * around.outward(F, K);
        const auto& by_own = around.first(F, K) ? flux.by_first : flux.by_second;
        const auto& by_other = around.first(F, K) ? flux.by_second : flux.by_first;
        for (int u = 0; u < unknowns_per_cell; ++u) diagonal[u] += unknown[u] * out * by_own[c][u];
        if (place(f) >= 0)
          for (int u = 0; u < unknowns_per_cell; ++u) entries[unknowns_per_cell * place(f) + u] = unknown[u] * out * by_other[c][u];
      }
    }
  }
};

}  // namespace

void fill_jacobian(const Linearization& at, double length, const fv::Grid& grid, const TwoPhaseLaws& laws, const FlowScales& scales,
                   const algebra::Vector& a, const algebra::Vector& b, const Pattern& pattern) {
  Fill kernel{Around(grid, length, scales), laws};
  for (int u = 0; u < unknowns_per_cell; ++u) kernel.unknown[u] = scales.unknown[u];
  kernel.states = at.states;
  kernel.fluxes = at.fluxes;
  kernel.row_begin = pattern.row_begin;
  kernel.own = pattern.own;
  kernel.place = pattern.place;
  kernel.a = read(a);
  kernel.b = read(b);
  kernel.A = pattern.matrix->getLocalMatrixDevice();
  Kokkos::parallel_for("thixis::flow::jacobian", Cells(0, grid.owned_cells), kernel);
}

}  // namespace thixis::flow
