#include "thixis/equilibration/guaranteed_bound.hpp"

#include <cmath>

#include "cut_oscillation.hpp"
#include "flux_sources.hpp"
#include "multiplier.hpp"
#include "sources.hpp"
#include "stress.hpp"
#include "tables.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/equilibration/feasible.hpp"
#include "thixis/equilibration/multilevel_flux.hpp"
#include "thixis/equilibration/patch_flux.hpp"
#include "thixis/mesh/ancestry.hpp"

namespace thixis::equilibration {
namespace {

using algebra::Vector;

/// What a cell may add to the square of the bound without being looked at more closely, relative to the mean flux term of cells: no more
/// than a hundredth of the whole in eta_disc, and 1e-4 of its square in the bound.
constexpr double negligible = 1e-4;

bool vanishes(const Vector& v) { return v.normInf() == 0; }

/// What belongs to one membrane.
struct Membrane {
  std::vector<double> least_tension;
  Sources data;
  std::unique_ptr<Stress> stress;
  CellTable w, r_alg, r_lin, sigma_disc, sigma_alg, sigma_lin;
  bool has_alg = false, has_lin = false;  ///< else r and sigma are 0
  Stress::Norms norms;
};

}  // namespace

struct GuaranteedBound::Impl {
  const method::PolynomialSpace& space;
  ContactProblem problem;
  const mesh::Mesh& mesh;
  core::Comm comm;
  int q, n, flux;
  LocalIndex owned, patch_cells;
  std::vector<bool> held;
  MultilevelFlux lift;
  FeasiblePair feasible;
  std::unique_ptr<NonNegativeMultiplier> multiplier;
  std::unique_ptr<PatchFlux> patches;
  Membrane membrane[2];
  Matrix from_moments;
  Kokkos::View<const double***, Kokkos::LayoutRight> times;
  Metrics metric;
  CellTable moments, lambda, positive, patch_lambda, patch_density, patch_target;
  View<double*> h, contact_lin, multiplier_rest;
  bool has_positive = false;
  FeasiblePair::Parts parts;
  CellParts cells;

  Impl(const method::PolynomialSpace& of, const ContactProblem& contact, const mesh::Hierarchy& hierarchy, int level)
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
        feasible(of, {contact.count, contact.tension, contact.boundary, contact.obstacle}),
        metric(metrics(mesh, of.cells())) {
    const auto table = [](const std::string& label, LocalIndex rows, int columns) { return CellTable(label, rows, columns); };
    const bool conforming = space.conforming();
    multiplier = conforming ? patchwise_multiplier(space) : cellwise_multiplier(space);
    if (conforming) {
      patches = std::make_unique<PatchFlux>(mesh, space.cells(), held, q);
      patch_lambda = table("thixis::equilibration::patch_lambda", patch_cells, 3 * n);
      patch_density = table("thixis::equilibration::patch_density", patch_cells, 3 * n);
      patch_target = table("thixis::equilibration::patch_target", patch_cells, 2 * n);
    } else {
      positive = table("thixis::equilibration::positive_multiplier", patch_cells, n);
    }
    moments = table("thixis::equilibration::moments", patch_cells, space.basis().size());
    lambda = table("thixis::equilibration::lambda", owned, n);
    const CutOscillation cut_cells(space, q, problem.interface);
    for (int alpha = 0; alpha < problem.count; ++alpha) {
      Membrane& m = membrane[alpha];
      m.least_tension = least_tension(space, *problem.tension[alpha]);
      m.data = sources(space, q, *problem.force[alpha], problem.boundary[alpha], &cut_cells, m.least_tension);
      m.stress = make_stress(space, q, *problem.tension[alpha], m.least_tension);
      m.w = table("thixis::equilibration::stress", patch_cells, 2 * n);
      m.r_alg = table("thixis::equilibration::r_alg", patch_cells, n);
      m.r_lin = table("thixis::equilibration::r_lin", patch_cells, n);
      m.sigma_disc = table("thixis::equilibration::sigma_disc", owned, flux);
      m.sigma_alg = table("thixis::equilibration::sigma_alg", owned, flux);
      m.sigma_lin = table("thixis::equilibration::sigma_lin", owned, flux);
      for (View<double*>* norm : {&m.norms.whole, &m.norms.disc, &m.norms.alg, &m.norms.lin})
        *norm = View<double*>("thixis::equilibration::flux_norm", owned);
    }
    const reference::Modal modal(space.basis().degree());
    const int functions = space.basis().size();
    from_moments = matrix("thixis::equilibration::from_moments", functions, functions, equilibration::from_moments(space.basis(), modal));
    times = times_hats(q);
    for (View<double*>* of_cells : {&h, &contact_lin, &multiplier_rest, &cells.discretization, &cells.linearization, &cells.algebraic})
      *of_cells = View<double*>("thixis::equilibration::of_cells", owned);
    const auto diameter = diameters(mesh);
    const auto h_host = Kokkos::create_mirror_view(h);
    std::copy(diameter.begin(), diameter.end(), h_host.data());
    Kokkos::deep_copy(h, h_host);
  }

