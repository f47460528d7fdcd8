#include "thixis/models/model.hpp"

namespace thixis::models {

// The tables of virtual functions stand here, once.
SceneOnMesh::~SceneOnMesh() = default;
Model::~Model() = default;

namespace {

std::vector<double> copy(const mesh::View<const double*>& values) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), values);
  return {host.data(), host.data() + host.extent(0)};
}

}  // namespace

CellEstimates cell_estimates(const mesh::View<const double*>& discretization, const mesh::View<const double*>& linearization,
                             const mesh::View<const double*>& algebraic) {
  return {copy(discretization), copy(linearization), copy(algebraic)};
}

}  // namespace thixis::models
