#include "feasible/pressing.hpp"

#include <algorithm>
#include <cmath>

#include "data/tables.hpp"
#include "feasible/pressing_kernels.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/method/layout.hpp"

namespace thixis::bound {
namespace {

using algebra::MultiVector;

/// Functions with a smaller share of the cell say nothing about a constant multiplier.
constexpr double no_mean = 1e-3;

/// ∫ max(v, 0) of a polynomial in Bernstein coefficients over the reference triangle, by the midpoints of equal parts.
double positive_part(const reference::Bernstein& B, const double* c) {
  constexpr int sides = 48;
  double sum = 0;
  const auto add = [&](double xi, double eta) {
    const double lambda[3] = {1 - xi - eta, xi, eta};
    sum += std::max(B.value(c, lambda), 0.0) / (2.0 * sides * sides);
  };
  for (int i = 0; i < sides; ++i)
    for (int j = 0; i + j < sides; ++j) {
      add((i + 1.0 / 3) / sides, (j + 1.0 / 3) / sides);
      if (i + j + 1 < sides) add((i + 2.0 / 3) / sides, (j + 2.0 / 3) / sides);
    }
  return sum;
}

using Range = Kokkos::RangePolicy<MultiVector::execution_space>;

/// Launches a kernel that adds to the columns, over the owned cells.
template <template <class> class Kernel, class Fill>
void over_cells(const char* label, const mesh::Mesh& mesh, MultiVector& columns, Fill fill) {
  const auto sums = columns.getLocalViewDevice(Tpetra::Access::ReadWrite);
  Kernel<std::decay_t<decltype(sums)>> kernel;
  kernel.sums = sums;
  fill(kernel);
  Kokkos::parallel_for(std::string(label), Range(0, mesh.owned_cells), kernel);
}

auto read(const MultiVector& columns) { return columns.getLocalViewDevice(Tpetra::Access::ReadOnly); }

KOKKOS_INLINE_FUNCTION double ratio(double gain, double cost) { return cost > 0 && gain > 0 ? gain / cost : 0; }

}  // namespace

Pressing::Pressing(const method::Space& space, const FeasibleParts& kernel, const std::vector<bool>& dirichlet,
                   const std::vector<bool>& keeps)
    : mesh_(space.mesh()) {
  const reference::CellBasis& basis = space.basis();
  const bool functions = std::abs(basis.integrals()[basis.interior()]) < no_mean / basis.size();
  const bool deviates = mesh_.comm.any(kernel.deviation.place.extent(0) > 0);
  if (!functions && !deviates) return;
  std::vector<GlobalIndex> own_ids;
  for (LocalIndex v = 0; v < mesh_.vertices; ++v)
    if (mesh_.vertex_owner[v] == mesh_.comm.rank()) own_ids.push_back(mesh_.vertex_id[v]);
  import_ = Teuchos::rcp(new algebra::Import(algebra::map_of(own_ids, mesh_.comm), algebra::map_of(mesh_.vertex_id, mesh_.comm)));
  if (functions) integrate_functions(basis, kernel, dirichlet);
  if (deviates) integrate_deviation(kernel, keeps);
}

Pressing::~Pressing() = default;

void Pressing::add_up(MultiVector& columns) const {
  MultiVector own(import_->getSourceMap(), columns.getNumVectors());
  own.doExport(columns, *import_, Tpetra::ADD);
  columns.doImport(own, *import_, Tpetra::INSERT);
}

void Pressing::integrate_functions(const reference::CellBasis& basis, const FeasibleParts& kernel, const std::vector<bool>& dirichlet) {
  double hat[3][reference::max_functions];
  for (int i = 0; i < 3; ++i) {
    double unit[reference::max_functions] = {};
    unit[kernel.first_vertex + i] = 1;
    basis.to_bernstein(unit, hat[i]);
    positive_[i] = 2 * positive_part(kernel.functions.B, hat[i]);
  }
  MultiVector columns(import_->getTargetMap(), 1);
  over_cells<SumStiffness>("thixis::bound::sum_stiffness", mesh_, columns, [&](auto& of) {
    of.parts = kernel;
    std::copy(&hat[0][0], &hat[0][0] + 3 * reference::max_functions, &of.hat[0][0]);
  });
  add_up(columns);
  closed_ = View<double*>("thixis::bound::closed", mesh_.vertices);
  stiffness_ = View<double*>("thixis::bound::stiffness", mesh_.vertices);
  const auto held = to_view("thixis::bound::held_vertices", method::held_vertices(mesh_, dirichlet));
  const auto stiffness = stiffness_;
  const auto sums = read(columns);
  Kokkos::parallel_for(
      "thixis::bound::stiffness", Range(0, mesh_.vertices), KOKKOS_LAMBDA(LocalIndex v) { stiffness(v) = held(v) >= 0 ? 0 : sums(v, 0); });
}

void Pressing::integrate_deviation(const FeasibleParts& kernel, const std::vector<bool>& keeps) {
  place_ = kernel.deviation.place;
  mean_of_positive_ = View<double*>("thixis::bound::mean_of_positive", kernel.deviation.bound.extent(0));
  MultiVector columns(import_->getTargetMap(), 2);
  {
    const auto kept = Kokkos::subview(columns.getLocalViewHost(Tpetra::Access::ReadWrite), Kokkos::ALL, 1);
    std::copy(keeps.begin(), keeps.end(), kept.data());
  }
  over_cells<SumDeviation>("thixis::bound::sum_deviation", mesh_, columns, [&](auto& of) {
    of.parts = kernel;
    of.mean_of_positive = mean_of_positive_;
  });
  add_up(columns);
  followed_ = View<double*>("thixis::bound::followed", mesh_.vertices);
  cost_ = View<double*>("thixis::bound::cost", mesh_.vertices);
  const auto cost = cost_;
  const auto sums = read(columns);
  Kokkos::parallel_for(
      "thixis::bound::cost", Range(0, mesh_.vertices), KOKKOS_LAMBDA(LocalIndex v) { cost(v) = sums(v, 1) > 0 ? 0 : sums(v, 0); });
}

void Pressing::operator()(const FeasibleParts& kernel) {
  if (import_.is_null()) return;
  MultiVector columns(import_->getTargetMap(), 4);
  over_cells<SumForces>("thixis::bound::sum_forces", mesh_, columns, [&](auto& of) {
    of.parts = kernel;
    std::copy(positive_, positive_ + 3, of.positive);
    of.place = place_;
    of.mean_of_positive = mean_of_positive_;
    of.closes = closed_.extent(0) > 0;
  });
  add_up(columns);
  const auto sums = read(columns);
  const auto closed = closed_, stiffness = stiffness_, followed = followed_, cost = cost_;
  Kokkos::parallel_for(
      "thixis::bound::pressing", Range(0, mesh_.vertices), KOKKOS_LAMBDA(LocalIndex v) {
        if (closed.extent(0) > 0) closed(v) = sums(v, 2) > 0 ? 0 : ratio(sums(v, 0), 2 * stiffness(v));
        if (followed.extent(0) == 0) return;
        const double part = ratio(sums(v, 1), cost(v));
        followed(v) = sums(v, 3) > 0 ? 0 : part < 1 ? part : 1;
      });
}

std::size_t Pressing::bytes() const {
  return sizeof(double) * (stiffness_.size() + mean_of_positive_.size() + cost_.size() + closed_.size() + followed_.size());
}

}  // namespace thixis::bound
