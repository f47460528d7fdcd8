#include "thixis/bound/published_bound.hpp"

#include <algorithm>
#include <cmath>

#include "data/sources.hpp"
#include "data/tables.hpp"
#include "data/tension_bounds.hpp"
#include "flux/flux_sources.hpp"
#include "flux/stress.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/equilibration/multilevel_flux.hpp"
#include "thixis/equilibration/patch_flux.hpp"
#include "thixis/mesh/ancestry.hpp"
#include "thixis/mesh/statistics.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::bound {
namespace {

using algebra::Vector;
using method::Coefficients;
constexpr double pi = 3.14159265358979323846;

/// What belongs to vertex i of patch cell k: the density of lambda_h(a) psi_a for p = 1, of lambda_h psi_a otherwise.
CellTable of_vertices(const method::PolynomialSpace& space, const Coefficients& lambda, int q) {
  const auto& basis = space.basis();
  const int functions = basis.size(), n = reference::dimension(q);
  const reference::Modal modal(basis.degree());
  const auto T = matrix("thixis::bound::to_modal", functions, functions, to_modal(basis, modal));
  const auto times = times_hats(q);
  const auto metric = metrics(space.mesh(), space.cells());
  const auto entries = space.coefficients().element_entries;
  const CellTable density("thixis::bound::vertex_multiplier", space.cells().extent(0), 3 * n);
  const bool nodal = basis.degree() == 1;
  Kokkos::parallel_for(
      "thixis::bound::vertex_multiplier", Kokkos::RangePolicy<>(0, density.extent_int(0)), KOKKOS_LAMBDA(int k) {
        for (int i = 0; i < 3; ++i) {
          double c[reference::max_functions];
          for (int m = 0; m < functions; ++m) {
            c[m] = 0;
            for (int l = 0; l < functions; ++l) c[m] += T(m, l) * lambda(entries(k, nodal ? i : l));
          }
          for (int m = 0; m < n; ++m) {
            density(k, i * n + m) = 0;
            for (int j = 0; j < functions; ++j) density(k, i * n + m) += metric(k).det * times(i, m, j) * c[j];
          }
        }
      });
  return density;
}

/// Integrals over all cells of what two polynomials say, by a rule of high order: lambda and g, with more multipliers.
struct Integrals {
  double positive = 0, negative = 0;  ///< |lambda^pos|², |lambda^neg|²
  double rest = 0;                    ///< |lambda^neg - other|²
  double contact = 0, whole = 0;      ///< (lambda^pos, g), (lambda, g)
};

Integrals integrals(const method::PolynomialSpace& space, const Coefficients& lambda, const Coefficients& other, const Coefficients& gap) {
  const auto& basis = space.basis();
  const auto rule = reference::triangle_quadrature(reference::max_quadrature_order);
  const auto table = basis.tabulate(rule.size(), rule.point.data());
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.coefficients().element_entries);
  const auto metric = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), metrics(space.mesh(), space.cells()));
  const auto on_host = [](const Coefficients& v) { return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), v); };
  const auto l = on_host(lambda), o = on_host(other), g = on_host(gap);
  const int n = basis.size();
  std::vector<double> sum(5, 0.0);
  for (LocalIndex K = 0; K < space.mesh().owned_cells; ++K)
    for (int q = 0; q < rule.size(); ++q) {
      double value[3] = {0, 0, 0};
      for (int i = 0; i < n; ++i) {
        const double psi = table.value[q * n + i];
        const LocalIndex e = entries(K, i);
        value[0] += psi * l(e);
        value[1] += psi * o(e);
        value[2] += psi * g(e);
      }
      const double weight = rule.weight[q] * metric(K).det, above = std::max(value[0], 0.0), below = std::min(value[0], 0.0);
      sum[0] += weight * above * above;
      sum[1] += weight * below * below;
      sum[2] += weight * (below - value[1]) * (below - value[1]);
      sum[3] += weight * above * value[2];
      sum[4] += weight * value[0] * value[2];
    }
  space.mesh().comm.sum(sum);
  return {sum[0], sum[1], sum[2], sum[3], sum[4]};
}

