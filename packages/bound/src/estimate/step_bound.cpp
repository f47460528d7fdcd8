#include "thixis/bound/step_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "data/change_of_force.hpp"
#include "data/tables.hpp"
#include "estimate/bound_parts.hpp"
#include "estimate/exactness.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/bound/published_bound.hpp"
#include "thixis/core/error.hpp"

namespace thixis::bound {
namespace {

using algebra::Vector;
using method::Coefficients;

double squared(double x) { return x * x; }

/// Of ∫_0^1 |(1 - theta) a + theta b|² where |a|, |b| are known: exact where one is a multiple of the other.
double mean_square(double a, double b) { return (a * a + a * b + b * b) / 3; }

/// b(theta) = 4 theta (1 - theta), which is what data that are not affine in time add: ∫ b, ∫ b², ∫ b'² over ]0, 1[.
constexpr double bulge_mean = 2.0 / 3, bulge_square = 8.0 / 15, bulge_rate = 16.0 / 3;

/// Densities of (u - before)/tau on the patch cells.
struct Rate {
  Kokkos::View<const LocalIndex**, Kokkos::LayoutRight> entries;
  Coefficients u, before;
  Matrix modal;  ///< (m, l)
  Metrics metric;
  double tau;
  CellTable rate;  ///< out, overwritten
  KOKKOS_FUNCTION void operator()(int k) const {
    const int n = modal.extent_int(0);
    double c[reference::max_functions];
    for (int l = 0; l < n; ++l) c[l] = (u(entries(k, l)) - before(entries(k, l))) * (metric(k).det / tau);
    for (int m = 0; m < n; ++m) {
      rate(k, m) = 0;
      for (int l = 0; l < n; ++l) rate(k, m) += modal(m, l) * c[l];
    }
  }
};

bool steady(const std::vector<scene::FieldPtr>& fields) {
  for (const auto& field : fields)
    if (field && !field->steady()) return false;
  return true;
}

}  // namespace

struct StepBound::Impl : BoundParts {
  std::optional<double> friedrichs;
  bool steady_force = true, steady_boundary = true;
  double least[2] = {1, 1};  ///< tension of all
  Matrix modal;              ///< (m, l): modal coefficients of the basis functions
  int functions;

  // the step
  double first = 0, last = 0;
  Coefficients before[2];
  CellTable w_before[2];
  std::shared_ptr<const FeasiblePair> feasible_before;
  FeasiblePair::Continuous s_c_before;
  FeasiblePair::Way way_before;
  CellTable moved_before[2];  ///< (u_h - s_N)(t_{n-1}), functions of degree p; of length 0: zero
  CellTable sigma_before[2];  ///< conforming spaces: its flux; of length 0: zero
  FeasiblePair::Parts parts_before;
  FeasiblePair::Bulge bulge;
  View<double* [2]> change_of_lift;
  double force_change[2] = {0, 0};  ///< ∫ |f(t) - f(t_n)|²
  bool resolved = true;             ///< ForceChange

  // the last iterate
  Iterate iterate;
  FeasiblePair::Way way;
  CellTable rate[2], remaining, extra;
  double left_disc[2] = {0, 0}, left_alg[2] = {0, 0}, left_lin[2] = {0, 0};  ///< norms of means that no flux takes away
  bool has_cut_off[2] = {false, false};
  View<double*> change[2], contact_before, move_change;
  struct Square {
    double energy = 0, remainder = 0;  ///< G², and R: the norm in L1(L2) of what no flux balances
    double bound() const { return remainder + std::sqrt(remainder * remainder + energy); }
  } step;
  complementarity::Estimate eta;
  std::array<double, 3> parts_of_step;  ///< discretization, linearization, algebraic without the remainder
  Errors errors_of_step;

  // since the start
  Square all;
  double disc2 = 0, lin2 = 0, alg2 = 0, time2 = 0;
  complementarity::Promise promise = complementarity::Promise::guaranteed;  ///< the weakest of all steps
  std::vector<std::string> at_start;                                        ///< what keeps the error at time 0 from being exact

