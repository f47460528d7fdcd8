#include "thixis/bound/published_bound.hpp"

#include <algorithm>
#include <cmath>

#include "data/sources.hpp"
#include "data/tension_bounds.hpp"
#include "estimate/square.hpp"
#include "estimate/sums.hpp"
#include "flux/discretization_flux.hpp"
#include "published/published_terms.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/bound/shares.hpp"
#include "thixis/mesh/ancestry.hpp"
#include "thixis/mesh/statistics.hpp"

namespace thixis::bound {
namespace {

using algebra::Vector;
using method::Coefficients;
constexpr double pi = 3.14159265358979323846;

struct OfPublished {
  enum { all, disc, alg, flux, residual, count };
};

/// Squares of what the flux of one membrane and its oscillation are.
struct PublishedFlux {
  View<const double*> whole, disc, alg, oscillation;
  KOKKOS_FUNCTION void operator()(int K, Sums<OfPublished>& sum) const {
    const double F = whole(K), R = oscillation(K);
    sum[OfPublished::all] += squared(F + R);
    sum[OfPublished::disc] += squared(disc(K) + R);
    sum[OfPublished::alg] += squared(alg(K));
    sum[OfPublished::flux] += squared(F);
    sum[OfPublished::residual] += squared(R);
  }
};

class Evaluation {
 public:
  Evaluation(const method::Space& space, const ContactProblem& problem, const Iterate& iterate, const Coefficients& gap, double friedrichs)
      : space_(space), problem_(problem), iterate_(iterate), gap_(gap), q_(space.flux_degree()) {
    double inverse = 0;
    for (int alpha = 0; alpha < problem.count; ++alpha) {
      double least = 1e300;
      for (const double mu : tension_bounds(space, *problem.tension[alpha]).least) least = std::min(least, mu);
      smallest_[alpha] = space.mesh().comm.min(least);
      inverse += 1 / smallest_[alpha];
    }
    constant_ = friedrichs * std::sqrt(inverse);
  }

  PublishedBound operator()(const mesh::Hierarchy& hierarchy, int level) {
    const Coefficients lambda = space_.multiplier(*iterate_.lambda);
    sum_fluxes(hierarchy, level, lambda);
    const double to_feasible = energy(closing(space_, gap_, space_.basis().to_bernstein())), at_nodes = energy(closing(space_, gap_));
    Vector cut_off(*iterate_.lambda, Teuchos::Copy);
    {
      const auto values = algebra::host_view(cut_off);
      for (std::size_t l = 0; l < values.extent(0); ++l) values(l) = std::min(values(l), 0.0);
    }
    const bool first = space_.basis().degree() == 1;
    const Coefficients negative_moments = space_.multiplier(cut_off);
    const Integrals over = integrals(space_, lambda, negative_moments, gap_);
    const double positive = std::sqrt(over.positive), step = first ? at_nodes : to_feasible;
    bound_.contact = std::sqrt(std::abs(2 * over.contact));
    bound_.nonconformity[0] = step;
    bound_.nonconformity[1] = constant_ * std::sqrt(over.negative);
    bound_.nonconformity[2] = 2 * constant_ * positive * step;
    auto& parts = bound_.parts;
    const double conforming = std::sqrt(sum_[OfPublished::all]) + bound_.nonconformity[0] + bound_.nonconformity[1];
    parts.total = std::sqrt(conforming * conforming + bound_.nonconformity[2] + 2 * over.contact);
    parts.algebraic = std::sqrt(sum_[OfPublished::alg]);
    if (first) {
      parts.discretization = std::sqrt(sum_[OfPublished::disc]) + bound_.contact;
      parts.linearization = bound_.nonconformity[0] + bound_.nonconformity[1] + std::sqrt(bound_.nonconformity[2]);
      return bound_;
    }
    const double between = energy(between_nodes()), root = std::sqrt(2 * constant_ * positive);
    const Integrals of_cut_off = integrals(space_, negative_moments, negative_moments, gap_);
    parts.discretization = std::sqrt(sum_[OfPublished::disc]) + std::sqrt(std::abs(2 * (over.contact - over.whole))) + between +
                           constant_ * std::sqrt(over.rest) + root * std::sqrt(between);
    parts.linearization = at_nodes + constant_ * std::sqrt(of_cut_off.positive + of_cut_off.negative) + root * std::sqrt(at_nodes) +
                          std::sqrt(std::abs(2 * over.whole));
    return bound_;
  }