/// What closing the gap adds to it: -min(·, 0) of its coefficients in this basis (matrix: coefficients -> those), back in the space.
Coefficients closing(const method::PolynomialSpace& space, const Coefficients& gap, const std::vector<double>& to) {
  const int n = space.basis().size();
  const auto from = reference::inverse(n, to);
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.coefficients().element_entries);
  const auto g = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), gap);
  const Coefficients closed("thixis::bound::closing", gap.extent(0));
  const auto out = Kokkos::create_mirror_view(closed);
  for (std::size_t k = 0; k < entries.extent(0); ++k) {
    double c[reference::max_functions] = {};
    for (int b = 0; b < n; ++b) {
      for (int l = 0; l < n; ++l) c[b] += to[b * n + l] * g(entries(k, l));
      c[b] = std::max(-c[b], 0.0);
    }
    for (int l = 0; l < n; ++l) {
      double value = 0;
      for (int b = 0; b < n; ++b) value += from[l * n + b] * c[b];
      out(entries(k, l)) = value;
    }
  }
  Kokkos::deep_copy(closed, out);
  return closed;
}

std::vector<double> identity(int n) {
  std::vector<double> I(n * n, 0.0);
  for (int i = 0; i < n; ++i) I[i * n + i] = 1;
  return I;
}

class Evaluation {
 public:
  Evaluation(const method::PolynomialSpace& space, const ContactProblem& problem, const Iterate& iterate, const Coefficients& gap,
             double friedrichs)
      : space_(space), problem_(problem), iterate_(iterate), gap_(gap), q_(space.flux_degree()) {
    double inverse = 0;
    for (int alpha = 0; alpha < problem.count; ++alpha) {
      tension_[alpha] = tension_bounds(space, *problem.tension[alpha]);
      double least = 1e300;
      for (const double mu : tension_[alpha].least) least = std::min(least, mu);
      smallest_[alpha] = space.mesh().comm.min(least);
      inverse += 1 / smallest_[alpha];
    }
    constant_ = friedrichs * std::sqrt(inverse);
  }

  PublishedBound operator()(const mesh::Hierarchy& hierarchy, int level) {
    const Coefficients lambda = space_.multiplier(*iterate_.lambda);
    sum_fluxes(hierarchy, level, lambda);
    const double to_feasible = energy(closing(space_, gap_, space_.basis().to_bernstein())),
                 at_nodes = energy(closing(space_, gap_, identity(space_.basis().size())));
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
    const double conforming = std::sqrt(sum_.all) + bound_.nonconformity[0] + bound_.nonconformity[1];
    parts.total = std::sqrt(conforming * conforming + bound_.nonconformity[2] + 2 * over.contact);
    parts.algebraic = std::sqrt(sum_.alg);
    if (first) {
      parts.discretization = std::sqrt(sum_.disc) + bound_.contact;
      parts.linearization = bound_.nonconformity[0] + bound_.nonconformity[1] + std::sqrt(bound_.nonconformity[2]);
      return bound_;
    }
    const double between = energy(between_nodes()), root = std::sqrt(2 * constant_ * positive);
    const Integrals of_cut_off = integrals(space_, negative_moments, negative_moments, gap_);
    parts.discretization = std::sqrt(sum_.disc) + std::sqrt(std::abs(2 * (over.contact - over.whole))) + between +
                           constant_ * std::sqrt(over.rest) + root * std::sqrt(between);
    parts.linearization = at_nodes + constant_ * std::sqrt(of_cut_off.positive + of_cut_off.negative) + root * std::sqrt(at_nodes) +
                          std::sqrt(std::abs(2 * over.whole));
    return bound_;
  }

