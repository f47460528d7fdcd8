#include "thixis/complementarity/c_function.hpp"

#include <cmath>

#include "thixis/complementarity/active_set.hpp"
#include "views.hpp"

namespace thixis::complementarity {
namespace {

/// C_l = K_l in contact, s_l G_l elsewhere. The other argument enters with weight 0 so that its NaN does not get lost.
struct Minimum {
  Read K, G, s;
  Flags contact;
  Write C;
  KOKKOS_FUNCTION void operator()(int l) const {
    const double x = K(l), y = s(l) * G(l);
    C(l) = contact(l) ? x + 0 * y : y + 0 * x;
  }
};

struct MinimumDerivative {
  Read s;
  Flags contact;
  Write a, b;
  KOKKOS_FUNCTION void operator()(int l) const {
    a(l) = contact(l) ? 1 : 0;
    b(l) = contact(l) ? 0 : s(l);
  }
};

/// √(x² + y²) without overflow or underflow of the squares.
KOKKOS_INLINE_FUNCTION double length(double x, double y) {
  const double p = std::abs(x), q = std::abs(y);
  if (!(p + q > 0)) return p + q;  // 0, or NaN
  const double larger = p < q ? q : p, ratio = (p < q ? p : q) / larger;
  return larger * std::sqrt(1 + ratio * ratio);
}

/// r - (x + y) = -2xy/(r + x + y)
struct FischerBurmeister {
  Read K, G, s;
  Write C;
  KOKKOS_FUNCTION void operator()(int l) const {
    const double x = K(l), y = s(l) * G(l), r = length(x, y);
    C(l) = x + y > 0 ? -2 * (x / (r + x + y)) * y : r - (x + y);
  }
};

/// x/r - 1 = -y²/(r (r + x))
KOKKOS_INLINE_FUNCTION double cosine_minus_one(double x, double y, double r) { return x > 0 ? -(y / r) * (y / (r + x)) : x / r - 1; }

struct FischerBurmeisterDerivative {
  Read K, G, s;
  Write a, b;
  KOKKOS_FUNCTION void operator()(int l) const {
    const double at_zero = -0.29289321881345247560;  // 1/√2 - 1
    const double x = K(l), y = s(l) * G(l), r = length(x, y);
    a(l) = r == 0 ? at_zero : cosine_minus_one(x, y, r);
    b(l) = s(l) * (r == 0 ? at_zero : cosine_minus_one(y, x, r));
  }
};

Kokkos::RangePolicy<Execution> points_of(const algebra::Vector& K) {
  return Kokkos::RangePolicy<Execution>(0, static_cast<int>(K.getLocalLength()));
}
Flags flags_of(const ActiveSet& active) { return Flags(active.flags().data(), active.flags().size()); }

}  // namespace

void evaluate(CFunction function, const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s, const ActiveSet& active,
              algebra::Vector& C) {
  if (function == CFunction::min)
    Kokkos::parallel_for("thixis::complementarity::minimum", points_of(K), Minimum{read(K), read(G), read(s), flags_of(active), write(C)});
  else
    Kokkos::parallel_for("thixis::complementarity::Fischer-Burmeister", points_of(K),
                         FischerBurmeister{read(K), read(G), read(s), write(C)});
  Execution().fence();
}

void differentiate(CFunction function, const algebra::Vector& K, const algebra::Vector& G, const algebra::Vector& s,
                   const ActiveSet& active, algebra::Vector& a, algebra::Vector& b) {
  if (function == CFunction::min)
    Kokkos::parallel_for("thixis::complementarity::minimum derivative", points_of(K),
                         MinimumDerivative{read(s), flags_of(active), write(a), write(b)});
  else
    Kokkos::parallel_for("thixis::complementarity::Fischer-Burmeister derivative", points_of(K),
                         FischerBurmeisterDerivative{read(K), read(G), read(s), write(a), write(b)});
  Execution().fence();
}

}  // namespace thixis::complementarity
