#pragma once
#include "problem/scales.hpp"
#include "step/operator.hpp"

namespace thixis::flow {

/// The rows of a cell: contact, water, hydrogen.
constexpr int contact_row = 0, first_equation = 1;

/// The faces around a cell, their areas with the sign of outward fluxes, and the factors tau/(|K| mass_c) of its equations.
struct Around {
  fv::View<LocalIndex*> begin, faces;
  fv::View<LocalIndex* [2]> cells;
  fv::View<double*> area, volume;
  double length, mass[components];

  Around(const fv::Grid& grid, double step_length, const FlowScales& scales)
      : begin(grid.cell_face_begin),
        faces(grid.cell_faces),
        cells(grid.face_cells),
        area(grid.face_area),
        volume(grid.volume),
        length(step_length),
        mass{scales.mass[0], scales.mass[1]} {}
  KOKKOS_FUNCTION bool first(LocalIndex F, LocalIndex K) const { return cells(F, 0) == K; }
  KOKKOS_FUNCTION double outward(LocalIndex F, LocalIndex K) const { return first(F, K) ? area(F) : -area(F); }
};

}  // namespace thixis::flow
