#include "thixis/equilibration/feasible.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "averages.hpp"
#include "deviation.hpp"
#include "sources.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/method/gradient_form.hpp"
#include "to_view.hpp"

namespace thixis::equilibration {
namespace {

/// Those of the space itself where it has continuous functions.
ContinuousNodes nodes_of(const method::PolynomialSpace& space, const std::vector<bool>& dirichlet) {
  if (!space.conforming()) return continuous_nodes(space.mesh(), space.cells(), space.basis(), space.basis().points(), dirichlet);
  ContinuousNodes nodes{space.coefficients().entries, space.coefficients().element_entries};
  nodes.entries.held = space.numbering().held;
  return nodes;
}

/// theta_1 = mu_2/(mu_1 + mu_2) at the nodes; for Bernstein coefficients at the places of the regular lattice.
std::vector<double> shares(const method::PolynomialSpace& space, const ContinuousNodes& nodes,
                           const std::array<scene::FieldPtr, 2>& tension) {
  const auto host = mesh::on_host(space.mesh());
  const auto of_cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), nodes.of_cells);
  const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.cells());
  const auto& lattice = space.basis().lattice();
  const bool bernstein = space.basis().family() == reference::Family::bernstein;
  const std::size_t count = nodes.entries.size();
  std::vector<double> x(count), y(count), mu[2];
  for (std::size_t e = 0; e < count; ++e) {
    x[e] = nodes.entries.point[e][0];
    y[e] = nodes.entries.point[e][1];
  }
  for (std::size_t k = 0; bernstein && k < of_cells.extent(0); ++k)
    for (int l = 0; l < space.basis().size(); ++l) {
      const double xi = lattice[2 * l], eta = lattice[2 * l + 1], lambda[3] = {1 - xi - eta, xi, eta};
      double place[2] = {0, 0};
      for (int a = 0; a < 3; ++a)
        for (int d = 0; d < 2; ++d) place[d] += lambda[a] * host.coordinates(host.cell_vertices(cells(k), a), d);
      x[of_cells(k, l)] = place[0];
      y[of_cells(k, l)] = place[1];
    }
  for (int alpha = 0; alpha < 2; ++alpha) {
    mu[alpha].resize(count);
    tension[alpha]->evaluate({count, x.data(), y.data()}, 0, mu[alpha].data());
  }
  std::vector<double> share(count);
  for (std::size_t e = 0; e < count; ++e) {
    const double both = mu[0][e] + mu[1][e];
    share[e] = both > 0 ? std::clamp(mu[1][e] / both, 0.0, 1.0) : 0.5;
  }
  return share;
}

double mean(const core::Comm& comm, const View<const double*>& values) {
  double sum = 0;
  for (std::size_t i = 0; i < values.extent(0); ++i) sum += values(i);
  return comm.sum(sum) / static_cast<double>(std::max(1LL, comm.sum(static_cast<long long>(values.extent(0)))));
}

void resize(View<double*>& values, const char* label, LocalIndex count) {
  if (values.extent_int(0) != count) values = View<double*>(std::string(label), count);
}

}  // namespace

struct FeasiblePair::Impl {
  Impl(const method::PolynomialSpace& space_, const Problem& problem)
      : space(space_), nodes(nodes_of(space, held_tags(problem.boundary[0]))), monomials(density_monomials()) {
    set_tensions(problem);
    set_kernel(problem.count);
    set_boundary(problem);
    if (space.conforming()) return;
    averages.emplace(space, nodes);
    for (int alpha = 0; alpha < problem.count; ++alpha)
      averaged[alpha] = View<double*>("thixis::equilibration::averaged", nodes.entries.size());
  }

  void set_tensions(const Problem& problem) {
    const core::Comm& comm = space.mesh().comm;
    const bool both = problem.count == 2;
    bool varying = false;
    double typical[2] = {0, 0};
    for (int alpha = 0; alpha < problem.count; ++alpha) {
      if (const double* mu = problem.tension[alpha]->constant()) {
        typical[alpha] = tension.constant[alpha] = *mu;
      } else {
        varying = true;
        tension.at_points[alpha] = method::tension_at_points(space.mesh(), space.quadrature(), *problem.tension[alpha]);
        typical[alpha] = mean(comm, tension.at_points[alpha]);
      }
    }
    kernel.apart[0] = both ? typical[1] / (typical[0] + typical[1]) : 1;
    kernel.apart[1] = 1 - kernel.apart[0];
    const double* const apart = kernel.apart;
    kernel.constant_move_tension = typical[0] * apart[0] * apart[0] + typical[1] * apart[1] * apart[1];
    if (!varying) return;
    const View<double*> most("thixis::equilibration::move_tension", space.mesh().owned_cells);
    for (LocalIndex K = 0; K < space.mesh().owned_cells; ++K)
      for (GlobalIndex q = space.quadrature().offset(K); q < space.quadrature().offset(K + 1); ++q)
        most(K) = std::max(most(K), tension(0, q) * apart[0] * apart[0] + tension(1, q) * apart[1] * apart[1]);
    kernel.move_tension = most;
    if (both) kernel.theta = to_view("thixis::equilibration::theta", comm.together([&] { return shares(space, nodes, problem.tension); }));
  }

