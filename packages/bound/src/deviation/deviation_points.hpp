#pragma once
#include <vector>

#include "deviation/deviation_of_cells.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/method/quadrature.hpp"

namespace thixis::bound {

/// The part of a quadrature at some positions.
method::CellQuadrature subset(const method::CellQuadrature& all, const std::vector<LocalIndex>& positions);

/// The same rule on each of sides² equal parts of every cell: integrands jump where the gap changes its sign.
method::CellQuadrature composite(method::CellQuadrature quadrature, int sides);

/// Points of the reference triangle on its faces, those of one after those of the other.
constexpr int points_of_face = 16;
View<double* [2]> face_points();

/// Marks the held faces of a cell on which D, given at face_points(), is more than round-off.
void mark_held(const mesh::HostMesh& host, const std::vector<bool>& dirichlet, LocalIndex K, const double* D, double noise,
               const mesh::HostView<bool* [3]>& on_held, LocalIndex place);

/// A place for each owned cell, none yet: -1.
View<LocalIndex*> nowhere(const mesh::Mesh& mesh);

/// The Views of a Deviation while they are filled.
class DeviationOnHost {
 public:
  DeviationOnHost() = default;
  DeviationOnHost(const mesh::Mesh& mesh, std::size_t cells, std::size_t points);
  void commit(Deviation& deviation) const;  ///< deviation <- what was filled in

  mesh::HostView<LocalIndex*> place;  ///< as in Deviation
  mesh::HostView<double*> bound;
  mesh::HostView<double* [3]> at_points;
  mesh::HostView<bool* [3]> on_held;

 private:
  View<LocalIndex*> place_;
  View<double*> bound_;
  View<double* [3]> at_points_;
  View<bool* [3]> on_held_;
};

}  // namespace thixis::bound
