#include "feasible/pair_on_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "data/on_host.hpp"
#include "data/sources.hpp"
#include "data/tables.hpp"
#include "data/tension_bounds.hpp"
#include "deviation/deviation.hpp"
#include "feasible/nodes.hpp"
#include "thixis/bound/shares.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::bound {
namespace {

double mean(const core::Comm& comm, const View<const double*>& values) {
  double sum = 0;
  Kokkos::parallel_reduce(
      "thixis::bound::mean", Kokkos::RangePolicy<>(0, values.extent_int(0)), KOKKOS_LAMBDA(int i, double& all) { all += values(i); }, sum);
  return comm.sum(sum) / static_cast<double>(std::max(1LL, comm.sum(static_cast<long long>(values.extent(0)))));
}

}  // namespace

FeasiblePair::Impl::Impl(const method::Space& space_, const Problem& problem_)
    : space(space_), problem(problem_), nodes(nodes_of(space, held_tags(problem.boundary[0]))), monomials(density_monomials()) {
  set_tensions();
  set_kernel();
  if (problem.count == 1)
    jumps = space.mesh().comm.together([&] { return method::jumps_in_cells(space.quadrature(), *problem.obstacle, 0); });
  set_boundary(nullptr);
  if (space.conforming()) return;
  averages.emplace(space, nodes);
  for (int alpha = 0; alpha < problem.count; ++alpha) averaged[alpha] = at_nodes();
}

FeasiblePair::Impl::Impl(const Impl& other, double time)
    : space(other.space),
      problem(other.problem),
      nodes(other.nodes),
      jumps(other.jumps),
      monomials(other.monomials),
      modal(other.modal),
      tension(other.tension),
      kernel(other.kernel),
      averages(other.averages) {
  problem.time = time;
  set_boundary(other.lift.get());
  for (int alpha = 0; averages && alpha < problem.count; ++alpha) averaged[alpha] = at_nodes();
}

void FeasiblePair::Impl::set_tensions() {
  const core::Comm& comm = space.mesh().comm;
  const bool both = problem.count == 2;
  bool varying = false;
  double typical[2] = {0, 0};
  std::vector<double> most[2];
  for (int alpha = 0; alpha < problem.count; ++alpha) {
    const TensionBounds bounds = tension_bounds(space, *problem.tension[alpha]);
    if (const double* mu = problem.tension[alpha]->constant()) {
      typical[alpha] = tension.constant[alpha] = *mu;
    } else {
      varying = true;
      tension.at_points[alpha] = bounds.at_points;
      typical[alpha] = mean(comm, tension.at_points[alpha]);
    }
    most[alpha] = bounds.most;
  }
  const auto of_way = both ? shares(typical[0], typical[1]).of_way : std::array<double, 2>{1, 0};
  std::copy(of_way.begin(), of_way.end(), kernel.apart);
  const double* const apart = kernel.apart;
  kernel.constant_move_tension = typical[0] * apart[0] * apart[0] + typical[1] * apart[1] * apart[1];
  if (!varying) return;
  std::vector<double> of_move(space.mesh().owned_cells, 0.0);
  for (LocalIndex K = 0; K < space.mesh().owned_cells; ++K)
    for (int alpha = 0; alpha < problem.count; ++alpha) of_move[K] += most[alpha][K] * apart[alpha] * apart[alpha];
  kernel.move_tension = to_view("thixis::bound::move_tension", of_move);
  if (both) kernel.theta = to_view("thixis::bound::theta", comm.together([&] { return ways_of_upper(space, nodes, problem.tension); }));
}

