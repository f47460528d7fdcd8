#include "feasible/feasible_kernel.hpp"

#include <cmath>

namespace thixis::bound {
namespace {

KOKKOS_INLINE_FUNCTION double smallest(int n, const double* c) {
  double low = c[0];
  for (int k = 1; k < n; ++k) low = c[k] < low ? c[k] : low;
  return low;
}
KOKKOS_INLINE_FUNCTION double largest(int n, const double* c) {
  double high = 0;
  for (int k = 0; k < n; ++k) high = std::abs(c[k]) > high ? std::abs(c[k]) : high;
  return high;
}

}  // namespace

KOKKOS_FUNCTION FeasibleParts::Move FeasibleParts::move_polynomial(int K, const mesh::CellGeometry& geometry, const double* gap,
                                                                   bool counts) const {
  const int n = functions.size();
  Move move;
  if (counts) move.contact = contact_of(K, gap);
  if (smallest(n, gap) >= 0) return move;
  double a[max_density];
  if (counts) density.monomials(&lambda(K, 0), a);
  const int cuts = largest(n, gap) <= noise ? 0 : NegativePart::levels;
  const auto below = negative_part(geometry, gap, density, counts ? a : nullptr, cuts, {small / stiffness(K), 0.5 * small}, noise);
  move.square = below.square;
  move.contact += below.moment;
  return move;
}

KOKKOS_FUNCTION FeasibleParts::Move FeasibleParts::move_pointwise(int K, LocalIndex place, const mesh::CellGeometry& geometry,
                                                                  const double* gap, bool counts) const {
  const int n = functions.size();
  Move move;
  const bool open = smallest(n, gap) >= deviation.bound(place), follow = follows(K);
  if (open && !counts && !follow) return move;
  if (open && !deviation.of_obstacle && !follow) {  // by D at most wider than the polynomial
    double widest[most];
    for (int k = 0; k < n; ++k) widest[k] = gap[k] + deviation.bound(place);
    move.contact = contact_of(K, widest);
    return move;
  }
  if (at_points.data() != nullptr) at_points() = true;
  double a[max_density];
  if (counts) density.monomials(&lambda(K, 0), a);
  double chi[3] = {0, 0, 0};
  for (int i = 0; i < 3 && follow; ++i) chi[i] = followed(vertices(K, i));
  const double zero = follow ? -noise : 0;
  int below = 0;
  double of_followed = 0;
  const PointsOf points(deviation.quadrature, place);
  for (int q = 0; q < points.count; ++q) {
    const double xi = points.xi(q, 0), eta = points.xi(q, 1), barycentric[3] = {1 - xi - eta, xi, eta};
    const GlobalIndex at = points.first + q;
    const double D = deviation.at_points(at, 0), part = chi[0] * barycentric[0] + chi[1] * barycentric[1] + chi[2] * barycentric[2];
    const double value = functions.B.value(gap, barycentric) + (1 - part) * D;
    if (counts && value > 0) move.contact += points.weight(q) * value * density.value(a, xi, eta);
    const bool closes = value < zero;
    if (!closes && !follow) continue;
    below += closes ? 1 : 0;
    // s follows part D, and is moved back by what is left below zero: together
    // by -(gap + D) there
    double slope[3] = {0, 0, 0}, square = 0;
    if (closes) functions.B.gradient(gap, barycentric, slope);
    else
      for (int i = 0; i < 3; ++i) slope[i] = chi[i] * D;
    for (int d = 0; d < 2; ++d) {
      double g = (closes ? 1 : part) * deviation.at_points(at, 1 + d);
      for (int i = 0; i < 3; ++i) g += slope[i] * geometry.gradient[i][d];
      square += g * g;
    }
    (closes ? move.square : of_followed) += 2 * geometry.area * points.weight(q) * square;
  }
  // the points miss the zero line by up to their distance
  if (below < points.count) move.square *= 1 + 2 / std::sqrt(static_cast<double>(points.count));
  move.square += of_followed;
  return move;
}

KOKKOS_FUNCTION double FeasibleParts::contact_alone(int K) const {
  if (!pressed(K)) return 0;
  double node_gap[most], gap[most];
  for (int l = 0; l < functions.size(); ++l) {
    const LocalIndex e = of_cells(K, l);
    const double open = s_c[0](e) - floor(e);
    node_gap[l] = open < 0 ? 0 : open;
  }
  functions.to_bernstein(node_gap, gap);
  const mesh::CellGeometry geometry = mesh::cell_geometry(x, vertices, K);
  const LocalIndex place = deviation(K);
  return (place < 0 ? move_polynomial(K, geometry, gap, true) : move_pointwise(K, place, geometry, gap, true)).contact +
         contact_of_excess(K);
}

KOKKOS_FUNCTION bool FeasibleParts::moves(int K, const double* gap) const {
  const LocalIndex place = deviation(K);
  return smallest(functions.size(), gap) < (place < 0 ? 0 : deviation.bound(place));
}

/// s_c -> s_N: the change of each membrane and the gap that is left, at the
/// nodes; then up to the majorant and together.
KOKKOS_FUNCTION void FeasibleParts::go_to_nodes(int K, AtNodes& at) const {
  for (int l = 0; l < functions.size(); ++l) {
    const LocalIndex e = of_cells(K, l);
    const double open = s_c[0](e) - s_c[1](e), below = open < 0 ? -open : 0, share = theta.extent(0) > 0 ? theta(e) : apart[0];
    at.gap[l] = open < 0 ? 0 : open;
    at.change[0][l] = share * below;
    at.change[1][l] = -(1 - share) * below;
    at.ordered = at.ordered || open < 0;
    const double above = s_c[1](e) + at.gap[l] - floor(e);
    at.further[0][l] = above < 0 ? -above : 0;
    at.further[1][l] = 0;
    if (majorant.extent(0) > 0) at.gap[l] = above < 0 ? 0 : above;
    const int corner = l - first_vertex;
    if (closed.extent(0) > 0 && corner >= 0 && corner < 3) {
      const double by = part_closed(at.gap[l], closed(vertices(K, corner)));
      at.further[0][l] -= share * by;
      at.further[1][l] = (1 - share) * by;
      at.gap[l] -= by;
    }
    at.goes_on = at.goes_on || at.further[0][l] != 0 || at.further[1][l] != 0;
  }
}

/// Energies of the steps to s_N and beyond, of u_h -> s_c, of the lift, and of
/// all polynomials together with it; `at`.change becomes the whole way.
KOKKOS_FUNCTION FeasibleParts::Squares FeasibleParts::squares(int K, const mesh::CellGeometry& geometry, AtNodes& at) const {
  const int n = functions.size();
  double c[most];
  const auto square = [&](int alpha, const double* v) {
    functions.to_bernstein(v, c);
    return energy(alpha, K, geometry, c);
  };
  Squares of;
  for (int alpha = 0; at.ordered && alpha < count; ++alpha) of.nodes += square(alpha, at.change[alpha]);
  of.polynomial = at.goes_on ? 0 : of.nodes;
  for (int alpha = 0; at.goes_on && alpha < count; ++alpha) {
    of.further += square(alpha, at.further[alpha]);
    for (int l = 0; l < n; ++l) at.change[alpha][l] += at.further[alpha][l];
    of.polynomial += square(alpha, at.change[alpha]);
  }
  if (of_cells_u.extent(0) > 0) {
    const bool moves = at.ordered || at.goes_on;
    of.polynomial = 0;
    for (int alpha = 0; alpha < count; ++alpha) {
      double jump[most];
      for (int l = 0; l < n; ++l) {
        jump[l] = s_c[alpha](of_cells(K, l)) - u[alpha](of_cells_u(K, l));
        at.change[alpha][l] += jump[l];
      }
      of.averages += square(alpha, jump);
      if (moves) of.polynomial += square(alpha, at.change[alpha]);
    }
    if (!moves) of.polynomial = of.averages;
  }
  const LocalIndex place = lift(K);
  for (int alpha = 0; place >= 0 && alpha < count; ++alpha) {
    of.lift += lift.energy(place, alpha);
    of.polynomial += lift.energy(place, alpha);
    functions.to_bernstein(at.change[alpha], c);
    for (int k = 0; k < n; ++k) of.polynomial += 2 * lift.products(place, alpha, k) * c[k];
  }
  return of;
}

KOKKOS_FUNCTION void FeasibleParts::operator()(int K) const {
  AtNodes at;
  go_to_nodes(K, at);
  const mesh::CellGeometry geometry = mesh::cell_geometry(x, vertices, K);
  const Squares of = squares(K, geometry, at);

  // s_N -> s: what is moved apart
  const bool counts = pressed(K);
  double gap[most];
  functions.to_bernstein(at.gap, gap);
  const LocalIndex place = deviation(K);
  const Move move = place < 0 ? move_polynomial(K, geometry, gap, counts) : move_pointwise(K, place, geometry, gap, counts);
  const double moved = move.square > 0 ? std::sqrt(stiffness(K) * move.square) : 0;

  whole(K) = (of.polynomial > 0 ? std::sqrt(of.polynomial) : 0) + moved;
  at_nodes(K) = std::sqrt(of.nodes);
  rest(K) = std::sqrt(of.lift) + moved + std::sqrt(of.averages) + std::sqrt(of.further);
  contact(K) = move.contact + (counts ? contact_of_excess(K) : 0);
}

}  // namespace thixis::bound