  Impl(const method::PolynomialSpace& of, const ContactProblem& contact, const mesh::Hierarchy& hierarchy, int level,
       std::optional<double> constant)
      : BoundParts(of, contact, hierarchy, level), friedrichs(constant), functions(of.basis().size()) {
    if (!patches && q == space.basis().degree())
      throw core::InputError("scene/model: there is no bound in time for this method; write fem or hho under method/name.");
    const bool all_held = std::all_of(held.begin(), held.end(), [](bool is) { return is; });
    if (friedrichs && std::none_of(held.begin(), held.end(), [](bool is) { return is; }))
      throw core::InputError("stopping/friedrichs constant: there is none where nothing is held; leave it out.");
    if (!friedrichs && all_held) friedrichs = friedrichs_of_box(mesh);
    for (int alpha = 0; alpha < problem.count; ++alpha) {
      steady_force = steady_force && problem.force[alpha]->steady();
      steady_boundary = steady_boundary && steady(problem.boundary[alpha].dirichlet);
      if (!problem.tension[alpha]->steady() || !steady(problem.boundary[alpha].neumann))
        throw core::InputError("scene/data: the bound in time needs tensions and tractions that do not depend on t.");
      double lowest = 1e300;
      for (const double mu : membrane[alpha].least_tension) lowest = std::min(lowest, mu);
      least[alpha] = comm.min(lowest);
      rate[alpha] = CellTable("thixis::bound::rate", patch_cells, functions);
      change[alpha] = View<double*>("thixis::bound::change_in_step", owned);
      w_before[alpha] = CellTable("thixis::bound::stress_before", patch_cells, 2 * n);
    }
    const reference::Modal orthonormal(space.basis().degree());
    modal = matrix("thixis::bound::to_modal", functions, functions, to_modal(space.basis(), orthonormal));
    remaining = CellTable("thixis::bound::remaining", owned, functions);
    extra = CellTable("thixis::bound::extra_flux", owned, flux);
    contact_before = View<double*>("thixis::bound::contact_before", owned);
    move_change = View<double*>("thixis::bound::move_change", owned);
  }

  double tau() const { return last - first; }

  /// What keeps the bound of the step from being guaranteed.
  std::vector<std::string> all_doubts() const {
    std::vector<std::string> clauses = doubts;
    for (auto& clause : doubts_in_time(problem, feasible_before ? *feasible_before : *feasible, *feasible))
      clauses.push_back(std::move(clause));
    return clauses;
  }

  std::shared_ptr<const FeasiblePair> pair_at(double time) const {
    if (steady_boundary || feasible->time() == time) return feasible;
    return feasible->at(time);
  }

  /// `remaining`(K, ·) = factor det (a + b) for the tables that are not of length 0; false where both are.
  bool density_of(double factor, const CellTable& a, double other, const CellTable& b) const {
    if (a.extent(0) == 0 && b.extent(0) == 0) return false;
    const auto det = metric;
    const CellTable out = remaining;
    Kokkos::parallel_for(
        "thixis::bound::density_of_way", Kokkos::RangePolicy<>(0, owned), KOKKOS_LAMBDA(int K) {
          for (int m = 0; m < out.extent_int(1); ++m) {
            double sum = 0;
            if (a.extent(0) > 0) sum += factor * a(K, m);
            if (b.extent(0) > 0) sum += other * b(K, m);
            out(K, m) = det(K).det * sum;
          }
        });
    return true;
  }

  void add(const CellTable& sigma, const CellTable& to) const {
    Kokkos::parallel_for(
        "thixis::bound::add_flux", Kokkos::RangePolicy<>(0, owned), KOKKOS_LAMBDA(int K) {
          for (int i = 0; i < to.extent_int(1); ++i) to(K, i) += sigma(K, i);
        });
  }

