#include "quadrature/cut_cell.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace thixis::method {
namespace {

constexpr int most_divisions = 8;          // of a triangle in four; then the plain rule is taken
constexpr int most_halvings = 4;           // of the range of t
constexpr double on_the_curve = 1e-9;      // a vertex with a value below this part of the largest sends no rays
constexpr double decayed = 3e-5;           // last Legendre coefficients of s*: the error of the rule is about their square
constexpr double narrowest_range = 1e-13;  // of t or s
constexpr int most_zeros = 12;             // on one edge
constexpr int fewest_across = 12;          // order of the rule across the rays: with fewer points s* takes more ranges of t than it saves

/// Twice the area.
double determinant(const Triangle& T) { return (T[1].xi - T[0].xi) * (T[2].eta - T[0].eta) - (T[2].xi - T[0].xi) * (T[1].eta - T[0].eta); }

/// Legendre polynomials P_0 … P_n-1 at 2 t - 1.
std::vector<double> legendre(int n, double t) {
  const double x = 2 * t - 1;
  std::vector<double> P(n);
  for (int k = 0; k < n; ++k) P[k] = k == 0 ? 1 : k == 1 ? x : ((2 * k - 1) * x * P[k - 1] - (k - 1) * P[k - 2]) / k;
  return P;
}

}  // namespace

// Along a ray the integrand times s has degree order + 1; across the rays s* multiplies the degree, two more points serve it.
CutCell::CutCell(const scene::Field& level_set, double t, int order)
    : level_set_(level_set),
      t_(t),
      plain_(reference::triangle_quadrature(order)),
      along_(reference::line_quadrature(std::min(order + 1, reference::max_quadrature_order))),
      across_(reference::line_quadrature(std::clamp(order + 5, fewest_across, reference::max_quadrature_order))) {
  const int n = across_.size();
  last_coefficients_.resize(2 * n);
  for (int q = 0; q < n; ++q) {
    const std::vector<double> P = legendre(n, across_.point[q]);
    for (int row = 0; row < 2; ++row) last_coefficients_[row * n + q] = (2 * (n - 1 - row) + 1) * across_.weight[q] * P[n - 1 - row];
  }
}

bool CutCell::append(const double (&corners)[3][2], std::vector<double>& xi, std::vector<double>& weight) {
  for (int d = 0; d < 2; ++d) {
    origin_[d] = corners[0][d];
    map_[d][0] = corners[1][d] - corners[0][d];
    map_[d][1] = corners[2][d] - corners[0][d];
  }
  xi_ = &xi;
  weight_ = &weight;
  const Triangle whole = {{{0, 0}, {1, 0}, {0, 1}}};
  const Samples samples = sample(whole);
  if (!crossed(whole, samples)) return false;
  add_crossed(whole, samples, 0);
  return true;
}

void CutCell::add_piece(const Triangle& T, int divisions) {
  const Samples samples = sample(T);
  if (crossed(T, samples)) add_crossed(T, samples, divisions);
  else add_plain(T);
}

void CutCell::add_crossed(const Triangle& T, const Samples& samples, int divisions) {
  const double at_vertex[3] = {std::abs(samples.value[lattice_index(0, 0)]), std::abs(samples.value[lattice_index(lattice, 0)]),
                               std::abs(samples.value[lattice_index(0, lattice)])};
  int vertex[3] = {0, 1, 2};  // the farther from the curve the better do the rays meet it
  std::sort(vertex, vertex + 3, [&](int i, int j) { return at_vertex[i] > at_vertex[j]; });
  for (const int v : vertex) {
    if (at_vertex[v] <= on_the_curve * samples.scale) break;
    const std::size_t points = xi_->size(), weights = weight_->size();
    if (add_rays(T, samples, v)) return;
    xi_->resize(points);
    weight_->resize(weights);
  }
  if (divisions == most_divisions) return add_plain(T);
  const ReferencePoint m[3] = {between(T[1], T[2], 0.5), between(T[2], T[0], 0.5), between(T[0], T[1], 0.5)};
  for (const Triangle& child :
       {Triangle{T[0], m[2], m[1]}, Triangle{m[2], T[1], m[0]}, Triangle{m[1], m[0], T[2]}, Triangle{m[0], m[1], m[2]}})
    add_piece(child, divisions + 1);
}

