#pragma once
#include "thixis/fv/grid.hpp"

namespace thixis::fv {

template <class Data>
using HostView = typename View<Data>::HostMirror;

/// The Views of a grid where the host can read and write them: the Views themselves on host backends, copies elsewhere.
struct HostGrid {
  HostView<double*[2]> centre, barycentre;
  HostView<double*> volume, diameter;
  HostView<LocalIndex* [2]> face_cells;
  HostView<double*> face_area, face_distance;
  HostView<double*[2]> face_centre, face_normal;
  HostView<LocalIndex*> face_tag, cell_face_begin, cell_faces;
  HostView<LocalIndex**> cell_vertices;
  HostView<double* [2]> vertex;
};

/// The Views of a finished grid, to be read.
HostGrid on_host(const Grid& grid);

/// Allocates the Views of a grid and its numbers and owners for the counts it holds, uninitialized, and returns where to fill them.
/// `corners`: of a cell, as many as it has faces.
HostGrid allocate(Grid& grid, int corners);

/// Brings what was filled on the host into the Views of the grid.
void commit(const HostGrid& filled, Grid& grid);

}  // namespace thixis::fv
