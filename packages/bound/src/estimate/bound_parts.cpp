#include "estimate/bound_parts.hpp"

#include <algorithm>
#include <cmath>

#include "data/cut_oscillation.hpp"
#include "data/tables.hpp"
#include "estimate/exactness.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/mesh/ancestry.hpp"

namespace thixis::bound {

using algebra::Vector;

bool vanishes(const Vector& v) { return v.normInf() == 0; }

BoundParts::BoundParts(const method::PolynomialSpace& of, const ContactProblem& contact, const mesh::Hierarchy& hierarchy, int level)
    : space(of),
      problem(contact),
      mesh(of.mesh()),
      comm(mesh.comm),
      q(of.flux_degree()),
      n(reference::dimension(q)),
      flux(2 * reference::dimension(q + 1)),
      owned(mesh.owned_cells),
      patch_cells(of.cells().extent_int(0)),
      held(held_tags(contact.boundary[0])),
      lift(mesh::ancestry(hierarchy, level), comm, held, q),
      feasible(std::make_shared<FeasiblePair>(
          of, FeasiblePair::Problem{contact.count, contact.tension, contact.boundary, contact.obstacle, contact.time})),
      metric(metrics(mesh, of.cells())) {
  const auto table = [](const std::string& label, LocalIndex rows, int columns) { return CellTable(label, rows, columns); };
  const bool conforming = space.conforming();
  bool proved[2] = {true, true};
  multiplier = conforming ? patchwise_multiplier(space, feasible->jumps()) : cellwise_multiplier(space);
  if (conforming) {
    patches = std::make_unique<equilibration::PatchFlux>(mesh, space.cells(), held, q);
    patch_lambda = table("thixis::bound::patch_lambda", patch_cells, 3 * n);
    patch_density = table("thixis::bound::patch_density", patch_cells, 3 * n);
    patch_target = table("thixis::bound::patch_target", patch_cells, 2 * n);
  } else {
    positive = table("thixis::bound::positive_multiplier", patch_cells, n);
  }
  moments = table("thixis::bound::moments", patch_cells, space.basis().size());
  lambda = table("thixis::bound::lambda", owned, n);
  for (int alpha = 0; alpha < problem.count; ++alpha) {
    Membrane& m = membrane[alpha];
    const TensionBounds bounds = tension_bounds(space, *problem.tension[alpha]);
    m.least_tension = bounds.least;
    proved[alpha] = bounds.proved;
    m.stress = make_stress(space, q, *problem.tension[alpha], bounds);
    m.w = table("thixis::bound::stress", patch_cells, 2 * n);
    m.r_alg = table("thixis::bound::r_alg", patch_cells, n);
    m.r_lin = table("thixis::bound::r_lin", patch_cells, n);
    m.sigma_disc = table("thixis::bound::sigma_disc", owned, flux);
    m.sigma_alg = table("thixis::bound::sigma_alg", owned, flux);
    m.sigma_lin = table("thixis::bound::sigma_lin", owned, flux);
    for (View<double*>* norm : {&m.norms.whole, &m.norms.disc, &m.norms.alg, &m.norms.lin})
      *norm = View<double*>("thixis::bound::flux_norm", owned);
  }
  set_sources(problem.time);
  const reference::Modal modal(space.basis().degree());
  const int functions = space.basis().size();
  from_moments = matrix("thixis::bound::from_moments", functions, functions, bound::from_moments(space.basis(), modal));
  times = times_hats(q);
  for (View<double*>* of_cells : {&h, &contact_lin, &multiplier_rest, &cells.discretization, &cells.linearization, &cells.algebraic})
    *of_cells = View<double*>("thixis::bound::of_cells", owned);
  const auto diameter = diameters(mesh);
  const auto h_host = Kokkos::create_mirror_view(h);
  std::copy(diameter.begin(), diameter.end(), h_host.data());
  Kokkos::deep_copy(h, h_host);
  doubts = bound::doubts(space, problem, q, proved, *feasible);
}

void BoundParts::set_sources(double time) {
  problem.time = time;
  const CutOscillation cut_cells(space, q, problem.interface, time);
  for (int alpha = 0; alpha < problem.count; ++alpha)
    membrane[alpha].data =
        sources(space, q, *problem.force[alpha], problem.boundary[alpha], time, &cut_cells, membrane[alpha].least_tension);
}

void BoundParts::represent(const Vector& R, const CellTable& r, bool& has) const {
  const bool had = has;
  has = !vanishes(R);
  if (!has) {
    if (had) Kokkos::deep_copy(r, 0);
    return;
  }
  space.share(R, moments);
  Kokkos::parallel_for("thixis::bound::represent", Kokkos::RangePolicy<>(0, patch_cells), Represent{moments, from_moments, r});
}

double BoundParts::lift_residual(const Vector& R, const CellTable& r, const CellTable& sigma, bool& has) const {
  const bool had = has;
  represent(R, r, has);
  if (has) return lift(r, sigma);
  if (had) Kokkos::deep_copy(sigma, 0);
  return 0;
}

void BoundParts::discretization_flux(const Iterate& iterate, int alpha, const ConstCellTable& rate) const {
  const Membrane& m = membrane[alpha];
  if (!patches)
    return space.native_flux(*problem.tension[alpha], *problem.force[alpha], iterate.u[alpha], problem.boundary[alpha], problem.time,
                             {multiplier->held_moments(), alpha == 0 ? 1.0 : -1.0}, m.sigma_disc);
  Kokkos::parallel_for(
      "thixis::bound::patch_data", Kokkos::RangePolicy<>(0, patch_cells),
      PatchSources{m.data.force, rate, m.r_alg, m.r_lin, patch_lambda, m.w, alpha == 0 ? 1.0 : -1.0, times, patch_density, patch_target});
  (*patches)({patch_density, patch_target, m.data.traction}, m.sigma_disc);
}

Stress::Fluxes BoundParts::fluxes(int alpha) const {
  const Membrane& m = membrane[alpha];
  const auto if_any = [](bool has, const CellTable& sigma) { return has ? ConstCellTable(sigma) : ConstCellTable(); };
  return {m.sigma_disc, if_any(m.has_alg, m.sigma_alg), if_any(m.has_lin, m.sigma_lin)};
}

void BoundParts::measure(const method::Coefficients& u, int alpha) const {
  const Membrane& m = membrane[alpha];
  m.stress->norms(u, m.w, fluxes(alpha), m.norms);
}

double BoundParts::mean_flux_term() const {
  double sum = 0;
  for (int alpha = 0; alpha < problem.count; ++alpha) {
    double square = 0;
    const auto whole = membrane[alpha].norms.whole;
    Kokkos::parallel_reduce(
        "thixis::bound::flux_term", Kokkos::RangePolicy<>(0, owned),
        KOKKOS_LAMBDA(int K, double& of_cells) { of_cells += whole(K) * whole(K); }, square);
    sum += square;
  }
  return comm.sum(sum) / static_cast<double>(mesh.global_cells);
}

/// Values at contact points, 0 at other unknowns.
void BoundParts::extend(const Vector& at_points, Vector& all) const {
  const auto in = algebra::host_view(at_points);
  const auto out = algebra::host_view(all);
  for (std::size_t l = 0; l < in.extent(0); ++l) out(l) = in(l);
}

/// M_l = D_l max(X3_l, 0) on points(), -D_l min(X3_l, 0) on map().
void BoundParts::split_multiplier(const Vector& X3, Vector& above, Vector& below) const {
  const auto lambda_l = algebra::host_view(X3), D = algebra::host_view(space.pairing());
  const auto plus = algebra::host_overwrite(above);
  const auto minus = algebra::host_view(below);
  for (std::size_t l = 0; l < lambda_l.extent(0); ++l) {
    plus(l) = D(l) * std::max(lambda_l(l), 0.0);
    minus(l) = -D(l) * std::min(lambda_l(l), 0.0);
  }
}

void BoundParts::contact_at_points(const Vector& above, const Vector& gap) {
  Vector product(space.map());
  {
    const auto M = algebra::host_view(above), K = algebra::host_view(gap);
    const auto out = algebra::host_view(product);
    for (std::size_t l = 0; l < M.extent(0); ++l) out(l) = M(l) * std::max(K(l), 0.0);
  }
  if (vanishes(product)) return Kokkos::deep_copy(contact_lin, 0);
  space.share(product, moments);
  const auto part = moments;
  const auto out = contact_lin;
  Kokkos::parallel_for(
      "thixis::bound::contact_at_points", Kokkos::RangePolicy<>(0, owned), KOKKOS_LAMBDA(int K) {
        out(K) = 0;
        for (int l = 0; l < part.extent_int(1); ++l) out(K) += part(K, l);
      });
}

/// Where the method has its own fluxes: |lambda^ - Pi_q lambda_h^+|_K, lambda_h^+ the function with the moments M.
void BoundParts::compare_multipliers(const Vector& above) {
  if (patches) return;
  represent(above, positive, has_positive);
  if (const auto more = multiplier->held_moments(); has_positive && more.extent(0) > 0) {
    const auto all = moments;
    const Kokkos::RangePolicy<> cells_of_patches(0, patch_cells);
    Kokkos::parallel_for(
        "thixis::bound::held_moments", cells_of_patches, KOKKOS_LAMBDA(int k) {
          for (int l = 0; l < all.extent_int(1); ++l) all(k, l) += more(k, l);
        });
    Kokkos::parallel_for("thixis::bound::represent", cells_of_patches, Represent{moments, from_moments, positive});
  }
  if (!has_positive) return Kokkos::deep_copy(multiplier_rest, 0);
  const ConstCellTable exact = positive, ours = lambda;
  const auto det = metric;
  const auto out = multiplier_rest;
  Kokkos::parallel_for(
      "thixis::bound::compare_multipliers", Kokkos::RangePolicy<>(0, owned), KOKKOS_LAMBDA(int K) {
        double square = 0;
        for (int m = 0; m < ours.extent_int(1); ++m) square += (ours(K, m) - exact(K, m)) * (ours(K, m) - exact(K, m));
        out(K) = Kokkos::Experimental::sqrt(square / det(K).det);
      });
}

void BoundParts::fit_multiplier(const Iterate& iterate, Vector& above, Vector& cut_off) {
  split_multiplier(*iterate.lambda, above, cut_off);
  (*multiplier)(above, lambda, patch_lambda);
  Vector on_map(space.map());
  extend(above, on_map);
  compare_multipliers(on_map);
}

void BoundParts::find_worst_cells(complementarity::Estimate& eta) const {
  const double least = 1e-3 * eta.discretization / std::sqrt(static_cast<double>(mesh.global_cells));
  const auto disc = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), cells.discretization),
             lin = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), cells.linearization),
             alg = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), cells.algebraic);
  std::vector<double> worst(2, 0.0);
  for (LocalIndex K = 0; K < owned; ++K) {
    const double compared = std::max(disc(K), least);
    if (alg(K) > 0) worst[0] = std::max(worst[0], alg(K) / std::max(compared, lin(K)));
    if (lin(K) > 0) worst[1] = std::max(worst[1], lin(K) / compared);
  }
  comm.max(worst);
  eta.worst_algebraic = worst[0];
  eta.worst_linearization = worst[1];
}

std::size_t BoundParts::bytes() const {
  std::size_t tables = moments.size() + lambda.size() + positive.size() + patch_lambda.size() + patch_density.size() + patch_target.size();
  for (int alpha = 0; alpha < problem.count; ++alpha) {
    const Membrane& m = membrane[alpha];
    tables +=
        m.data.force.size() + m.w.size() + m.r_alg.size() + m.r_lin.size() + m.sigma_disc.size() + m.sigma_alg.size() + m.sigma_lin.size();
  }
  tables += owned * (10 + 4 * problem.count);  // parts and norms of cells
  return sizeof(double) * tables + lift.bytes() + feasible->bytes() + multiplier->bytes() + (patches ? patches->bytes() : 0);
}

}  // namespace thixis::bound
