#include "estimate/bound_parts.hpp"

#include "data/cut_oscillation.hpp"
#include "estimate/exactness.hpp"
#include "estimate/square.hpp"
#include "thixis/mesh/ancestry.hpp"
#include "thixis/method/worst_cells.hpp"

namespace thixis::bound {

BoundParts::BoundParts(const method::Space& of, const ContactProblem& contact, const mesh::Hierarchy& hierarchy, int level)
    : space(of),
      problem(contact),
      q(of.flux_degree()),
      held(held_tags(contact.boundary[0])),
      feasible(std::make_shared<FeasiblePair>(
          of, FeasiblePair::Problem{contact.count, contact.tension, contact.boundary, contact.obstacle, contact.time})),
      metric(metrics(of.mesh(), of.cells())),
      shares(of, q),
      lift(shares, mesh::ancestry(hierarchy, level), of.mesh().comm, held, q),
      discretization(of, q, held),
      multiplier(of, q, feasible->jumps(), shares, metric),
      contact_lin("thixis::bound::contact_at_points", owned()) {
  bool proved[2] = {true, true};
  for (int alpha = 0; alpha < problem.count; ++alpha) {
    membrane[alpha] = make_membrane_flux(space, q, *problem.tension[alpha], lift);
    proved[alpha] = membrane[alpha].proved;
  }
  for (View<double*>* part : {&cells.discretization, &cells.linearization, &cells.algebraic})
    *part = View<double*>("thixis::bound::part_of_cells", owned());
  set_sources(problem.time);
  doubts = bound::doubts(space, problem, q, proved, *feasible);
}

void BoundParts::set_sources(double time) {
  problem.time = time;
  const CutOscillation cut_cells(space, q, problem.interface, time);
  for (int alpha = 0; alpha < problem.count; ++alpha)
    membrane[alpha].data =
        sources(space, q, *problem.force[alpha], problem.boundary[alpha], time, &cut_cells, membrane[alpha].least_tension);
}

void BoundParts::balance(const Iterate& iterate, int alpha, const ConstCellTable& rate) const {
  discretization(problem, iterate.u[alpha], alpha, multiplier.for_flux(), rate, membrane[alpha]);
}

double BoundParts::mean_flux_term() const {
  double sum = 0;
  for (int alpha = 0; alpha < problem.count; ++alpha) {
    double square = 0;
    const auto whole = membrane[alpha].norms.whole;
    Kokkos::parallel_reduce(
        "thixis::bound::flux_term", Kokkos::RangePolicy<>(0, owned()),
        KOKKOS_LAMBDA(int K, double& of_cells) { of_cells += squared(whole(K)); }, square);
    sum += square;
  }
  return comm().sum(sum) / static_cast<double>(space.mesh().global_cells);
}

FluxTerms::Cells BoundParts::empty_cells() const {
  for (const auto& part : {cells.discretization, cells.linearization, cells.algebraic}) Kokkos::deep_copy(part, 0);
  return {cells.discretization, cells.linearization, cells.algebraic};
}

CellTable BoundParts::balanced_density(int alpha) const {
  const CellTable density("thixis::bound::density", owned(), reference::dimension(q));
  const ConstCellTable lambda = multiplier.balanced(), force = membrane[alpha].data.force;
  const double sign = alpha == 0 ? 1 : -1;
  Kokkos::parallel_for(
      "thixis::bound::density", Kokkos::RangePolicy<>(0, owned()), KOKKOS_LAMBDA(int K) {
        for (int k = 0; k < density.extent_int(1); ++k) density(K, k) = force(K, k) + sign * lambda(K, k);
      });
  return density;
}

std::size_t BoundParts::bytes() const {
  std::size_t bytes = lift.bytes() + shares.bytes() + discretization.bytes() + multiplier.bytes() + feasible->bytes();
  for (int alpha = 0; alpha < problem.count; ++alpha) bytes += membrane[alpha].bytes();
  return bytes + sizeof(double) * owned() * 8;  // contact, parts of cells, of the pair
}

void find_worst_cells(const GuaranteedBound::CellParts& cells, const mesh::Mesh& mesh, complementarity::Estimate& eta) {
  const method::WorstCells worst =
      method::worst_cells({cells.discretization, cells.linearization, cells.algebraic}, eta.discretization, mesh.global_cells, mesh.comm);
  eta.worst_algebraic = worst.algebraic;
  eta.worst_linearization = worst.linearization;
}

}  // namespace thixis::bound
