#pragma once
#include "thixis/mesh/mesh.hpp"

namespace thixis::mesh {

template <class Data>
using HostView = typename View<Data>::HostMirror;

/// The Views of a mesh where the host can read and write them: the Views themselves on host backends, copies elsewhere.
struct HostMesh {
  HostView<double*[2]> coordinates, parameter;
  HostView<LocalIndex*[3]> cell_vertices, cell_faces;
  HostView<LocalIndex*[2]> face_vertices, face_cells;
  HostView<LocalIndex*> face_tag;
};

/// The Views of a finished mesh, to be read.
HostMesh on_host(const Mesh& mesh);

/// Allocates the Views of a mesh (all but ghost_patch_cells) and its host arrays for the counts and the chart it holds, uninitialized, and
/// returns where to fill them. A mesh with the identity chart has one View for coordinates and parameters.
HostMesh allocate(Mesh& mesh);

/// Brings what was filled on the host into the Views of the mesh.
void commit(const HostMesh& filled, Mesh& mesh);

}  // namespace thixis::mesh
