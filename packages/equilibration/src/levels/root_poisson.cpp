#include "levels/root_poisson.hpp"

#include <cmath>

#include "levels/root_kernels.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/method/form.hpp"
#include "thixis/method/gradient_form.hpp"
#include "thixis/method/space.hpp"

namespace thixis::equilibration {
namespace {

/// Row of each vertex of a whole mesh, -1 where it is held, or rests because nothing else of its piece is held.
std::vector<LocalIndex> free_vertices(const mesh::Mesh& mesh, const std::vector<bool>& held, const std::vector<LocalIndex>& at_rest) {
  auto tag = method::held_vertices(mesh, held);
  for (const LocalIndex v : at_rest) tag[v] = 0;
  std::vector<LocalIndex> row(mesh.vertices);
  LocalIndex count = 0;
  for (LocalIndex v = 0; v < mesh.vertices; ++v) row[v] = tag[v] >= 0 ? -1 : count++;
  return row;
}

/// (a, k): coefficient 0 of lambda_a phi_k, times ∫ phi_0 = √(1/2).
Matrix first_row_of(int q) {
  const reference::Modal modal(q + 1);
  const Kokkos::View<double**, Kokkos::LayoutRight> first("thixis::equilibration::first_row", 3, reference::dimension(q));
  const auto host = Kokkos::create_mirror_view(first);
  for (int a = 0; a < 3; ++a)
    for (int k = 0; k < first.extent_int(1); ++k) host(a, k) = modal.times_barycentric(a)[k] * std::sqrt(0.5);
  Kokkos::deep_copy(first, host);
  return first;
}

}  // namespace

RootPoisson::RootPoisson(const mesh::Mesh& mesh, const std::vector<bool>& held, const std::vector<LocalIndex>& at_rest, int q)
    : mesh_(mesh),
      row_("thixis::equilibration::root_unknowns", mesh.cells, 3),
      first_row_(first_row_of(q)),
      moments_("thixis::equilibration::hat_moments", mesh.cells, 3) {
  const auto row = free_vertices(mesh, held, at_rest);
  const auto vertices = mesh::on_host(mesh).cell_vertices;
  const auto rows = Kokkos::create_mirror_view(row_);
  LocalIndex count = 0;
  for (const LocalIndex r : row) count += r >= 0;
  for (LocalIndex K = 0; K < mesh.cells; ++K)
    for (int i = 0; i < 3; ++i) rows(K, i) = row[vertices(K, i)];
  Kokkos::deep_copy(row_, rows);
  if (count == 0) return;
  map_ = algebra::contiguous_map(count, mesh.comm);
  const reference::CellBasis hats(1, reference::Family::bernstein);
  const auto quadrature = method::make_quadrature(mesh, method::owned_cells(mesh), 0, nullptr);
  const auto form = method::gradient_form(mesh, quadrature, hats, *scene::constant(1));
  algebra::LinearParams direct;
  direct.solver = algebra::SolverKind::direct;
  solver_ = std::make_unique<algebra::Solver>(direct);
  solver_->set_matrix(method::assemble(mesh.comm, method::make_graph(map_, map_, row_), row_, *form), 1);
}

RootPoisson::~RootPoisson() = default;

void RootPoisson::solve(const ConstCellTable& r, const Kokkos::View<double* [3], Kokkos::LayoutRight>& rho) const {
  if (!solver_) return Kokkos::deep_copy(rho, 0);
  Kokkos::parallel_for("thixis::equilibration::hat_moments", Kokkos::RangePolicy<>(0, mesh_.cells), HatMoments{r, first_row_, moments_});
  algebra::Vector b(map_), x(map_);
  method::scatter(row_, 0, moments_, b);
  if (b.norm2() > 0) {
    algebra::LinearStop stop;
    stop.tolerance = 1e-12 * b.norm2();
    const auto report = solver_->solve(b, x, stop);
    if (!(report.residual <= 1e-8 * b.norm2()))
      throw core::Error(core::ExitCode::internal, "The coarse problem of the algebraic error can not be solved: " + report.reason + ".");
  }
  const auto solution = std::as_const(x).getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto row = row_;
  Kokkos::parallel_for(
      "thixis::equilibration::root_solution", Kokkos::RangePolicy<algebra::Vector::execution_space>(0, mesh_.cells), KOKKOS_LAMBDA(int K) {
        for (int i = 0; i < 3; ++i) rho(K, i) = row(K, i) < 0 ? 0 : solution(row(K, i), 0);
      });
}

}  // namespace thixis::equilibration