void FeasiblePair::Impl::set_kernel() {
  const mesh::Mesh& mesh = space.mesh();
  kernel.count = problem.count;
  kernel.x = mesh.coordinates;
  kernel.vertices = mesh.cell_vertices;
  kernel.functions = method::cell_functions(space.basis());
  kernel.energy = {space.basis().bernstein(), gradient_products(space.basis()), space.quadrature(), tension};
  kernel.first_vertex = space.basis().interior();
  kernel.negative_part = negative_part(space.basis(), kernel.energy.products);
  kernel.to_modal = bernstein_to_modal(space.basis());
  kernel.of_cells = nodes.of_cells;
  kernel.density.to_monomials = monomials;
  const int n = space.basis().size();
  const reference::Modal orthonormal(space.basis().degree());
  modal = matrix_view("thixis::bound::to_modal", n, n, to_modal(space.basis(), orthonormal));
  if (!space.conforming()) kernel.of_cells_u = space.coefficients().element_entries;
}

void FeasiblePair::Impl::set_boundary(const BoundaryLift* other) {
  std::vector<double> held[2];
  space.mesh().comm.together([&] {
    for (int alpha = 0; alpha < problem.count; ++alpha)
      held[alpha] = boundary_coefficients(space, nodes, problem.boundary[alpha].dirichlet, problem.time);
    if (problem.count == 1) held[1] = obstacle_coefficients(space, nodes, *problem.obstacle, jumps);
  });
  bring_in_order(held);
  lift = std::make_unique<BoundaryLift>(space, nodes, problem.tension, problem.boundary, held, problem.count, problem.time, other);
  kernel.lift = lift->of_cells();
  double size = 0;
  for (const auto& values : held)
    for (const double value : values) size = std::max(size, std::abs(value));
  size = space.mesh().comm.max(size);
  if (problem.count == 2) kernel.deviation = deviation_of_membranes(space, *lift, held_tags(problem.boundary[0]), 1e-12 * size);
  else set_obstacle(held[1], held[0]);
  for (int alpha = 0; alpha < 2; ++alpha) data[alpha] = to_view("thixis::bound::held", held[alpha]);
}

void FeasiblePair::Impl::bring_in_order(std::vector<double> (&held)[2]) const {
  const auto theta = on_host(kernel.theta);
  for (LocalIndex e = 0; e < nodes.entries.size(); ++e) {
    const double below = std::max(held[1][e] - held[0][e], 0.0), share = theta.extent(0) > 0 ? theta(e) : kernel.apart[0];
    if (nodes.entries.held[e] < 0 || below == 0) continue;
    held[0][e] += share * below;
    held[1][e] -= (1 - share) * below;
  }
}

void FeasiblePair::Impl::set_obstacle(const std::vector<double>& psi, const std::vector<double>& g) {
  const auto above = majorant(space, nodes, jumps, psi, g);
  kernel.deviation =
      deviation_of_obstacle(space, *lift, nodes, problem.obstacle, above.empty() ? psi : above, jumps, held_tags(problem.boundary[0]));
  if (above.empty()) return;
  kernel.majorant = to_view("thixis::bound::majorant", above);
  kernel.excess = excess_of_majorant(space, nodes, *problem.obstacle, above, jumps);
}

std::vector<bool> FeasiblePair::Impl::of_jumps() const {
  std::vector<bool> vertices(space.mesh().vertices, false);
  const auto host = mesh::on_host(space.mesh());
  const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.cells());
  for (std::size_t k = 0; k < cells.extent(0); ++k)
    for (int i = 0; i < 3 && jumps.at(static_cast<LocalIndex>(k)); ++i) vertices[host.cell_vertices(cells(k), i)] = true;
  return vertices;
}

Pressing& FeasiblePair::Impl::pressing() {
  if (!known_pressing) known_pressing = std::make_unique<Pressing>(space, kernel, held_tags(problem.boundary[0]), of_jumps());
  return *known_pressing;
}

double FeasiblePair::Impl::noise(const Continuous& s_c) const {
  double size = 0;
  Kokkos::parallel_reduce(
      "thixis::bound::size", Kokkos::RangePolicy<>(0, s_c[0].extent(0)),
      KOKKOS_LAMBDA(std::size_t e, double& most) {
        for (const auto& s : s_c) most = std::max(most, std::abs(s(e)));
      },
      Kokkos::Max<double>(size));
  return 1e-13 * space.mesh().comm.max(size);
}

}  // namespace thixis::bound
