#include "cut_cell.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace thixis::method {
namespace {

constexpr int most_divisions = 8;          // of a triangle in four; then the plain rule is taken
constexpr int most_halvings = 4;           // of the range of t
constexpr double no_sign = 1e-13;          // values below this part of the largest have no sign
constexpr double on_the_curve = 1e-9;      // a vertex with a value below this part of the largest sends no rays
constexpr double decayed = 3e-5;           // last Legendre coefficients of s*: the error of the rule is about their square
constexpr double narrowest_range = 1e-13;  // of t or s
constexpr int most_zeros = 12;             // on one edge
constexpr int fewest_across = 12;          // order of the rule across the rays: with fewer points s* takes more ranges of t than it saves

ReferencePoint between(const ReferencePoint& a, const ReferencePoint& b, double s) {
  return {a.xi + s * (b.xi - a.xi), a.eta + s * (b.eta - a.eta)};
}

/// Twice the area.
double determinant(const Triangle& T) { return (T[1].xi - T[0].xi) * (T[2].eta - T[0].eta) - (T[2].xi - T[0].xi) * (T[1].eta - T[0].eta); }

/// Position in the lattice of the point with barycentric coordinates (6-i-j, i, j)/6.
int lattice_index(int i, int j) { return j * 7 - j * (j - 1) / 2 + i; }

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

// -- the level set ------------------------------------------------------------------------------------------------------------------

/// values_ = phi(points_).
void CutCell::evaluate() {
  const std::size_t n = points_.size();
  x_.resize(n);
  y_.resize(n);
  values_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    x_[i] = origin_[0] + map_[0][0] * points_[i].xi + map_[0][1] * points_[i].eta;
    y_[i] = origin_[1] + map_[1][0] * points_[i].xi + map_[1][1] * points_[i].eta;
  }
  level_set_.evaluate({n, x_.data(), y_.data()}, t_, values_.data());
}

double CutCell::evaluate(const ReferencePoint& p) {
  points_.assign(1, p);
  evaluate();
  return values_[0];
}

int CutCell::sign(double value) const { return std::abs(value) <= no_sign * scale_ ? 0 : value > 0 ? 1 : -1; }

CutCell::Samples CutCell::sample(const Triangle& T) {
  points_.clear();
  for (int j = 0; j <= lattice; ++j)
    for (int i = 0; i + j <= lattice; ++i) {
      const double a = static_cast<double>(i) / lattice, b = static_cast<double>(j) / lattice, c = 1 - a - b;
      points_.push_back({c * T[0].xi + a * T[1].xi + b * T[2].xi, c * T[0].eta + a * T[1].eta + b * T[2].eta});
    }
  evaluate();
  Samples samples{};
  for (std::size_t k = 0; k < values_.size(); ++k) {
    samples.value[k] = values_[k];
    samples.scale = std::max(samples.scale, std::abs(values_[k]));
  }
  scale_ = samples.scale;
  return samples;
}

/// From vertex opposite+1 to vertex opposite+2.
CutCell::Segment CutCell::edge(const Triangle& T, const Samples& samples, int opposite) const {
  Segment segment{T[(opposite + 1) % 3], T[(opposite + 2) % 3], {}};
  for (int k = 0; k <= lattice; ++k) {
    const int index = opposite == 0 ? lattice_index(lattice - k, k) : opposite == 1 ? lattice_index(0, lattice - k) : lattice_index(k, 0);
    segment.value[k] = samples.value[index];
  }
  return segment;
}

/// Whether the curve passes twice through the segment between three samples of one sign: left.a, left.b = right.a and right.b. Follows
/// the minima of parabolas; where one has the other sign, both brackets are closed there.
bool CutCell::touching(Bracket& left, Bracket& right) {
  const double s = left.value_b > 0 ? 1 : -1;
  for (int step = 0; step < 5; ++step) {
    const double slope_left = s * (left.value_b - left.value_a) / (left.b - left.a);
    const double slope_right = s * (right.value_b - right.value_a) / (right.b - right.a);
    const double curvature = (slope_right - slope_left) / (right.b - left.a);
    if (curvature <= 0) return false;
    const double lowest = 0.5 * (left.a + left.b) - 0.5 * slope_left / curvature;
    if (lowest <= left.a || lowest >= right.b || std::abs(lowest - left.b) < 1e-9) return false;
    const double least = s * left.value_a + (lowest - left.a) * (slope_left + (lowest - left.b) * curvature);
    if (least > 0.3 * std::min({s * left.value_a, s * left.value_b, s * right.value_b})) return false;

    const double value = evaluate(between(left.from, left.to, lowest));
    if (sign(value) == 0) return false;
    Bracket& half = lowest < left.b ? left : right;
    if (s * value > s * left.value_b) {  // the middle sample remains the lowest
      if (&half == &left) left.a = lowest, left.value_a = value;
      else right.b = lowest, right.value_b = value;
      continue;
    }
    if (&half == &left) right.b = left.b, right.value_b = left.value_b;
    else left.a = left.b, left.value_a = left.value_b;
    left.b = right.a = lowest;
    left.value_b = right.value_a = value;
    if (s * value < 0) return true;
  }
  return false;
}