  void set_kernel(int count) {
    const mesh::Mesh& mesh = space.mesh();
    kernel.count = count;
    kernel.x = mesh.coordinates;
    kernel.vertices = mesh.cell_vertices;
    kernel.functions = method::cell_functions(space.basis());
    kernel.energy = {space.basis().bernstein(), gradient_products(space.basis()), space.quadrature(), tension};
    kernel.negative_part = negative_part(space.basis(), kernel.energy.products);
    kernel.to_modal = bernstein_to_modal(space.basis());
    kernel.of_cells = nodes.of_cells;
    kernel.density.to_monomials = monomials;
    if (!space.conforming()) kernel.of_cells_u = space.coefficients().element_entries;
  }

  void set_boundary(const Problem& problem) {
    std::vector<double> held[2];
    space.mesh().comm.together([&] {
      for (int alpha = 0; alpha < problem.count; ++alpha)
        held[alpha] = boundary_coefficients(space, nodes, problem.boundary[alpha].dirichlet);
      if (problem.count == 1) held[1] = interpolant(space, nodes, *problem.obstacle);
    });
    // Bernstein coefficients of ordered data need not be ordered
    for (LocalIndex e = 0; e < nodes.entries.size(); ++e) {
      const double below = std::max(held[1][e] - held[0][e], 0.0), share = kernel.theta.extent(0) > 0 ? kernel.theta(e) : kernel.apart[0];
      if (nodes.entries.held[e] < 0 || below == 0) continue;
      held[0][e] += share * below;
      held[1][e] -= (1 - share) * below;
    }
    lift = std::make_unique<BoundaryLift>(space, nodes, problem.tension, problem.boundary, held, problem.count);
    kernel.lift = lift->of_cells();
    kernel.deviation =
        problem.count == 2 ? deviation_of_membranes(space, *lift) : deviation_of_obstacle(space, *lift, nodes, problem.obstacle, held[1]);
    for (int alpha = 0; alpha < 2; ++alpha) data[alpha] = to_view("thixis::equilibration::held", held[alpha]);
  }

  const method::PolynomialSpace& space;
  ContinuousNodes nodes;
  Matrix monomials;
  Tension tension;
  FeasibleParts kernel;
  View<const double*> data[2];  ///< coefficients on the held boundary; over an obstacle [1] is psi_I
  std::unique_ptr<BoundaryLift> lift;
  std::optional<Averages> averages;
  View<double*> averaged[2];
};

FeasiblePair::FeasiblePair(const method::PolynomialSpace& space, const Problem& problem) : impl_(std::make_unique<Impl>(space, problem)) {}
FeasiblePair::~FeasiblePair() = default;

void FeasiblePair::evaluate(const method::Coefficients (&u)[2], const ConstCellTable& lambda, int degree, Parts& parts,
                            double small) const {
  THIXIS_ASSERT_LE(degree, max_density_degree, "densities have tables up to that degree");
  const LocalIndex cells = impl_->space.mesh().owned_cells;
  resize(parts.whole, "thixis::equilibration::whole", cells);
  resize(parts.at_nodes, "thixis::equilibration::at_nodes", cells);
  resize(parts.rest, "thixis::equilibration::rest", cells);
  resize(parts.contact, "thixis::equilibration::contact", cells);

  FeasibleParts kernel = impl_->kernel;
  kernel.s_c[1] = impl_->data[1];
  for (int alpha = 0; alpha < kernel.count; ++alpha) {
    kernel.u[alpha] = u[alpha];
    kernel.s_c[alpha] = u[alpha];
    if (!impl_->averages) continue;
    (*impl_->averages)(u[alpha], impl_->data[alpha], impl_->averaged[alpha]);
    kernel.s_c[alpha] = impl_->averaged[alpha];
  }
  double size = 0;
  Kokkos::parallel_reduce(
      "thixis::equilibration::size", Kokkos::RangePolicy<>(0, kernel.s_c[0].extent(0)),
      KOKKOS_LAMBDA(std::size_t e, double& most) {
        for (const auto& s : kernel.s_c) most = std::max(most, std::abs(s(e)));
      },
      Kokkos::Max<double>(size));
  kernel.noise = 1e-13 * impl_->space.mesh().comm.max(size);
  kernel.small = small;
  kernel.lambda = lambda;
  kernel.density.degree = degree;
  kernel.whole = parts.whole;
  kernel.at_nodes = parts.at_nodes;
  kernel.rest = parts.rest;
  kernel.contact = parts.contact;
  Kokkos::parallel_for("thixis::equilibration::feasible_parts", Kokkos::RangePolicy<>(0, cells), kernel);
  Kokkos::fence();
  for (const auto& [cell, energy] : impl_->lift->remainder()) {
    parts.whole(cell) += energy;
    parts.rest(cell) += energy;
  }
}

double FeasiblePair::boundary_energy() const { return impl_->lift->energy(); }

std::size_t FeasiblePair::bytes() const {
  const auto of = [](const auto&... views) { return (std::size_t{0} + ... + (views.span() * sizeof(*views.data()))); };
  const FeasibleParts& k = impl_->kernel;
  return of(impl_->data[0], impl_->data[1], impl_->averaged[0], impl_->averaged[1], k.theta, k.move_tension, k.lift.place, k.lift.energy,
            k.lift.products, k.deviation.place, k.deviation.bound, k.deviation.at_points, k.energy.mu.at_points[0],
            k.energy.mu.at_points[1]) +
         (impl_->averages ? of(k.of_cells) : 0);
}

}  // namespace thixis::equilibration
