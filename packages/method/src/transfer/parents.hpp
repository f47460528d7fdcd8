#pragma once
#include <vector>

#include "kernels/polynomial_kernels.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/mesh/to_view.hpp"

namespace thixis::method {

using mesh::to_view;

/// The parents of the patch cells of a space, with the coefficients that a function of the coarse space has there: read in place where all
/// parents belong to the same rank, on every rank; else fetched from their owners, who alone know a multiplier of moments there.
class Parents {
 public:
  /// Collective.
  Parents(const Space& coarse, const Space& fine);

  const View<LocalIndex*>& shape() const { return shape_; }    ///< of each patch cell
  const View<LocalIndex*>& parent() const { return parent_; }  ///< in place: the coarse patch cell; else the row of fetched()
  bool in_place() const { return import_.is_null(); }
  /// (parent, i) -> position in what is fetched.
  const ElementEntries& fetched() const { return fetched_; }

  /// Of the parents, from x at `source` of the owned cells, 0 where that is -1. Collective.
  template <class X>
  Coefficients fetch(const ElementEntries& source, const X& x) const {
    algebra::MultiVector own(import_->getSourceMap(), width_);
    {
      const auto out = own.getLocalViewDevice(Tpetra::Access::OverwriteAll);
      const int n = width_;
      Kokkos::parallel_for(
          "thixis::method::of_own_cells", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int K) {
            for (int i = 0; i < n; ++i) out(K, i) = source(K, i) < 0 ? 0 : x(source(K, i));
          });
    }
    return from_owners(own);
  }

  /// The transpose of that: x += at `source` of the owned cells. Collective.
  template <class X>
  void give_back(const Coefficients& values, const ElementEntries& source, const X& x) const {
    const algebra::MultiVector own = to_owners(values);
    const auto in = own.getLocalViewDevice(Tpetra::Access::ReadOnly);
    const int n = width_;
    Kokkos::parallel_for(
        "thixis::method::from_children", Range(0, in.extent_int(0)), KOKKOS_LAMBDA(int K) {
          for (int i = 0; i < n; ++i)
            if (source(K, i) >= 0) Kokkos::atomic_add(&x(source(K, i)), in(K, i));
        });
  }

 private:
  using Range = Kokkos::RangePolicy<algebra::Vector::execution_space>;

  void set_import(const mesh::Mesh& coarse, const std::vector<GlobalIndex>& parents);
  Coefficients from_owners(const algebra::MultiVector& own) const;
  algebra::MultiVector to_owners(const Coefficients& values) const;

  int width_;  ///< coefficients of a cell
  View<LocalIndex*> shape_, parent_;
  Teuchos::RCP<const algebra::Import> import_;  ///< cells of the coarse mesh, by owner -> parents of cells here
  ElementEntries fetched_;
};

}  // namespace thixis::method