  /// R as a polynomial in every patch cell. `has`: whether r is not 0, in and out.
  void represent(const Vector& R, const CellTable& r, bool& has) const {
    const bool had = has;
    has = !vanishes(R);
    if (!has) {
      if (had) Kokkos::deep_copy(r, 0);
      return;
    }
    space.share(R, moments);
    Kokkos::parallel_for("thixis::equilibration::represent", Kokkos::RangePolicy<>(0, patch_cells), Represent{moments, from_moments, r});
  }

  /// The residual, its representative and its lift.
  void lift_residual(const Vector& R, const CellTable& r, const CellTable& sigma, bool& has) const {
    const bool had = has;
    represent(R, r, has);
    if (has) lift(r, sigma);
    else if (had) Kokkos::deep_copy(sigma, 0);
  }

  void discretization_flux(const Iterate& iterate, int alpha) const {
    const Membrane& m = membrane[alpha];
    if (!patches)
      return space.native_flux(*problem.tension[alpha], *problem.force[alpha], iterate.u[alpha], problem.boundary[alpha], 0, m.sigma_disc);
    Kokkos::parallel_for(
        "thixis::equilibration::patch_data", Kokkos::RangePolicy<>(0, patch_cells),
        PatchSources{m.data.force, m.r_alg, m.r_lin, patch_lambda, m.w, alpha == 0 ? 1.0 : -1.0, times, patch_density, patch_target});
    (*patches)({patch_density, patch_target, m.data.traction}, m.sigma_disc);
  }

  /// The fluxes of a membrane and their norms.
  void equilibrate(const Iterate& iterate, int alpha, const Vector& cut_off) {
    Membrane& m = membrane[alpha];
    lift_residual(*iterate.residual[alpha], m.r_alg, m.sigma_alg, m.has_alg);
    lift_residual(cut_off, m.r_lin, m.sigma_lin, m.has_lin);
    (*m.stress)(iterate.u[alpha], m.w);
    discretization_flux(iterate, alpha);
    const auto if_any = [](bool has, const CellTable& sigma) { return has ? ConstCellTable(sigma) : ConstCellTable(); };
    m.stress->norms(iterate.u[alpha], m.w, {m.sigma_disc, if_any(m.has_alg, m.sigma_alg), if_any(m.has_lin, m.sigma_lin)}, m.norms);
  }

  /// The mean over all cells of sum_alpha |mu^{1/2} grad u_h + mu^{-1/2} sigma_alpha|²_K. Collective.
  double mean_flux_term() const {
    double sum = 0;
    for (int alpha = 0; alpha < problem.count; ++alpha) {
      double square = 0;
      const auto whole = membrane[alpha].norms.whole;
      Kokkos::parallel_reduce(
          "thixis::equilibration::flux_term", Kokkos::RangePolicy<>(0, owned),
          KOKKOS_LAMBDA(int K, double& of_cells) { of_cells += whole(K) * whole(K); }, square);
      sum += square;
    }
    return comm.sum(sum) / static_cast<double>(mesh.global_cells);
  }

  /// Values at contact points, 0 at other unknowns.
  void extend(const Vector& at_points, Vector& all) const {
    const auto in = algebra::host_view(at_points);
    const auto out = algebra::host_view(all);
    for (std::size_t l = 0; l < in.extent(0); ++l) out(l) = in(l);
  }

  /// M_l = D_l max(X3_l, 0) on points(), -D_l min(X3_l, 0) on map().
  void split_multiplier(const Vector& X3, Vector& above, Vector& below) const {
    const auto lambda_l = algebra::host_view(X3), D = algebra::host_view(space.pairing());
    const auto plus = algebra::host_overwrite(above);
    const auto minus = algebra::host_view(below);
    for (std::size_t l = 0; l < lambda_l.extent(0); ++l) {
      plus(l) = D(l) * std::max(lambda_l(l), 0.0);
      minus(l) = -D(l) * std::min(lambda_l(l), 0.0);
    }
  }

  /// sum_l M_l max(K_l, 0), shared out to the cells.
  void contact_at_points(const Vector& above, const Vector& gap) {
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
        "thixis::equilibration::contact_at_points", Kokkos::RangePolicy<>(0, owned), KOKKOS_LAMBDA(int K) {
          out(K) = 0;
          for (int l = 0; l < part.extent_int(1); ++l) out(K) += part(K, l);
        });
  }

