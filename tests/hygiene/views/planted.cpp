/// What the check of Views has to find, line by line, and what it has to let pass.
#include "thixis/algebra/tpetra.hpp"

namespace thixis::algebra {

template <class T>
using HostView = typename Kokkos::View<T>::HostMirror;

struct Kernel {
  Kokkos::View<double*> x;
  KOKKOS_FUNCTION void operator()(int i) const { x(i) = helped(i) + x[i]; }
  KOKKOS_INLINE_FUNCTION double helped(int i) const { return x(i); }
  double looked_at(int i) const { return x(i); }  // found
};

struct Wide {
  double a, b, c, d, e, f;
  Kokkos::View<double*> x;
  KOKKOS_FUNCTION void operator()(int i) const { x(i) = a + b * c - d * e + f; }
};

struct Held {
  HostView<double*> named;
  Kokkos::View<double*>::HostMirror mirror;
  Kokkos::View<double*> view;
};

double read(const Kokkos::View<double*>& x, const HostView<double*>& named, const Held& held, Vector& v) {
  double sum = x(0);                                // found
  sum += x[0];                                      // found
  for (int i = 0; i < 3; ++i) sum += held.view(i);  // found
  const auto same = x;
  sum += same(0);  // found
  const auto of_vector = v.getLocalViewDevice(Tpetra::Access::ReadOnly);
  sum += of_vector(0, 0);                         // found
  const auto each = [&](int i) { return x(i); };  // found
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), x);
  const auto values = host_view(v);
  return sum + each(1) + host(0) + values(0) + named(0) + held.named(0) + held.mirror(0);
}

void launch(const Kokkos::View<double*>& x) {
  Kokkos::parallel_for("thixis::algebra::functor", 3, Kernel{x});
  Kokkos::parallel_for(
      "thixis::algebra::lambda", Kokkos::RangePolicy<>(0, 3), KOKKOS_LAMBDA(int i) { x(i) = 1; });
  const std::string label = "thixis::algebra::named";
  Kokkos::parallel_for(label, 3, Kernel{x});
  Kokkos::parallel_for(3, Kernel{x});  // found
  Wide wide;
  wide.a = wide.b = wide.c = wide.d = wide.e = wide.f = 0;
  wide.x = x;
  Kokkos::parallel_for("thixis::algebra::by_name", 3, wide);
  Kokkos::parallel_for("thixis::algebra::in_order", 3, Wide{0, 0, 0, 0, 0, 0, x});  // found
}

}  // namespace thixis::algebra
