#include "feasible/pair_on_mesh.hpp"
#include "feasible/way_kernels.hpp"

/// What the bound in time asks of the pair (docs/methods/parabolic_estimates.md).
namespace thixis::bound {
namespace {

/// Whether s_c has a gap below zero at a node of an owned cell.
bool any_below(const CellEntries& of_cells, const FeasiblePair::Continuous& s_c, LocalIndex cells) {
  int below = 0;
  const auto &above = s_c[0], &under = s_c[1];
  const int n = of_cells.extent_int(1);
  Kokkos::parallel_reduce(
      "thixis::bound::any_below", Kokkos::RangePolicy<>(0, cells),
      KOKKOS_LAMBDA(int K, int& found) {
        for (int l = 0; l < n; ++l) found = above(of_cells(K, l)) < under(of_cells(K, l)) ? 1 : found;
      },
      Kokkos::Max<int>(below));
  return below > 0;
}

}  // namespace

std::unique_ptr<FeasiblePair> FeasiblePair::at(double time) const {
  return std::unique_ptr<FeasiblePair>(new FeasiblePair(std::make_unique<Impl>(*impl_, time)));
}
double FeasiblePair::time() const { return impl_->problem.time; }

FeasiblePair::Continuous FeasiblePair::continuous(const method::Coefficients (&u)[2]) const {
  Continuous s_c = {u[0], impl_->problem.count == 2 ? View<const double*>(u[1]) : impl_->data[1]};
  for (int alpha = 0; impl_->averages && alpha < impl_->problem.count; ++alpha) {
    const auto average = impl_->at_nodes();
    (*impl_->averages)(u[alpha], impl_->data[alpha], average);
    s_c[alpha] = average;
  }
  return s_c;
}

FeasiblePair::Way FeasiblePair::way(const method::Coefficients (&u)[2], const Continuous& s_c) const {
  const method::Space& space = impl_->space;
  const LocalIndex cells = space.mesh().owned_cells;
  const int n = space.basis().size(), count = impl_->problem.count;
  const FeasibleParts& kernel = impl_->kernel;
  const bool averages = impl_->averages.has_value();
  const bool closes = space.mesh().comm.any(any_below(kernel.of_cells, s_c, cells));
  Way way;
  const auto table = [&] { return CellTable("thixis::bound::way", cells, n); };
  way.gap = table();
  for (int alpha = 0; alpha < count; ++alpha) {
    if (averages) way.averages[alpha] = table();
    if (closes) way.closing[alpha] = table();
  }
  WayOfCells of;
  of.of_cells = kernel.of_cells;
  of.of_cells_u = kernel.of_cells_u;
  of.theta = kernel.theta;
  of.apart[0] = kernel.apart[0];
  of.apart[1] = kernel.apart[1];
  of.functions = kernel.functions;
  of.modal = impl_->modal;
  of.count = count;
  of.upper = s_c[0];
  of.lower = s_c[1];
  of.u1 = u[0];
  of.u2 = u[1];
  of.averages1 = way.averages[0];
  of.averages2 = way.averages[1];
  of.closing1 = way.closing[0];
  of.closing2 = way.closing[1];
  of.gap = way.gap;
  Kokkos::parallel_for("thixis::bound::way", Kokkos::RangePolicy<>(0, cells), of);
  return way;
}

void FeasiblePair::contact(const Continuous& s_c, const ConstCellTable& lambda, int degree, const View<double*>& contact,
                           double small) const {
  FeasibleParts kernel = impl_->kernel;
  for (int alpha = 0; alpha < 2; ++alpha) kernel.s_c[alpha] = s_c[alpha];
  kernel.noise = impl_->noise(s_c);
  kernel.small = small;
  kernel.lambda = lambda;
  kernel.density.degree = degree;
  Kokkos::parallel_for(
      "thixis::bound::contact", Kokkos::RangePolicy<>(0, contact.extent(0)),
      KOKKOS_LAMBDA(int K) { contact(K) = kernel.contact_alone(K); });
}

View<double* [2]> FeasiblePair::change_of_lift(const FeasiblePair* before) const {
  return before == this ? View<double* [2]>() : impl_->lift->change(before ? before->impl_->lift.get() : nullptr);
}

void FeasiblePair::change_of_move(const CellTable& gap, const View<double* [2]>& change_of_lift, const FeasiblePair* before,
                                  const CellTable& gap_before, const View<double*>& size) const {
  NegativePartInTime of;
  of.now = impl_->kernel;
  of.then = before ? before->impl_->kernel : impl_->kernel;
  of.has_then = before != nullptr;
  of.gap = gap;
  of.gap_before = gap_before;
  of.change_of_lift = change_of_lift;
  of.size = size;
  Kokkos::parallel_for("thixis::bound::negative_part_in_time", Kokkos::RangePolicy<>(0, size.extent(0)), of);
}

}  // namespace thixis::bound