  void equilibrate(int alpha, const Vector& cut_off);
  double oscillation_of_rate(int alpha, LocalIndex K) const;
  void sum_up();
  /// |u_alpha - s_alpha|: |u_h - s_N| + |L| + |what is moved apart|.
  std::array<double, 2> distance(double time, const Coefficients (&u)[2]);
};

/// sigma_disc + sigma_lin + sigma_alg in equilibrium with f(t_n) - ∂_t s_N and lambda^, and |mu^{1/2} grad (u_h^n - u_h^{n-1})|_K.
void StepBound::Impl::equilibrate(int alpha, const Vector& cut_off) {
  Membrane& m = membrane[alpha];
  left_alg[alpha] = lift_residual(*iterate.residual[alpha], m.r_alg, m.sigma_alg, m.has_alg);
  left_lin[alpha] = 0;
  represent(cut_off, m.r_lin, has_cut_off[alpha]);
  if (density_of(1 / tau(), way.closing[alpha], 0, {})) {
    const CellTable sum = remaining, r_lin = m.r_lin;
    Kokkos::parallel_for(
        "thixis::bound::add_cut_off", Kokkos::RangePolicy<>(0, owned), KOKKOS_LAMBDA(int K) {
          for (int i = 0; i < r_lin.extent_int(1); ++i) sum(K, i) += r_lin(K, i);
        });
    left_lin[alpha] = lift(sum, m.sigma_lin);
    m.has_lin = true;
  } else {
    m.has_lin = has_cut_off[alpha];
    if (m.has_lin) left_lin[alpha] = lift(m.r_lin, m.sigma_lin);
    else Kokkos::deep_copy(m.sigma_lin, 0);
  }

  Kokkos::parallel_for("thixis::bound::rate", Kokkos::RangePolicy<>(0, patch_cells),
                       Rate{space.coefficients().element_entries, iterate.u[alpha], before[alpha], modal, metric, tau(), rate[alpha]});
  (*m.stress)(iterate.u[alpha], m.w);
  discretization_flux(iterate, alpha, rate[alpha]);
  if (patches) {
    if (sigma_before[alpha].extent(0) > 0) add(sigma_before[alpha], m.sigma_disc);
  } else {
    left_disc[alpha] = 0;
    if (density_of(1 / tau(), way.averages[alpha], -1 / tau(), moved_before[alpha])) {
      left_disc[alpha] = lift(remaining, extra);
      add(extra, m.sigma_disc);
    }
  }

  m.stress->norms_between(iterate.u[alpha], m.w, before[alpha], w_before[alpha], fluxes(alpha), m.norms, change[alpha]);
}

/// (h_K/j) mu^{-1/2} |(1 - Pi_q) ∂_t s_N|_K: 0 in conforming spaces, whose fluxes are of degree p.
double StepBound::Impl::oscillation_of_rate(int alpha, LocalIndex K) const {
  double square = 0;
  for (int m = n; m < functions; ++m) {
    double value = rate[alpha](K, m) / metric(K).det;
    if (way.averages[alpha].extent(0) > 0) value -= way.averages[alpha](K, m) / tau();
    if (way.closing[alpha].extent(0) > 0) value -= way.closing[alpha](K, m) / tau();
    if (moved_before[alpha].extent(0) > 0) value += moved_before[alpha](K, m) / tau();
    square += value * value;
  }
  return poincare * h(K) * std::sqrt(square * metric(K).det / membrane[alpha].least_tension[K]);
}

void StepBound::Impl::sum_up() {
  enum {
    of_flux,
    of_disc,
    at_end,
    of_change,
    of_alg,
    of_lin,
    of_pair,
    of_rest,
    rest_at_end,
    of_nodes,
    contact,
    contact_then,
    contact_nodes,
    of_bulge,
    moved,
    lift_1,
    lift_2,
    bulge_1,
    bulge_2,
    force_1,
    force_2,
    count
  };
  std::vector<double> sum(count, 0.0);
  std::vector<double> disc_K(owned, 0.0), lin_K(owned, 0.0), alg_K(owned, 0.0);
  const bool bulges = bulge.energy.extent(0) > 0, lift_changes = change_of_lift.extent(0) > 0;
  const auto apart = feasible->apart();
  const double length = tau();
  for (int alpha = 0; alpha < problem.count; ++alpha) {
    const Membrane& m = membrane[alpha];
    for (LocalIndex K = 0; K < owned; ++K) {
      const double of_lambda = patches ? 0 : poincare * h(K) * multiplier_rest(K) / std::sqrt(m.least_tension[K]);
      const double oscillation =
          m.data.sharp_oscillation(K) + of_lambda + m.data.traction_oscillation(K) + (patches ? 0 : oscillation_of_rate(alpha, K));
      // ∫_0^1 |a + (theta - 1) b|² = |a - b/2|² + |b|²/12
      const double b2 = squared(change[alpha](K)) / 12;
      sum[of_flux] += squared(std::sqrt(squared(m.norms.whole(K)) + b2) + oscillation);
      disc_K[K] += squared(std::sqrt(squared(m.norms.disc(K)) + b2) + oscillation);
      sum[of_change] += 4 * b2;
      alg_K[K] += squared(m.norms.alg(K));
      lin_K[K] += squared(m.norms.lin(K));
    }
    if (alpha == 0) sum[force_1] = force_change[0];
    else sum[force_2] = force_change[1];
  }
  for (LocalIndex K = 0; K < owned; ++K) {
    const double more = bulges ? std::sqrt(bulge_square) * bulge.energy(K) : 0;
    const double pair = squared(std::sqrt(mean_square(parts_before.whole(K), parts.whole(K))) + more),
                 rest = squared(std::sqrt(mean_square(parts_before.whole(K), parts.rest(K))) + more),
                 nodes = squared(parts.at_nodes(K)) / 3;
    double of_bulge_K = 0;
    for (int m = 0; bulges && m < std::min(n, functions); ++m) of_bulge_K += lambda(K, m) * bulge.gap(K, m);
    sum[of_disc] += disc_K[K];
    sum[of_alg] += alg_K[K];
    sum[of_lin] += lin_K[K];
    sum[of_pair] += pair;
    sum[of_rest] += rest;
    sum[rest_at_end] += squared(parts.rest(K));
    sum[of_nodes] += nodes;
    sum[contact] += parts.contact(K);
    sum[contact_then] += contact_before(K);
    sum[contact_nodes] += contact_lin(K);
    sum[of_bulge] += of_bulge_K;
    sum[moved] += squared(move_change(K));
    for (int alpha = 0; alpha < problem.count; ++alpha) {
      if (lift_changes) sum[lift_1 + alpha] += squared(change_of_lift(K, alpha));
      if (bulges) sum[bulge_1 + alpha] += squared(bulge.size(K, alpha));
    }
    const double together = parts.contact(K) + contact_before(K) + 2 * bulge_mean * of_bulge_K;
    double unbalanced = 0;
    for (int alpha = 0; friedrichs && alpha < problem.count; ++alpha)
      unbalanced += squared(*friedrichs * apart[alpha] * move_change(K)) / least[alpha];
    cells.discretization(K) = std::sqrt(length * (disc_K[K] + rest + std::abs(together - contact_lin(K))) + unbalanced / length);
    cells.linearization(K) = std::sqrt(length * (lin_K[K] + nodes + contact_lin(K)));
    cells.algebraic(K) = std::sqrt(length * alg_K[K]);
  }
  comm.sum(sum);

  double remainder2 = 0, remainder_disc2 = 0, balanced2 = 0, of_time2 = 0;
  for (int alpha = 0; alpha < problem.count; ++alpha) {
    const double of_force = std::sqrt(sum[force_1 + alpha]);
    const double rho =
        of_force + (std::sqrt(sum[lift_1 + alpha]) + apart[alpha] * std::sqrt(sum[moved]) + std::sqrt(bulge_rate * sum[bulge_1 + alpha])) /
                       std::sqrt(length);
    const double factor = friedrichs ? *friedrichs * *friedrichs / least[alpha] : 0;
    balanced2 += factor * squared(rho);
    of_time2 += (friedrichs ? factor : 4 * length) * squared(of_force);
    const double unbalanced = (friedrichs ? 0 : std::sqrt(length) * rho) + length * left_disc[alpha];
    remainder2 += squared(unbalanced + length * (left_lin[alpha] + left_alg[alpha]));
    remainder_disc2 += squared(unbalanced);
  }
  const double N = std::sqrt(balanced2), R = std::sqrt(remainder2), R_disc = std::sqrt(remainder_disc2);
  const double together = std::max(0.0, sum[contact] + sum[contact_then] + 2 * bulge_mean * sum[of_bulge]);
  step.energy = squared(std::sqrt(length * sum[of_flux]) + N) + length * (sum[of_pair] + together);
  step.remainder = R;
  eta = {};
  eta.evident = space.conforming();  // the proof is for continuous elements
  eta.total = step.bound();
  eta.promise = all_doubts().empty() ? complementarity::Promise::guaranteed : complementarity::Promise::up_to_quadrature;
  parts_of_step = {
      std::sqrt(length * sum[of_disc]) + N + std::sqrt(length * sum[of_rest]) + std::sqrt(length * std::abs(together - sum[contact_nodes])),
      std::sqrt(length * sum[of_lin]) + std::sqrt(length * sum[of_nodes]) + std::sqrt(length * sum[contact_nodes]),
      std::sqrt(length * sum[of_alg])};
  eta.discretization = parts_of_step[0] + 2 * R_disc;
  eta.linearization = parts_of_step[1] + 2 * length * std::hypot(left_lin[0], left_lin[1]);
  eta.algebraic = parts_of_step[2] + 2 * length * std::hypot(left_alg[0], left_alg[1]);
  find_worst_cells(eta);
  errors_of_step.time = std::sqrt(length * sum[of_change]) + std::sqrt(of_time2) + std::sqrt(length * std::max(0.0, sum[contact_then]));
  eta.time = errors_of_step.time;
  errors_of_step.space = std::max(0.0, N + 2 * R_disc - std::sqrt(of_time2)) + std::sqrt(length * sum[rest_at_end]) +
                         std::sqrt(length * std::abs(sum[contact] - sum[contact_nodes]));
}

std::array<double, 2> StepBound::Impl::distance(double time, const Coefficients (&u)[2]) {
  feasible = pair_at(time);
  const auto to_nodes = feasible->way(u, feasible->continuous(u));
  const auto lifted = feasible->change_of_lift(nullptr);
  const auto apart = feasible->apart();
  feasible->change_of_move(to_nodes.gap, {}, nullptr, {}, move_change);
  std::array<double, 2> norm = {0, 0};
  for (int alpha = 0; alpha < problem.count; ++alpha) {
    double way2 = 0, rest2 = 0;
    for (LocalIndex K = 0; K < owned; ++K) {
      for (int m = 0; m < functions; ++m) {
        double value = 0;
        if (to_nodes.averages[alpha].extent(0) > 0) value += to_nodes.averages[alpha](K, m);
        if (to_nodes.closing[alpha].extent(0) > 0) value += to_nodes.closing[alpha](K, m);
        way2 += metric(K).det * value * value;
      }
      rest2 += squared(apart[alpha] * move_change(K) + (lifted.extent(0) > 0 ? lifted(K, alpha) : 0));
    }
    norm[alpha] = std::sqrt(comm.sum(way2)) + std::sqrt(comm.sum(rest2));
  }
  return norm;
}

StepBound::StepBound(const method::PolynomialSpace& space, const ContactProblem& problem, const mesh::Hierarchy& hierarchy, int level,
                     std::optional<double> friedrichs)
    : impl_(std::make_unique<Impl>(space, problem, hierarchy, level, friedrichs)) {}
StepBound::~StepBound() = default;

/// |u_0 - s| <= |u_0 - u_h| + |u_h - s|.
void StepBound::start(double time, const Coefficients (&u)[2], const std::array<scene::FieldPtr, 2>& initial) {
  Impl& in = *impl_;
  const auto distance = in.distance(time, u);
  double square = 0;
  for (int alpha = 0; alpha < in.problem.count; ++alpha)
    square += squared(distance[alpha] + (initial[alpha] ? std::sqrt(in.space.l2_error(u[alpha], *initial[alpha], time)) : 0));
  in.at_start.clear();
  for (int alpha = 0; alpha < in.problem.count; ++alpha)
    if (initial[alpha])
      for (auto& clause : doubts_at_start(in.space, alpha, *initial[alpha])) in.at_start.push_back(std::move(clause));
  in.promise = in.at_start.empty() ? complementarity::Promise::guaranteed : complementarity::Promise::up_to_quadrature;
  in.all = {square, 0};
  in.disc2 = square;
  in.lin2 = in.alg2 = in.time2 = 0;
}

/// y jumps by J at most: |y + J|² <= |y|² + 2 |y| J + J².
void StepBound::take_over(const StepBound& coarse, double time, const Coefficients (&coarse_u)[2], const Coefficients (&u)[2]) {
  Impl& in = *impl_;
  Impl& from = *coarse.impl_;
  const auto there = from.distance(time, coarse_u), here = in.distance(time, u);
  const double jump = std::hypot(there[0], there[1]) + std::hypot(here[0], here[1]) + from.pair_at(time)->change_by_interpolation();
  in.all = {from.all.energy + jump * jump, from.all.remainder + jump};
  in.disc2 = from.disc2 + jump * jump;
  in.lin2 = from.lin2;
  in.alg2 = from.alg2;
  in.time2 = from.time2;
  in.promise = from.promise;
  in.at_start = from.at_start;
}

void StepBound::begin(double begin, double end, const Coefficients (&before)[2]) {
  Impl& in = *impl_;
  in.first = begin;
  in.last = end;
  for (int alpha = 0; alpha < in.problem.count; ++alpha) {
    in.before[alpha] = before[alpha];
    (*in.membrane[alpha].stress)(before[alpha], in.w_before[alpha]);
  }
  // the pair at the begin: made from `before` alone, so that a run that goes on from a checkpoint makes the same
  in.feasible_before = in.pair_at(begin);
  in.feasible = in.feasible_before;
  in.feasible = in.pair_at(end);
  const FeasiblePair& then = *in.feasible_before;
  in.s_c_before = then.continuous(before);
  in.way_before = then.way(before, in.s_c_before);
  then.evaluate(before, CellTable("thixis::bound::no_multiplier", in.owned, 0), in.q, in.parts_before);
  for (int alpha = 0; alpha < in.problem.count; ++alpha) {
    in.moved_before[alpha] = in.sigma_before[alpha] = {};
    in.left_disc[alpha] = 0;
    const auto &averages = in.way_before.averages[alpha], &closing = in.way_before.closing[alpha];
    if (averages.extent(0) > 0 && closing.extent(0) > 0) {
      Kokkos::parallel_for(
          "thixis::bound::moved_before", Kokkos::RangePolicy<>(0, in.owned), KOKKOS_LAMBDA(int K) {
            for (int m = 0; m < closing.extent_int(1); ++m) averages(K, m) += closing(K, m);
          });
    }
    in.moved_before[alpha] = averages.extent(0) > 0 ? averages : closing;
    if (in.patches && in.density_of(-1 / in.tau(), in.moved_before[alpha], 0, {})) {
      in.sigma_before[alpha] = CellTable("thixis::bound::sigma_before", in.owned, in.flux);
      in.left_disc[alpha] = in.lift(in.remaining, in.sigma_before[alpha]);
    }
  }
  in.change_of_lift = in.feasible->change_of_lift(&then);
  in.bulge = {};
  if (!in.steady_boundary) in.bulge = in.feasible->at(0.5 * (begin + end))->bulge(then, *in.feasible);
  if (in.steady_force) return;
  if (in.problem.time != end) in.set_sources(end);
  in.resolved = true;
  for (int alpha = 0; alpha < in.problem.count; ++alpha) {
    const auto [square, resolved] = change_of_force(in.space, *in.problem.force[alpha], begin, end);
    in.force_change[alpha] = square;
    in.resolved = in.resolved && resolved;
  }
}

complementarity::Estimate StepBound::operator()(const Iterate& iterate) {
  Impl& in = *impl_;
  in.iterate = iterate;
  Vector above(in.space.points()), cut_off(in.space.map());
  in.fit_multiplier(iterate, above, cut_off);
  in.way = in.feasible->way(iterate.u, in.feasible->continuous(iterate.u));
  for (int alpha = 0; alpha < in.problem.count; ++alpha) {
    in.equilibrate(alpha, cut_off);  // R_lin = (-1)^alpha D min(X3, 0)
    cut_off.scale(-1);
  }
  const double small = negligible * in.mean_flux_term();
  in.feasible->evaluate(iterate.u, in.lambda, in.q, in.parts, small);
  in.feasible_before->contact(in.s_c_before, in.lambda, in.q, in.contact_before, small);
  in.feasible->change_of_move(in.way.gap, in.change_of_lift, in.feasible_before.get(), in.way_before.gap, in.move_change);
  in.contact_at_points(above, *iterate.gap);
  Kokkos::fence();
  in.sum_up();
  return in.eta;
}

bool StepBound::resolved() const { return impl_->resolved; }

std::vector<std::string> StepBound::doubts() const {
  std::vector<std::string> all = impl_->all_doubts();
  all.insert(all.end(), impl_->at_start.begin(), impl_->at_start.end());
  return all;
}
const GuaranteedBound::CellParts& StepBound::cells() const { return impl_->cells; }

/// sum_up() has all of it but the flux at the end of the step.
StepBound::Errors StepBound::errors() {
  Impl& in = *impl_;
  double square = 0;
  for (int alpha = 0; alpha < in.problem.count; ++alpha) {
    in.measure(in.iterate.u[alpha], alpha);
    const auto& m = in.membrane[alpha];
    for (LocalIndex K = 0; K < in.owned; ++K) {
      const double of_lambda = in.patches ? 0 : poincare * in.h(K) * in.multiplier_rest(K) / std::sqrt(m.least_tension[K]);
      square += squared(m.norms.disc(K) + m.data.sharp_oscillation(K) + of_lambda + m.data.traction_oscillation(K) +
                        (in.patches ? 0 : in.oscillation_of_rate(alpha, K)));
    }
  }
  Errors errors = in.errors_of_step;
  errors.space += std::sqrt(in.tau() * in.comm.sum(square));
  return errors;
}

void StepBound::accept() {
  Impl& in = *impl_;
  in.all.energy += in.step.energy;
  in.all.remainder += in.step.remainder;
  in.disc2 += squared(in.parts_of_step[0]);
  in.lin2 += squared(in.parts_of_step[1]);
  in.alg2 += squared(in.parts_of_step[2]);
  in.time2 += squared(in.errors_of_step.time);
  in.promise = weakest(in.promise, in.eta.promise);
}

complementarity::Estimate StepBound::so_far() const {
  const Impl& in = *impl_;
  complementarity::Estimate eta;
  eta.total = in.all.bound();
  eta.discretization = std::sqrt(in.disc2) + 2 * in.all.remainder;
  eta.linearization = std::sqrt(in.lin2);
  eta.algebraic = std::sqrt(in.alg2);
  eta.time = std::sqrt(in.time2);
  eta.promise = in.promise;
  return eta;
}

const std::vector<std::string>& StepBound::names_of_sums() {
  static const std::vector<std::string> names = {"bound",           "bound_remainder", "bound_discretization", "bound_linearization",
                                                 "bound_algebraic", "bound_time",      "bound_promise"};
  return names;
}

std::map<std::string, double> StepBound::sums() const {
  const Impl& in = *impl_;
  const double values[] = {in.all.energy, in.all.remainder, in.disc2, in.lin2, in.alg2, in.time2, static_cast<double>(in.promise)};
  std::map<std::string, double> sums;
  for (std::size_t i = 0; i < names_of_sums().size(); ++i) sums[names_of_sums()[i]] = values[i];
  return sums;
}

void StepBound::restore(const std::map<std::string, double>& sums) {
  Impl& in = *impl_;
  double promise = 0;
  double* const values[] = {&in.all.energy, &in.all.remainder, &in.disc2, &in.lin2, &in.alg2, &in.time2, &promise};
  for (std::size_t i = 0; i < names_of_sums().size(); ++i) *values[i] = sums.at(names_of_sums()[i]);
  in.promise = static_cast<complementarity::Promise>(promise);
}

GuaranteedBound::Fluxes StepBound::fluxes(int alpha) const {
  const Impl& in = *impl_;
  const auto& m = in.membrane[alpha];
  const CellTable density("thixis::bound::density", in.owned, in.n), lin("thixis::bound::residual_lin", in.owned, in.n);
  const double sign = alpha == 0 ? 1 : -1;
  const CellTable lambda = in.patches ? in.lambda : in.positive;
  for (LocalIndex K = 0; K < in.owned; ++K)
    for (int k = 0; k < in.n; ++k) {
      const auto part = [&](const CellTable& way) { return way.extent(0) > 0 ? in.metric(K).det * way(K, k) / in.tau() : 0; };
      density(K, k) = m.data.force(K, k) + sign * lambda(K, k) - in.rate[alpha](K, k) + part(in.way.averages[alpha]) +
                      part(in.way.closing[alpha]) - part(in.moved_before[alpha]);
      lin(K, k) = m.r_lin(K, k) + part(in.way.closing[alpha]);
    }
  return {m.sigma_disc, m.sigma_lin, m.sigma_alg, density, lin, m.r_alg};
}

int StepBound::flux_degree() const { return impl_->q; }

std::size_t StepBound::bytes() const {
  const Impl& in = *impl_;
  std::size_t tables = in.remaining.size() + in.extra.size() + in.way.gap.size() + in.way_before.gap.size() + 6 * in.owned;
  for (int alpha = 0; alpha < in.problem.count; ++alpha)
    tables += in.rate[alpha].size() + in.w_before[alpha].size() + in.way.averages[alpha].size() + in.way.closing[alpha].size() +
              in.moved_before[alpha].size() + in.sigma_before[alpha].size() + in.before[alpha].size();
  return in.BoundParts::bytes() + sizeof(double) * tables;
}

}  // namespace thixis::bound