/// Brackets all zeros inside of the segment and returns their number. Zeros at its ends do not count.
int CutCell::bracket_zeros(const Segment& segment, std::vector<Bracket>& found) {
  const std::size_t before = found.size();
  const auto bracket = [&](int i, int j) {
    return Bracket{segment.from,     segment.to,      static_cast<double>(i) / last, static_cast<double>(j) / last,
                   segment.value[i], segment.value[j]};
  };
  int known = -1;  // the last sample that has a sign
  for (int i = 0; i <= last; ++i) {
    if (sign(segment.value[i]) == 0) continue;
    if (known >= 0 && sign(segment.value[i]) != sign(segment.value[known])) found.push_back(bracket(known, i));
    known = i;
  }
  for (int i = 1; i < last; ++i) {
    const int s = sign(segment.value[i]);
    if (s == 0 || sign(segment.value[i - 1]) == -s || sign(segment.value[i + 1]) == -s) continue;
    Bracket left = bracket(i - 1, i), right = bracket(i, i + 1);
    if (!touching(left, right)) continue;
    if (sign(left.value_a) != 0) found.push_back(left);
    if (sign(right.value_b) != 0) found.push_back(right);
    ++i;  // the next three samples would find the same pair
  }
  return static_cast<int>(found.size() - before);
}

/// Takes phi(at) into account. An end that stays twice counts half in the next step (Illinois).
void CutCell::Bracket::shrink(double value_there) {
  if (value_there == 0) {
    a = b = at;
  } else if ((value_there > 0) == (value_b > 0)) {
    b = at, value_b = value_there;
    if (side == 1) value_a *= 0.5;
    side = 1;
  } else {
    a = at, value_a = value_there;
    if (side == -1) value_b *= 0.5;
    side = -1;
  }
}

/// Shrinks all brackets to their zeros: a = b. The Illinois form of regula falsi, and halving where that does not gain.
void CutCell::solve(std::vector<Bracket>& brackets) {
  constexpr double accurate = 4e-16;
  constexpr int most_steps = 120;
  for (Bracket& z : brackets) z.width = z.b - z.a, z.side = 0;
  for (int step = 0; step < most_steps; ++step) {
    active_.clear();
    points_.clear();
    for (std::size_t k = 0; k < brackets.size(); ++k) {
      Bracket& z = brackets[k];
      if (z.b - z.a <= 2 * accurate) continue;
      double s = (z.a * z.value_b - z.b * z.value_a) / (z.value_b - z.value_a);
      if (step % 3 == 2) {
        if (z.b - z.a > 0.5 * z.width) s = 0.5 * (z.a + z.b);
        z.width = z.b - z.a;
      }
      z.at = std::clamp(s, z.a + accurate, z.b - accurate);
      active_.push_back(static_cast<int>(k));
      points_.push_back(between(z.from, z.to, z.at));
    }
    if (active_.empty()) break;
    evaluate();
    for (std::size_t i = 0; i < active_.size(); ++i) brackets[active_[i]].shrink(values_[i]);
  }
  for (Bracket& z : brackets) z.a = z.b = 0.5 * (z.a + z.b);
}

bool CutCell::crossed(const Triangle& T, const Samples& samples) {
  int low = 0, high = 0;
  for (const double value : samples.value) {
    low = std::min(low, sign(value));
    high = std::max(high, sign(value));
  }
  if (low < 0 && high > 0) return true;
  unused_.clear();
  for (int i = 0; i < 3; ++i)
    if (bracket_zeros(edge(T, samples, i), unused_) > 0) return true;
  return false;
}

// -- the rule -----------------------------------------------------------------------------------------------------------------------

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