 private:
  /// sigma = sigma_disc + sigma_alg, equilibrated with lambda_h itself.
  void sum_fluxes(const mesh::Hierarchy& hierarchy, int level, const Coefficients& lambda) {
    const mesh::Mesh& mesh = space_.mesh();
    const LocalIndex cells = space_.cells().extent_int(0), owned = mesh.owned_cells;
    const int n = reference::dimension(q_), flux = 2 * reference::dimension(q_ + 1), functions = space_.basis().size();
    const std::vector<bool> held = held_tags(problem_.boundary[0]);
    const equilibration::MultilevelFlux lift(mesh::ancestry(hierarchy, level), mesh.comm, held, q_);
    const equilibration::PatchFlux patches(mesh, space_.cells(), held, q_);
    const reference::Modal modal(space_.basis().degree());
    const auto from = matrix("thixis::bound::from_moments", functions, functions, from_moments(space_.basis(), modal));
    const CellTable moments("thixis::bound::moments", cells, functions), r("thixis::bound::r", cells, n),
        none("thixis::bound::none", cells, n), w("thixis::bound::stress", cells, 2 * n),
        density("thixis::bound::patch_density", cells, 3 * n), target("thixis::bound::patch_target", cells, 2 * n),
        disc("thixis::bound::sigma_disc", owned, flux), alg("thixis::bound::sigma_alg", owned, flux);
    const CellTable of_lambda = of_vertices(space_, lambda, q_);
    const View<double*> all_K("thixis::bound::all", owned), disc_K("thixis::bound::disc", owned), alg_K("thixis::bound::alg", owned),
        lin_K("thixis::bound::lin", owned);
    std::vector<double> sum(5, 0.0);
    for (int alpha = 0; alpha < problem_.count; ++alpha) {
      const Sources data =
          sources(space_, q_, *problem_.force[alpha], problem_.boundary[alpha], problem_.time, nullptr, tension_[alpha].least);
      const auto stress = make_stress(space_, q_, *problem_.tension[alpha], tension_[alpha]);
      space_.share(*iterate_.residual[alpha], moments);
      Kokkos::parallel_for("thixis::bound::represent", Kokkos::RangePolicy<>(0, cells), Represent{moments, from, r});
      lift(r, alg);
      (*stress)(iterate_.u[alpha], w);
      Kokkos::parallel_for("thixis::bound::patch_data", Kokkos::RangePolicy<>(0, cells),
                           PatchSources{data.force, {}, r, none, of_lambda, w, alpha == 0 ? 1.0 : -1.0, times_hats(q_), density, target});
      patches({density, target, data.traction}, disc);
      stress->norms(iterate_.u[alpha], w, {disc, alg, {}}, {all_K, disc_K, alg_K, lin_K});
      const auto on_host = [](const auto& v) { return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), v); };
      const auto F = on_host(all_K), D = on_host(disc_K), A = on_host(alg_K), R = on_host(data.oscillation);
      for (LocalIndex K = 0; K < owned; ++K) {
        sum[0] += (F(K) + R(K)) * (F(K) + R(K));
        sum[1] += (D(K) + R(K)) * (D(K) + R(K));
        sum[2] += A(K) * A(K);
        sum[3] += F(K) * F(K);
        sum[4] += R(K) * R(K);
      }
    }
    mesh.comm.sum(sum);
    sum_ = {sum[0], sum[1], sum[2]};
    bound_.flux = std::sqrt(sum[3]);
    bound_.residual = std::sqrt(sum[4]);
  }

  /// |||theta_1 c||| + … of both membranes giving way to close the gap by c.
  double energy(const Coefficients& c) const {
    if (problem_.count == 1) return std::sqrt(space_.energy(*problem_.tension[0], c));
    double sum = 0;
    for (int alpha = 0; alpha < 2; ++alpha) {
      const double theta = smallest_[1 - alpha] / (smallest_[0] + smallest_[1]);
      sum += theta * theta * space_.energy(*problem_.tension[alpha], c);
    }
    return std::sqrt(sum);
  }

  /// From the gap closed at the nodes to the one closed everywhere.
  Coefficients between_nodes() const {
    const Coefficients nodes = closing(space_, gap_, identity(space_.basis().size())),
                       everywhere = closing(space_, gap_, space_.basis().to_bernstein()),
                       difference("thixis::bound::between_nodes", gap_.extent(0));
    Kokkos::parallel_for(
        "thixis::bound::between_nodes", Kokkos::RangePolicy<>(0, gap_.extent_int(0)),
        KOKKOS_LAMBDA(int i) { difference(i) = everywhere(i) - nodes(i); });
    return difference;
  }

  const method::PolynomialSpace& space_;
  const ContactProblem& problem_;
  const Iterate& iterate_;
  const Coefficients& gap_;
  int q_;
  TensionBounds tension_[2];
  double smallest_[2] = {1, 1}, constant_ = 0;
  struct {
    double all, disc, alg;
  } sum_{};
  PublishedBound bound_;
};

}  // namespace

PublishedBound published_bound(const method::PolynomialSpace& space, const ContactProblem& problem, const mesh::Hierarchy& hierarchy,
                               int level, const Iterate& iterate, const Coefficients& gap, double friedrichs) {
  return Evaluation(space, problem, iterate, gap, friedrichs)(hierarchy, level);
}

double friedrichs_of_box(const mesh::Mesh& mesh) {
  const mesh::Box box = mesh::bounding_box(mesh);
  return 1 / (pi * std::hypot(1 / box.side(0), 1 / box.side(1)));
}

}  // namespace thixis::bound
