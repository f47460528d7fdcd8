#include <algorithm>
#include <cmath>

#include "quadrature/cut_cell.hpp"

/// Where the level set of a CutCell vanishes.
namespace thixis::method {
namespace {

constexpr double no_sign = 1e-13;  // values below this part of the largest have no sign

}  // namespace

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

}  // namespace thixis::method