 private:
  /// sigma = sigma_disc + sigma_alg, equilibrated with lambda_h itself.
  void sum_fluxes(const mesh::Hierarchy& hierarchy, int level, const Coefficients& lambda) {
    const mesh::Mesh& mesh = space_.mesh();
    const std::vector<bool> held = held_tags(problem_.boundary[0]);
    const CellShares shares(space_, q_);
    const ResidualLift lift(shares, mesh::ancestry(hierarchy, level), mesh.comm, held, q_);
    const DiscretizationFlux discretization(space_, q_, held);
    const FluxMultiplier multiplier{of_vertices(space_, lambda, q_), {}};
    for (int alpha = 0; alpha < problem_.count; ++alpha) {
      MembraneFlux of = make_membrane_flux(space_, q_, *problem_.tension[alpha], lift);
      of.data = sources(space_, q_, *problem_.force[alpha], problem_.boundary[alpha], problem_.time, nullptr, of.least_tension);
      lift(*iterate_.residual[alpha], of.alg);
      (*of.stress)(iterate_.u[alpha], of.w);
      discretization(problem_, iterate_.u[alpha], alpha, multiplier, {}, of);
      of.measure(iterate_.u[alpha]);
      const PublishedFlux terms{of.norms.whole, of.norms.disc, of.norms.alg, of.data.oscillation};
      sum_ += sum_over_cells<OfPublished>("thixis::bound::published_flux", mesh.owned_cells, terms);
    }
    sum_ = sum_.over(mesh.comm);
    bound_.flux = std::sqrt(sum_[OfPublished::flux]);
    bound_.residual = std::sqrt(sum_[OfPublished::residual]);
  }

  /// |||theta_1 c||| + … of both membranes giving way to close the gap by c.
  double energy(const Coefficients& c) const {
    if (problem_.count == 1) return std::sqrt(method::energy(*problem_.form[0], c));
    const auto theta = shares(smallest_[0], smallest_[1]).of_way;
    double sum = 0;
    for (int alpha = 0; alpha < 2; ++alpha) sum += theta[alpha] * theta[alpha] * method::energy(*problem_.form[alpha], c);
    return std::sqrt(sum);
  }

  /// From the gap closed at the nodes to the one closed everywhere.
  Coefficients between_nodes() const {
    const Coefficients nodes = closing(space_, gap_), everywhere = closing(space_, gap_, space_.basis().to_bernstein()),
                       difference("thixis::bound::between_nodes", gap_.extent(0));
    Kokkos::parallel_for(
        "thixis::bound::between_nodes", Kokkos::RangePolicy<>(0, gap_.extent_int(0)),
        KOKKOS_LAMBDA(int i) { difference(i) = everywhere(i) - nodes(i); });
    return difference;
  }

  const method::Space& space_;
  const ContactProblem& problem_;
  const Iterate& iterate_;
  const Coefficients& gap_;
  int q_;
  double smallest_[2] = {1, 1}, constant_ = 0;
  Sums<OfPublished> sum_;
  PublishedBound bound_;
};

}  // namespace

PublishedBound published_bound(const method::Space& space, const ContactProblem& problem, const mesh::Hierarchy& hierarchy, int level,
                               const Iterate& iterate, const Coefficients& gap, double friedrichs) {
  return Evaluation(space, problem, iterate, gap, friedrichs)(hierarchy, level);
}

double friedrichs_of_box(const mesh::Mesh& mesh) {
  const mesh::Box box = mesh::bounding_box(mesh);
  return 1 / (pi * std::hypot(1 / box.side(0), 1 / box.side(1)));
}

}  // namespace thixis::bound
