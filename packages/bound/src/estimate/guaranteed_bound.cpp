#include "thixis/bound/guaranteed_bound.hpp"

#include <cmath>

#include "estimate/bound_parts.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"

namespace thixis::bound {

using algebra::Vector;

struct GuaranteedBound::Impl : BoundParts {
  using BoundParts::BoundParts;

  /// The fluxes of a membrane and their norms.
  void equilibrate(const Iterate& iterate, int alpha, const Vector& cut_off) {
    Membrane& m = membrane[alpha];
    const double left =
        lift_residual(*iterate.residual[alpha], m.r_alg, m.sigma_alg, m.has_alg) + lift_residual(cut_off, m.r_lin, m.sigma_lin, m.has_lin);
    if (left > 0)
      throw core::InputError(
          "mesh: the error is not bounded where nothing holds a piece of the mesh; hold a part of its boundary, or leave the estimate "
          "out.");
    (*m.stress)(iterate.u[alpha], m.w);
    discretization_flux(iterate, alpha, {});
    measure(iterate.u[alpha], alpha);
  }

  complementarity::Estimate sum_up();
};

/// The bound, its parts, and those of every cell.
complementarity::Estimate GuaranteedBound::Impl::sum_up() {
  enum { of_flux, of_disc, of_alg, of_lin, of_whole, of_rest, of_nodes, contact, contact_nodes, at_points_only, count };
  std::vector<double> sum(count, 0.0);
  std::vector<double> disc_K(owned, 0.0), lin_K(owned, 0.0), alg_K(owned, 0.0);
  const auto h_K = on_host(h), rest_of_multiplier = on_host(multiplier_rest);
  for (int alpha = 0; alpha < problem.count; ++alpha) {
    const Membrane& m = membrane[alpha];
    const auto volume = on_host(m.data.sharp_oscillation), traction = on_host(m.data.traction_oscillation), all = on_host(m.norms.whole),
               disc = on_host(m.norms.disc), alg = on_host(m.norms.alg), lin = on_host(m.norms.lin);
    for (LocalIndex K = 0; K < owned; ++K) {
      const double of_lambda = patches ? 0 : poincare * h_K(K) * rest_of_multiplier(K) / std::sqrt(m.least_tension[K]);
      const double oscillation = volume(K) + of_lambda + traction(K);
      sum[of_flux] += (all(K) + oscillation) * (all(K) + oscillation);
      disc_K[K] += (disc(K) + oscillation) * (disc(K) + oscillation);
      alg_K[K] += alg(K) * alg(K);
      lin_K[K] += lin(K) * lin(K);
    }
  }
  const auto whole = on_host(parts.whole), rest = on_host(parts.rest), nodes = on_host(parts.at_nodes), together = on_host(parts.contact),
             at_points = on_host(contact_lin);
  const auto of_disc_K = Kokkos::create_mirror_view(cells.discretization), of_lin_K = Kokkos::create_mirror_view(cells.linearization),
             of_alg_K = Kokkos::create_mirror_view(cells.algebraic);
  for (LocalIndex K = 0; K < owned; ++K) {
    sum[of_disc] += disc_K[K];
    sum[of_alg] += alg_K[K];
    sum[of_lin] += lin_K[K];
    sum[of_whole] += whole(K) * whole(K);
    sum[of_rest] += rest(K) * rest(K);
    sum[of_nodes] += nodes(K) * nodes(K);
    sum[contact] += together(K);
    sum[contact_nodes] += at_points(K);
    of_disc_K(K) = std::sqrt(disc_K[K] + rest(K) * rest(K) + 2 * std::abs(together(K) - at_points(K)));
    of_lin_K(K) = std::sqrt(lin_K[K] + nodes(K) * nodes(K) + 2 * at_points(K));
    of_alg_K(K) = std::sqrt(alg_K[K]);
  }
  Kokkos::deep_copy(cells.discretization, of_disc_K);
  Kokkos::deep_copy(cells.linearization, of_lin_K);
  Kokkos::deep_copy(cells.algebraic, of_alg_K);
  sum[at_points_only] = parts.at_points ? 1 : 0;
  comm.sum(sum);
  complementarity::Estimate eta;
  eta.total = std::sqrt(sum[of_flux] + sum[of_whole] + 2 * sum[contact]);
  using complementarity::Promise;
  gap_at_points = sum[at_points_only] > 0;
  eta.promise = doubts.empty() && !gap_at_points ? Promise::guaranteed : Promise::up_to_quadrature;
  eta.discretization = std::sqrt(sum[of_disc]) + std::sqrt(sum[of_rest]) + std::sqrt(2 * std::abs(sum[contact] - sum[contact_nodes]));
  eta.linearization = std::sqrt(sum[of_lin]) + std::sqrt(sum[of_nodes]) + std::sqrt(2 * sum[contact_nodes]);
  eta.algebraic = std::sqrt(sum[of_alg]);
  find_worst_cells(eta);
  return eta;
}

GuaranteedBound::GuaranteedBound(const method::PolynomialSpace& space, const ContactProblem& problem, const mesh::Hierarchy& hierarchy,
                                 int level)
    : impl_(std::make_unique<Impl>(space, problem, hierarchy, level)) {}
GuaranteedBound::~GuaranteedBound() = default;

complementarity::Estimate GuaranteedBound::operator()(const Iterate& iterate) {
  Impl& in = *impl_;
  Vector above(in.space.points()), cut_off(in.space.map());
  in.fit_multiplier(iterate, above, cut_off);
  for (int alpha = 0; alpha < in.problem.count; ++alpha) {
    in.equilibrate(iterate, alpha, cut_off);  // R_lin = (-1)^alpha D min(X3, 0)
    cut_off.scale(-1);
  }
  in.feasible->evaluate(iterate.u, in.lambda, in.q, in.parts, negligible * in.mean_flux_term(), FeasiblePair::Gaps::pressed);
  in.contact_at_points(above, *iterate.gap);
  return in.sum_up();
}

const GuaranteedBound::CellParts& GuaranteedBound::cells() const { return impl_->cells; }
std::vector<std::string> GuaranteedBound::doubts() const {
  std::vector<std::string> all = impl_->doubts;
  if (impl_->gap_at_points) all.emplace_back("where membranes come near each other the gap is integrated at points");
  return all;
}
int GuaranteedBound::flux_degree() const { return impl_->q; }

GuaranteedBound::Fluxes GuaranteedBound::fluxes(int alpha) const {
  const Impl& in = *impl_;
  const BoundParts::Membrane& m = in.membrane[alpha];
  const CellTable density("thixis::bound::density", in.owned, in.n);
  const ConstCellTable lambda = in.patches ? in.lambda : in.positive, force = m.data.force;
  const double sign = alpha == 0 ? 1 : -1;
  Kokkos::parallel_for(
      "thixis::bound::density", Kokkos::RangePolicy<>(0, in.owned), KOKKOS_LAMBDA(int K) {
        for (int k = 0; k < density.extent_int(1); ++k) density(K, k) = force(K, k) + sign * lambda(K, k);
      });
  return {m.sigma_disc, m.sigma_lin, m.sigma_alg, density, m.r_lin, m.r_alg};
}

std::size_t GuaranteedBound::bytes() const { return impl_->bytes(); }

}  // namespace thixis::bound
