#include "thixis/algebra/tpetra.hpp"
#include "thixis/contact/system.hpp"

namespace thixis::contact {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using Range = Kokkos::RangePolicy<Vector::execution_space>;

/// Columns on `map` that lie one behind the other.
MultiVector columns_at(const double* begin, const algebra::MapPtr& map, int columns) {
  using View = MultiVector::dual_view_type::t_dev;
  return MultiVector(map, View(const_cast<double*>(begin), algebra::local_size(*map), columns));
}
const double* begin(const Vector& x) { return x.getLocalViewDevice(Tpetra::Access::ReadOnly).data(); }
double* begin(Vector& x) { return x.getLocalViewDevice(Tpetra::Access::ReadWrite).data(); }

LocalIndex end_of_fields(const System& system) { return system.fields() * algebra::local_size(*system.map()); }

}  // namespace

algebra::MapPtr map_of_gaps(const System& system) {
  if (system.gaps() == 1) return system.points();
  return algebra::contiguous_map(system.gaps() * algebra::local_size(*system.points()), algebra::comm_of(*system.map()));
}

algebra::MapPtr map_of_all(const System& system) {
  return algebra::contiguous_map(end_of_fields(system) + system.gaps() * algebra::local_size(*system.points()),
                                 algebra::comm_of(*system.map()));
}

MultiVector fields(const System& system, const Vector& X) { return columns_at(begin(X), system.map(), system.fields()); }
MultiVector fields_nonconst(const System& system, Vector& X) { return columns_at(begin(X), system.map(), system.fields()); }
MultiVector multipliers(const System& system, const Vector& X) {
  return columns_at(begin(X) + end_of_fields(system), system.points(), system.gaps());
}
MultiVector multipliers_nonconst(const System& system, Vector& X) {
  return columns_at(begin(X) + end_of_fields(system), system.points(), system.gaps());
}
MultiVector gaps(const System& system, const Vector& K) { return columns_at(begin(K), system.points(), system.gaps()); }
MultiVector gaps_nonconst(const System& system, Vector& K) { return columns_at(begin(K), system.points(), system.gaps()); }

void gap(const System& system, const MultiVector& u, MultiVector& K) {
  const auto of_fields = u.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto out = K.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const auto node = system.constraint.node;
  const auto frames = system.constraint.frames;
  const int m = system.fields(), q = system.gaps();
  Kokkos::parallel_for(
      "thixis::contact::gap", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int p) {
        const LocalIndex l = node(p);
        const Small& Q = frames.inverse(frames.at(l));
        for (int g = 0; g < q; ++g) {
          double sum = 0;
          for (int i = 0; i < m; ++i) sum += Q(m - q + g, i) * of_fields(l, i);
          out(p, g) = sum;
        }
      });
  if (!system.constraint.offset.is_null()) K.update(1, *system.constraint.offset, 1);
}

void subtract_pressure(const System& system, const MultiVector& lambda, MultiVector& y) {
  const auto pressure = lambda.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto D = system.constraint.pairing->getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto out = y.getLocalViewDevice(Tpetra::Access::ReadWrite);
  const auto node = system.constraint.node;
  const auto frames = system.constraint.frames;
  const int m = system.fields(), q = system.gaps();
  Kokkos::parallel_for(
      "thixis::contact::pressure", Range(0, pressure.extent_int(0)), KOKKOS_LAMBDA(int p) {
        const LocalIndex l = node(p);
        const Small& Q = frames.inverse(frames.at(l));
        for (int i = 0; i < m; ++i)
          for (int g = 0; g < q; ++g) out(l, i) -= Q(m - q + g, i) * D(p, 0) * pressure(p, g);
      });
}

}  // namespace thixis::contact
