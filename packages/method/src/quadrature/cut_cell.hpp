#pragma once
#include <array>
#include <vector>

#include "thixis/reference/quadrature.hpp"
#include "thixis/scene/field.hpp"

namespace thixis::method {

/// A point in reference coordinates.
struct ReferencePoint {
  double xi, eta;
};
using Triangle = std::array<ReferencePoint, 3>;

inline ReferencePoint between(const ReferencePoint& a, const ReferencePoint& b, double s) {
  return {a.xi + s * (b.xi - a.xi), a.eta + s * (b.eta - a.eta)};
}

/// Position in the lattice of the point with barycentric coordinates (6-i-j, i, j)/6.
inline int lattice_index(int i, int j) { return j * 7 - j * (j - 1) / 2 + i; }

/// Quadrature on triangles that the zero set of a level set phi cuts, for integrands that are smooth on either side of it.
///
/// From a vertex V rays go to the points E(t) of the opposite edge. Between two zeros of phi on that edge every ray meets the curve
/// once, at V + s*(t) (E(t) - V), or never. Where it does, the triangle is a union of (0,1) x (0,s*) and (0,1) x (s*,1), with Gauss
/// points on both and the area element s |2T| ds dt; s* is as smooth as the curve, and the rule converges exponentially (measured by the
/// Legendre coefficients of s*; slow ones halve the range of t). Where it does not, the triangle is plain. If no vertex will do, the
/// triangle is divided in four. Weights are positive and sum to the area whatever the curve.
///
/// A curve is seen if it separates points of a lattice of 28 or comes through an edge; closed curves smaller than a sixth of the
/// triangle are not.
class CutCell {
 public:
  /// `order`: polynomials of this degree on both sides of a straight line are integrated exactly but for the decay above.
  CutCell(const scene::Field& level_set, double t, int order);

  /// Appends points (flat [q][2], reference coordinates) and weights (of sum 1/2) for the triangle with these corners. Appends nothing and
  /// returns false if the curve does not go through it. Throws InputError where the level set is not finite.
  bool append(const double (&corners)[3][2], std::vector<double>& xi, std::vector<double>& weight);

 private:
  static constexpr int lattice = 6;  // samples at multiples of 1/6
  static constexpr int last = lattice;

  struct Samples {
    std::array<double, 28> value;
    double scale;  // the largest |value|
  };
  /// Values along a segment, at multiples of 1/6.
  struct Segment {
    ReferencePoint from, to;
    double value[lattice + 1];
  };
  /// phi has a zero at from + s (to - from), a < s < b; solved: a = b.
  struct Bracket {
    ReferencePoint from, to;
    double a, b, value_a, value_b;
    double at = 0;     // the next s to be tried
    double width = 0;  // some steps ago
    int side = 0;      // the end that moved last
    void shrink(double value_there);
  };

  void evaluate();
  double evaluate(const ReferencePoint& p);
  int sign(double value) const;
  Samples sample(const Triangle& T);
  Segment edge(const Triangle& T, const Samples& samples, int opposite) const;
  bool touching(Bracket& left, Bracket& right);
  int bracket_zeros(const Segment& segment, std::vector<Bracket>& found);
  void solve(std::vector<Bracket>& brackets);
  bool crossed(const Triangle& T, const Samples& samples);

  void add_piece(const Triangle& T, int divisions);
  void add_crossed(const Triangle& T, const Samples& samples, int divisions);
  bool add_rays(const Triangle& T, const Samples& samples, int vertex);
  bool add_fan(const Triangle& T, double value_at_vertex, std::array<bool, 2> zero_at_end, int halvings);
  bool resolved() const;
  void add_plain(const Triangle& T);
  void add_split(const Triangle& T);

  const scene::Field& level_set_;
  double t_;
  reference::Quadrature plain_, along_, across_;
  std::vector<double> last_coefficients_;  // [2][across_]: rows of the Legendre transform on these points

  double origin_[2] = {}, map_[2][2] = {};  // of the cell: x = origin + map xi
  double scale_ = 0;                        // of the piece at work
  std::vector<double>* xi_ = nullptr;
  std::vector<double>* weight_ = nullptr;

  std::vector<ReferencePoint> points_;  // where evaluate() evaluates
  std::vector<double> x_, y_, values_, ray_values_;
  std::vector<Bracket> zeros_, unused_;
  std::vector<int> active_;
};

}  // namespace thixis::method
