#include "thixis/method/transfer.hpp"

#include <algorithm>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/assert.hpp"
#include "transfer/parents.hpp"
#include "transfer/terms.hpp"
#include "transfer/transfer_kernels.hpp"

namespace thixis::method {
namespace {

using algebra::Vector;
using Range = Kokkos::RangePolicy<Vector::execution_space>;

/// The terms of each unknown of the space.
void set_terms(const Space& fine, Restriction& by) {
  const int of_cell = fine.components() * fine.basis().size();
  const Terms terms = terms_of(fine.elements(), algebra::local_size(*fine.map()), of_cell,
                               [&](LocalIndex k, int i) { return fine.layout().backwards(fine, k, (i - of_cell) / fine.components()); });
  by.begin = to_view("thixis::method::transfer_begin", terms.begin);
  by.cell = to_view("thixis::method::transfer_cell", terms.cell);
  by.place = to_view("thixis::method::transfer_place", terms.place);
}

}  // namespace

struct Transfer::Impl {
  const Space& coarse;
  const Space& fine;
  Parents parents;
  Restriction by;

  template <class X>
  void prolongate(const ElementEntries& source, const X& x, Vector& out) const {
    const auto values = out.getLocalViewDevice(Tpetra::Access::OverwriteAll);
    Kokkos::parallel_for("thixis::method::prolongate", Range(0, values.extent_int(0)),
                         Prolongate<X, std::decay_t<decltype(values)>>{by, source, x, values});
  }
};

Transfer::Transfer(const Space& coarse, const Space& fine) : impl_(new Impl{coarse, fine, Parents(coarse, fine), {}}) {
  THIXIS_ASSERT_EQ(fine.basis().size(), coarse.basis().size(), "levels have the same degree");
  impl_->by.components = fine.components();
  impl_->by.W = functionals_of_children(coarse.basis(), fine.basis(), fine.layout().trace_functionals());
  impl_->by.shape = impl_->parents.shape();
  impl_->by.parent = impl_->parents.parent();
  set_terms(fine, impl_->by);
}

Transfer::~Transfer() = default;

void Transfer::apply(const Vector& coarse, Vector& fine) const {
  const Vector ghosted = impl_->coarse.with_ghosts(coarse);
  const auto x = Kokkos::subview(ghosted.getLocalViewDevice(Tpetra::Access::ReadOnly), Kokkos::ALL, 0);
  const ElementEntries columns = impl_->coarse.elements();
  if (impl_->parents.in_place()) impl_->prolongate(columns, x, fine);
  else impl_->prolongate(impl_->parents.fetched(), impl_->parents.fetch(columns, x), fine);
}

void Transfer::apply_transpose(const Vector& fine, Vector& coarse) const {
  const Impl& in = *impl_;
  Vector ghosted(in.coarse.numbering().columns);
  {
    const auto r = fine.getLocalViewDevice(Tpetra::Access::ReadOnly);
    const auto x = Kokkos::subview(ghosted.getLocalViewDevice(Tpetra::Access::ReadWrite), Kokkos::ALL, 0);
    const ElementEntries columns = in.coarse.elements();
    if (in.parents.in_place()) {
      Kokkos::parallel_for("thixis::method::collect", Range(0, r.extent_int(0)),
                           Collect<std::decay_t<decltype(r)>, std::decay_t<decltype(x)>>{in.by, columns, r, x});
    } else {
      const Coefficients of_parents("thixis::method::of_parents", in.parents.fetched().size());
      Kokkos::parallel_for("thixis::method::collect", Range(0, r.extent_int(0)),
                           Collect<std::decay_t<decltype(r)>, Coefficients>{in.by, in.parents.fetched(), r, of_parents});
      in.parents.give_back(of_parents, columns, x);
    }
  }
  const auto import = in.coarse.graph()->getImporter();
  coarse.putScalar(0);
  if (import.is_null()) coarse.assign(ghosted);
  else coarse.doExport(ghosted, *import, Tpetra::ADD);
}

void Transfer::prolongate(const Coefficients& coarse_u, Vector& fine_u) const {
  const ElementEntries entries = impl_->coarse.coefficients().element_entries;
  if (impl_->parents.in_place()) impl_->prolongate(entries, coarse_u, fine_u);
  else impl_->prolongate(impl_->parents.fetched(), impl_->parents.fetch(entries, coarse_u), fine_u);
}

void Transfer::multiplier(const Vector& coarse_X3, Vector& fine_X3) const {
  const Impl& in = *impl_;
  const Coefficients lambda = in.coarse.multiplier(coarse_X3);
  if (in.fine.nodal_multiplier()) return prolongate(lambda, fine_X3);
  const int n = in.fine.basis().size();
  const LocalIndex count = in.fine.cells().extent_int(0);
  const ElementEntries entries = in.coarse.coefficients().element_entries;
  MomentsOfParents kernel;
  kernel.by = in.by;
  kernel.source = in.parents.in_place() ? entries : in.parents.fetched();
  kernel.x = in.parents.in_place() ? lambda : in.parents.fetch(entries, lambda);
  kernel.M = matrix_view("thixis::method::mass", n, n, in.fine.basis().mass());
  kernel.coordinates = in.fine.mesh().coordinates;
  kernel.vertices = in.fine.mesh().cell_vertices;
  kernel.cells = in.fine.cells();
  const Block2 local("thixis::method::moments", std::min(block_size, count), n);
  fine_X3.putScalar(0);
  for (kernel.first = 0; kernel.first < count; kernel.first += block_size) {
    kernel.F = Kokkos::subview(local, std::pair(0, std::min(block_size, count - kernel.first)), Kokkos::ALL);
    Kokkos::parallel_for("thixis::method::moments_of_parents", Range(0, kernel.F.extent_int(0)), kernel);
    scatter(in.fine.elements(), kernel.first, kernel.F, fine_X3);
  }
}

std::size_t Transfer::bytes() const {
  const Restriction& by = impl_->by;
  return sizeof(LocalIndex) * (by.shape.size() + by.parent.size() + by.begin.size() + by.cell.size() + impl_->parents.fetched().size()) +
         sizeof(int) * by.place.size();
}

}  // namespace thixis::method
