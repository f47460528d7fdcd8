#include "krylov/krylov_iterate.hpp"

namespace thixis::algebra {

namespace {

/// x = V y, by blocks of rows that stay in the cache while the basis runs by.
template <class Basis, class Out>
struct Combine {
  static constexpr int block = 512;
  Basis V;
  Kokkos::View<const double*> y;
  int k;  ///< columns
  Out x;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int b) const {
    const int begin = b * block, end = begin + block < x.extent_int(0) ? begin + block : x.extent_int(0);
    for (int l = begin; l < end; ++l) x(l, 0) = 0;
    for (int j = 0; j < k; ++j)
      for (int l = begin; l < end; ++l) x(l, 0) += y(j) * V(l, j);
  }
};

void combine(const MultiVector& V, const Kokkos::View<const double*>& y, int k, Vector& x) {
  const auto basis = V.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto out = x.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  using Kernel = Combine<std::decay_t<decltype(basis)>, std::decay_t<decltype(out)>>;
  const int blocks = (out.extent_int(0) + Kernel::block - 1) / Kernel::block;
  Kokkos::parallel_for("thixis::algebra::combine", Kokkos::RangePolicy<Node::execution_space>(0, blocks), Kernel{basis, y, k, out});
}

}  // namespace

void KrylovIterate::solve_triangle(const Dense& R, const Dense& z, int k) {
  if (y_host_.extent_int(0) < R.numCols()) {
    y_ = Kokkos::View<double*>("thixis::algebra::krylov_coefficients", R.numCols());
    y_host_ = Kokkos::create_mirror_view(y_);
  }
  double* y = y_host_.data();
  for (int i = k - 1; i >= 0; --i) {
    y[i] = z(i, 0);
    for (int j = i + 1; j < k; ++j) y[i] -= R(i, j) * y[j];
    y[i] /= R(i, i);
  }
  Kokkos::deep_copy(y_, y_host_);
}

Teuchos::RCP<const MultiVector> KrylovIterate::operator()(const MultiVector& x, const Operator* inverse, const MultiVector& V,
                                                          const Dense& R, const Dense& z, int k) {
  if (formed_.is_null() || !formed_->getMap()->isSameAs(*x.getMap())) {
    formed_ = Teuchos::rcp(new Vector(x.getMap()));
    combined_ = inverse ? Teuchos::rcp(new Vector(x.getMap())) : formed_;
  }
  solve_triangle(R, z, k);
  combine(V, y_, k, *combined_);
  if (inverse) inverse->apply(*combined_, *formed_);
  formed_->update(1, x, 1);
  return formed_;
}

}  // namespace thixis::algebra