  /// Where the method has its own fluxes: |lambda^ - Pi_q lambda_h^+|_K, lambda_h^+ the function with the moments M.
  void compare_multipliers(const Vector& above) {
    if (patches) return;
    represent(above, positive, has_positive);
    if (!has_positive) return Kokkos::deep_copy(multiplier_rest, 0);
    const ConstCellTable exact = positive, ours = lambda;
    const auto det = metric;
    const auto out = multiplier_rest;
    Kokkos::parallel_for(
        "thixis::equilibration::compare_multipliers", Kokkos::RangePolicy<>(0, owned), KOKKOS_LAMBDA(int K) {
          double square = 0;
          for (int m = 0; m < ours.extent_int(1); ++m) square += (ours(K, m) - exact(K, m)) * (ours(K, m) - exact(K, m));
          out(K) = Kokkos::Experimental::sqrt(square / det(K).det);
        });
  }

  complementarity::Estimate sum_up();
  void find_worst_cells(complementarity::Estimate& eta) const;
};

/// The bound, its parts, and those of every cell.
complementarity::Estimate GuaranteedBound::Impl::sum_up() {
  enum { of_flux, of_disc, of_alg, of_lin, of_whole, of_rest, of_nodes, contact, contact_nodes, count };
  std::vector<double> sum(count, 0.0);
  const auto on_host = [](const auto& v) { return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), v); };
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
  comm.sum(sum);
  complementarity::Estimate eta;
  eta.total = std::sqrt(sum[of_flux] + sum[of_whole] + 2 * sum[contact]);
  eta.discretization = std::sqrt(sum[of_disc]) + std::sqrt(sum[of_rest]) + std::sqrt(2 * std::abs(sum[contact] - sum[contact_nodes]));
  eta.linearization = std::sqrt(sum[of_lin]) + std::sqrt(sum[of_nodes]) + std::sqrt(2 * sum[contact_nodes]);
  eta.algebraic = std::sqrt(sum[of_alg]);
  find_worst_cells(eta);
  return eta;
}

/// Cells where the solution is exact have no discretization error to compare with: a thousandth of the mean one stands in for it.
void GuaranteedBound::Impl::find_worst_cells(complementarity::Estimate& eta) const {
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

GuaranteedBound::GuaranteedBound(const method::PolynomialSpace& space, const ContactProblem& problem, const mesh::Hierarchy& hierarchy,
                                 int level)
    : impl_(std::make_unique<Impl>(space, problem, hierarchy, level)) {}
GuaranteedBound::~GuaranteedBound() = default;

complementarity::Estimate GuaranteedBound::operator()(const Iterate& iterate) {
  Impl& in = *impl_;
  Vector above(in.space.points()), cut_off(in.space.map());
  in.split_multiplier(*iterate.lambda, above, cut_off);
  (*in.multiplier)(above, in.lambda, in.patch_lambda);
  Vector on_map(in.space.map());
  in.extend(above, on_map);
  in.compare_multipliers(on_map);
  for (int alpha = 0; alpha < in.problem.count; ++alpha) {
    in.equilibrate(iterate, alpha, cut_off);  // R_lin = (-1)^alpha D min(X3, 0)
    cut_off.scale(-1);
  }
  in.feasible.evaluate(iterate.u, in.lambda, in.q, in.parts, negligible * in.mean_flux_term());
  in.contact_at_points(above, *iterate.gap);
  return in.sum_up();
}

const GuaranteedBound::CellParts& GuaranteedBound::cells() const { return impl_->cells; }
int GuaranteedBound::flux_degree() const { return impl_->q; }

GuaranteedBound::Fluxes GuaranteedBound::fluxes(int alpha) const {
  const Impl& in = *impl_;
  const Membrane& m = in.membrane[alpha];
  const CellTable density("thixis::equilibration::density", in.owned, in.n);
  const ConstCellTable lambda = in.patches ? in.lambda : in.positive, force = m.data.force;
  const double sign = alpha == 0 ? 1 : -1;
  Kokkos::parallel_for(
      "thixis::equilibration::density", Kokkos::RangePolicy<>(0, in.owned), KOKKOS_LAMBDA(int K) {
        for (int k = 0; k < density.extent_int(1); ++k) density(K, k) = force(K, k) + sign * lambda(K, k);
      });
  return {m.sigma_disc, m.sigma_lin, m.sigma_alg, density, m.r_lin, m.r_alg};
}

std::size_t GuaranteedBound::bytes() const {
  const Impl& in = *impl_;
  std::size_t tables =
      in.moments.size() + in.lambda.size() + in.positive.size() + in.patch_lambda.size() + in.patch_density.size() + in.patch_target.size();
  for (int alpha = 0; alpha < in.problem.count; ++alpha) {
    const Membrane& m = in.membrane[alpha];
    tables +=
        m.data.force.size() + m.w.size() + m.r_alg.size() + m.r_lin.size() + m.sigma_disc.size() + m.sigma_alg.size() + m.sigma_lin.size();
  }
  tables += in.owned * (10 + 4 * in.problem.count);  // parts and norms of cells
  return sizeof(double) * tables + in.lift.bytes() + in.feasible.bytes() + in.multiplier->bytes() + (in.patches ? in.patches->bytes() : 0);
}

}  // namespace thixis::equilibration
