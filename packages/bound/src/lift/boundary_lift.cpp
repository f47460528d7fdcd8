#include "lift/boundary_lift.hpp"

#include <cmath>

#include "data/on_host.hpp"
#include "data/sources.hpp"
#include "data/tables.hpp"
#include "lift/lift_layer.hpp"
#include "thixis/mesh/geometry.hpp"

namespace thixis::bound {

BoundaryLift::~BoundaryLift() = default;

BoundaryLift::BoundaryLift(const method::Space& space, const ContinuousNodes& nodes, const std::array<scene::FieldPtr, 2>& tension,
                           const std::array<method::BoundaryValues, 2>& boundary, const std::vector<double> (&held)[2], int count,
                           double time, const BoundaryLift* other)
    : space_(space), host_(mesh::on_host(space.mesh())), count_(count), basis_(degree_of_v, reference::Family::bernstein) {
  const core::Comm& comm = space.mesh().comm;
  HeldFaces faces = comm.together([&] { return held_faces(space, nodes, tension, boundary, held, count, time); });
  largest_ = faces.largest;
  empty_ = !comm.any(!faces.empty);
  if (empty_) return;
  remainder_ = std::move(faces.remainder);
  const auto dirichlet = held_tags(boundary[0]);
  set_layer(lift_layer(space, dirichlet), faces.cells);
  equations_ = other && other->equations_ ? other->equations_
                                          : std::make_shared<const LiftEquations>(space, layer_, basis_, dirichlet, tension, count);
  for (int alpha = 0; alpha < count; ++alpha) equations_->solve(alpha, owned_.extent_int(0), lift_[alpha]);
  integrate(tension);
}

/// `faces`: cells of the layer, in its order.
void BoundaryLift::set_layer(const std::vector<LocalIndex>& positions, const std::vector<HeldFaces::Cell>& faces) {
  const auto cells = on_host(space_.cells());
  std::vector<LocalIndex> layer, owned;
  auto next = faces.begin();
  for (const LocalIndex k : positions) {
    const bool on_boundary = next != faces.end() && next->position == k;
    for (int alpha = 0; alpha < 2; ++alpha) lift_[alpha].push_back(on_boundary ? next->l[alpha] : LiftInCell());
    if (on_boundary) ++next;
    layer.push_back(cells(k));
    if (cells(k) < space_.mesh().owned_cells) owned.push_back(cells(k));
  }
  layer_ = to_view("thixis::bound::layer", layer);
  owned_ = to_view("thixis::bound::owned_layer", owned);
}

void BoundaryLift::add_remainder(const View<double*>& of_cells) const {
  if (remainder_.empty()) return;
  const auto host = on_host(of_cells);
  for (const auto& [cell, energy] : remainder_) host(cell) += energy;
  Kokkos::deep_copy(of_cells, host);
}

void BoundaryLift::integrate(const std::array<scene::FieldPtr, 2>& tension) {
  const mesh::Mesh& mesh = space_.mesh();
  const reference::Bernstein& B = space_.basis().bernstein();
  const LiftRule of_faces(mesh, owned_, lift_order, basis_.bernstein(), tension, count_),
      inside(mesh, owned_, 2 * degree_of_v, basis_.bernstein(), tension, count_);
  const auto dB_of_faces = of_faces.derivatives(B), dB_inside = inside.derivatives(B);
  const View<double* [2]> energy("thixis::bound::lift_energy", owned_.extent(0));
  const Kokkos::View<double***, Kokkos::LayoutRight> products("thixis::bound::lift_products", owned_.extent(0), 2, B.size);
  const auto energies = Kokkos::create_mirror_view(energy);
  const auto of_basis = Kokkos::create_mirror_view(products);
  const auto owned = on_host(owned_);
  std::vector<LocalIndex> place(mesh.owned_cells, -1);
  double sum = 0;
  std::vector<double> L[3];
  for (LocalIndex k = 0; k < owned.extent_int(0); ++k) {
    place[owned(k)] = k;
    const auto K = mesh::cell_geometry(host_.coordinates, host_.cell_vertices, owned(k));
    for (int alpha = 0; alpha < count_; ++alpha) {
      const bool on_face = lift_[alpha][k].faces > 0;
      const LiftRule& rule = on_face ? of_faces : inside;
      rule.table.evaluate(lift_[alpha][k], L);
      energies(k, alpha) = rule.weigh(alpha, k, K, L);
      add_products(1, L, on_face ? dB_of_faces : dB_inside, B.size, &of_basis(k, alpha, 0));
      sum += energies(k, alpha);
    }
  }
  Kokkos::deep_copy(energy, energies);
  Kokkos::deep_copy(products, of_basis);
  energy_ = std::sqrt(mesh.comm.sum(sum));
  of_cells_ = {to_view("thixis::bound::place_in_layer", place), energy, products};
}

}  // namespace thixis::bound
