#include "gap_rows.hpp"

namespace thixis::contact {
namespace {

using algebra::MultiVector;
using algebra::Vector;
using Range = Kokkos::RangePolicy<Vector::execution_space>;
using In = decltype(std::declval<const MultiVector&>().getLocalViewDevice(Tpetra::Access::ReadOnly));
using Out = decltype(std::declval<MultiVector&>().getLocalViewDevice(Tpetra::Access::ReadWrite));

constexpr double contact_ratio = 1e10;

In read(const MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadOnly); }
Out change(MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadWrite); }

/// (Tᵀ R)_i at a node.
struct Forces {
  Frames frames;
  int fields;
  In R;

  explicit Forces(const System& system, const MultiVector& of_fields)
      : frames(system.constraint.frames), fields(system.fields()), R(read(of_fields)) {}
  KOKKOS_FUNCTION double operator()(LocalIndex l, int i) const {
    const Small& T = frames.T(frames.at(l));
    double sum = 0;
    for (int a = 0; a < fields; ++a) sum += T(a, i) * R(l, a);
    return sum;
  }
};

}  // namespace

GapRows::GapRows(const System& system)
    : system_(system),
      means_(system.fields() - system.gaps()),
      diagonal_(system.map(), system.gaps()),
      contact_(system.map(), system.gaps()),
      penalty_(system.map(), system.gaps()),
      a_(system.points(), system.gaps()),
      b_(system.points(), system.gaps()) {}

void GapRows::decide(const Vector& new_a, const Vector& new_b) {
  Tpetra::deep_copy(a_, gaps(system_, new_a));
  Tpetra::deep_copy(b_, gaps(system_, new_b));
  contact_.putScalar(0);
  penalty_.putScalar(0);
  const auto D = read(*system_.constraint.pairing), diagonal = read(diagonal_), a = read(a_), b = read(b_);
  const auto contact = change(contact_), penalty = change(penalty_);
  const auto node = system_.constraint.node;
  const int q = system_.gaps();
  Kokkos::parallel_for(
      "thixis::contact::contact", Range(0, a.extent_int(0)), KOKKOS_LAMBDA(int p) {
        const LocalIndex l = node(p);
        for (int g = 0; g < q; ++g) {
          const double held = D(p, 0) * a(p, g), flexible = contact_ratio * diagonal(l, g) * b(p, g);
          const bool closed = held * held >= flexible * flexible;
          contact(l, g) = closed ? 1 : 0;
          penalty(l, g) = closed ? 0 : D(p, 0) * a(p, g) / b(p, g);
        }
      });
}

void GapRows::set_known(const MultiVector& C, MultiVector& dy) const {
  dy.putScalar(0);
  const auto c = read(C), a = read(a_), contact = read(contact_);
  const auto known = change(dy);
  const auto node = system_.constraint.node;
  const int q = system_.gaps(), means = means_;
  Kokkos::parallel_for(
      "thixis::contact::known_gaps", Range(0, c.extent_int(0)), KOKKOS_LAMBDA(int p) {
        const LocalIndex l = node(p);
        for (int g = 0; g < q; ++g) known(l, means + g) = contact(l, g) > 0 ? -c(p, g) / a(p, g) : 0;
      });
}

void GapRows::set_right_sides(const MultiVector& R, const MultiVector& C, const MultiVector& dy, MultiVector& rhs) const {
  const Forces r(system_, R);
  const auto out = change(rhs);
  Kokkos::parallel_for(
      "thixis::contact::right_sides", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int l) {
        for (int i = 0; i < r.fields; ++i) out(l, i) = -r(l, i) - out(l, i);
      });
  const auto c = read(C), D = read(*system_.constraint.pairing), b = read(b_), contact = read(contact_), diagonal = read(diagonal_),
             known = read(dy);
  const auto node = system_.constraint.node;
  const int q = system_.gaps(), means = means_;
  Kokkos::parallel_for(
      "thixis::contact::right_side_of_gaps", Range(0, c.extent_int(0)), KOKKOS_LAMBDA(int p) {
        const LocalIndex l = node(p);
        for (int g = 0; g < q; ++g) {
          if (contact(l, g) > 0) out(l, means + g) = diagonal(l, g) * known(l, means + g);
          else out(l, means + g) -= D(p, 0) * c(p, g) / b(p, g);
        }
      });
}

void GapRows::recover(const MultiVector& R, const MultiVector& C, const MultiVector& dy, const MultiVector& pushed,
                      MultiVector& dlambda) const {
  const Forces r(system_, R);
  const auto c = read(C), z = read(dy), push = read(pushed), D = read(*system_.constraint.pairing), contact = read(contact_), a = read(a_),
             b = read(b_);
  const auto out = change(dlambda);
  const auto node = system_.constraint.node;
  const int q = system_.gaps(), means = means_;
  Kokkos::parallel_for(
      "thixis::contact::recover", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int p) {
        const LocalIndex l = node(p);
        for (int g = 0; g < q; ++g)
          out(p, g) =
              contact(l, g) > 0 ? (push(l, means + g) + r(l, means + g)) / D(p, 0) : -(c(p, g) + a(p, g) * z(l, means + g)) / b(p, g);
      });
}

}  // namespace thixis::contact