/// The fans of rays from a vertex that the zeros on the opposite edge delimit; false if a ray meets the curve more than once.
bool CutCell::add_rays(const Triangle& T, const Samples& samples, int vertex) {
  const Segment opposite = edge(T, samples, vertex);
  zeros_.clear();
  const int count = bracket_zeros(opposite, zeros_);
  if (count > most_zeros) return false;
  solve(zeros_);
  std::array<double, most_zeros + 2> t{};
  for (int k = 0; k < count; ++k) t[k + 1] = zeros_[k].a;
  t[count + 1] = 1;
  std::sort(t.begin(), t.begin() + count + 2);

  const int at = vertex == 0 ? lattice_index(0, 0) : vertex == 1 ? lattice_index(lattice, 0) : lattice_index(0, lattice);
  for (int k = 0; k <= count; ++k) {
    if (t[k + 1] - t[k] < narrowest_range) continue;
    const Triangle fan = {T[vertex], between(opposite.from, opposite.to, t[k]), between(opposite.from, opposite.to, t[k + 1])};
    const std::array<bool, 2> zero_at_end = {k > 0 || sign(opposite.value[0]) == 0, k < count || sign(opposite.value[last]) == 0};
    if (!add_fan(fan, samples.value[at], zero_at_end, 0)) return false;
  }
  return true;
}

/// All rays from T[0] to the edge T[1] T[2], on which phi has no zeros but perhaps at its ends. False if they do not all meet the curve
/// in the same way.
bool CutCell::add_fan(const Triangle& T, double value_at_vertex, std::array<bool, 2> zero_at_end, int halvings) {
  const int n = across_.size();
  const auto end = [&](int ray) { return between(T[1], T[2], ray == 0 ? 0.0 : ray == n + 1 ? 1.0 : across_.point[ray - 1]); };
  points_.clear();
  for (int ray = 0; ray < n + 2; ++ray)
    for (int k = 1; k <= last; ++k) points_.push_back(between(T[0], end(ray), static_cast<double>(k) / last));
  evaluate();
  ray_values_ = values_;

  // The first and the last ray are the sides of the fan: no points there, but the curve must not look in through them.
  zeros_.clear();
  unused_.clear();
  int hits[2] = {0, 0}, hit = 0;
  for (int ray = 0; ray < n + 2; ++ray) {
    const bool side = ray == 0 || ray == n + 1;
    Segment segment{T[0], end(ray), {}};
    segment.value[0] = value_at_vertex;
    std::copy_n(ray_values_.begin() + ray * last, last, segment.value + 1);
    if (side && zero_at_end[ray == 0 ? 0 : 1]) segment.value[last] = 0;
    const int count = bracket_zeros(segment, side ? unused_ : zeros_);
    if (count > 1) return false;
    (side ? hits[ray == 0 ? 0 : 1] : hit) += count;
  }
  if (hit != 0 && hit != n) return false;
  for (const int k : {0, 1})
    if (hits[k] != (hit == n && !zero_at_end[k] ? 1 : 0)) return false;
  if (hit == 0) {
    add_plain(T);
    return true;
  }
  solve(zeros_);
  if (resolved()) {
    add_split(T);
    return true;
  }
  if (halvings == most_halvings) return false;
  const ReferencePoint middle = between(T[1], T[2], 0.5);
  return add_fan({T[0], T[1], middle}, value_at_vertex, {zero_at_end[0], false}, halvings + 1) &&
         add_fan({T[0], middle, T[2]}, value_at_vertex, {false, zero_at_end[1]}, halvings + 1);
}

/// Whether the last two Legendre coefficients of s* are small.
bool CutCell::resolved() const {
  const int n = across_.size();
  for (int row = 0; row < 2; ++row) {
    double coefficient = 0;
    for (int q = 0; q < n; ++q) coefficient += last_coefficients_[row * n + q] * zeros_[q].a;
    if (std::abs(coefficient) > decayed) return false;
  }
  return true;
}

void CutCell::add_plain(const Triangle& T) {
  const double scale = determinant(T);
  for (int q = 0; q < plain_.size(); ++q) {
    const double a = plain_.point[2 * q], b = plain_.point[2 * q + 1], c = 1 - a - b;
    xi_->push_back(c * T[0].xi + a * T[1].xi + b * T[2].xi);
    xi_->push_back(c * T[0].eta + a * T[1].eta + b * T[2].eta);
    weight_->push_back(scale * plain_.weight[q]);
  }
}

/// Gauss points on both parts of every ray from T[0].
void CutCell::add_split(const Triangle& T) {
  const double scale = determinant(T);
  for (int q = 0; q < across_.size(); ++q) {
    const ReferencePoint end = between(T[1], T[2], across_.point[q]);
    const double ends[3] = {0, zeros_[q].a, 1};
    for (int part = 0; part < 2; ++part) {
      const double length = ends[part + 1] - ends[part];
      if (length < narrowest_range) continue;
      for (int k = 0; k < along_.size(); ++k) {
        const double s = ends[part] + length * along_.point[k];
        const ReferencePoint p = between(T[0], end, s);
        xi_->push_back(p.xi);
        xi_->push_back(p.eta);
        weight_->push_back(scale * s * across_.weight[q] * length * along_.weight[k]);
      }
    }
  }
}

}  // namespace thixis::method
