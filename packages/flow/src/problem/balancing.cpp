#include "problem/balancing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "problem/around.hpp"
#include "step/extremes.hpp"
#include "step/vectors.hpp"
#include "thixis/core/timer.hpp"

namespace thixis::flow {
namespace {

using algebra::Vector;

constexpr double some_gas = 1e-8;   // s_g of cells that can give and take water
constexpr double rounding = 1e-15;  // mean row that needs no correction
constexpr double singular = 1e-10;  // share of the determinant that cancellation must leave

/// W^T v over the owned cells: the rows of water and of hydrogen summed with the weights |K|, masses over mass_c.
std::array<double, components> summed(const fv::Grid& grid, const Vector& v) {
  std::array<double, components> sum;
  const auto volume = grid.volume;
  const auto in = read(v);
  for (int c = 0; c < components; ++c)
    Kokkos::parallel_reduce(
        "thixis::flow::summed", Cells(0, grid.owned_cells),
        KOKKOS_LAMBDA(LocalIndex K, double& of) { of += volume(K) * in(unknowns_per_cell * K + first_equation + c, 0); }, sum[c]);
  return sum;
}

bool is_open(const TwoPhaseOperator& flow) {
  int faces = 0;
  const auto& kind = flow.face_kind();
  Kokkos::parallel_reduce(
      "thixis::flow::open", Cells(0, flow.grid().faces),
      KOKKOS_LAMBDA(LocalIndex F, int& sum) { sum += kind(F) == FlowBoundaryKind::state; }, faces);
  return flow.grid().comm.any(faces > 0);
}

}  // namespace

Balancing::Balancing(const TwoPhaseOperator& flow) : flow_(flow), volume_(volume(flow.grid())), open_(is_open(flow)) {}

/// The column of Z for a component: chi for hydrogen; for water P if it can leave through faces of kind state, else s_g where there is gas.
Teuchos::RCP<Vector> Balancing::mode(int component, const fv::View<PhaseState*>& states) const {
  const auto mode = Teuchos::rcp(new Vector(flow_.map()));
  const auto z = write(*mode);
  const auto& at = states;
  const int unknown = component == hydrogen ? dissolved : open_ ? pressure : gas_saturation;
  Kokkos::parallel_for(
      "thixis::flow::balancing_mode", Cells(0, flow_.grid().owned_cells), KOKKOS_LAMBDA(LocalIndex K) {
        if (unknown != gas_saturation || at(K).s_g > some_gas) z(unknowns_per_cell * K + unknown, 0) = 1;
      });
  return mode;
}

void Balancing::operator()(const fv::View<PhaseState*>& states, const algebra::Matrix& A, const Vector& B, Vector& Y,
                           double& residual) const {
  const core::Region region("balance");
  const fv::Grid& grid = flow_.grid();
  Vector r(B, Teuchos::Copy);
  A.apply(Y, r, Teuchos::NO_TRANS, -1, 1);
  const Teuchos::RCP<const Vector> Z[components] = {mode(water, states), mode(hydrogen, states)};
  Vector AZ[components] = {Vector(flow_.map()), Vector(flow_.map())};
  std::vector<double> sum;  // of the columns of A Z, and of r
  for (const Vector* v : {&AZ[water], &AZ[hydrogen], &r}) {
    if (v != &r) A.apply(*Z[v - AZ], AZ[v - AZ]);
    const auto of = summed(grid, *v);
    sum.insert(sum.end(), of.begin(), of.end());
  }
  grid.comm.sum(sum);

  if (std::max(std::abs(sum[4]), std::abs(sum[5])) <= rounding * volume_) return;
  const double plus = sum[0] * sum[3], minus = sum[1] * sum[2], determinant = plus - minus;
  if (!(std::abs(determinant) > singular * (std::abs(plus) + std::abs(minus)))) return;
  const double c[components] = {(sum[4] * sum[3] - sum[5] * sum[2]) / determinant, (sum[0] * sum[5] - sum[1] * sum[4]) / determinant};
  const double before = r.norm2();
  r.update(-c[water], AZ[water], -c[hydrogen], AZ[hydrogen], 1);
  const double after = r.norm2();
  if (!(after <= std::max(2 * before, 0.5 * B.norm2()))) return;
  Y.update(c[water], *Z[water], c[hydrogen], *Z[hydrogen], 1);
  residual = after;
}

}  // namespace thixis::flow
