#include <algorithm>
#include <cmath>

#include "data/on_host.hpp"
#include "lift/boundary_lift.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/to_view.hpp"

/// What is asked of a lift once it is known.
namespace thixis::bound {
namespace {

/// Of |s (1 - s) q(s)| on the face, and of |lambda_j lambda_k q(lambda_k + lambda_i/2)| in the cell, for lambda_j lambda_k <= s (1 - s)
/// there: a polynomial of degree n is at most 1/cos(n pi/(2m)) times its largest value at the m > n zeros of a Chebyshev polynomial
/// (Ehlich, Zeller, Math. Z. 86, 1964, doi:10.1007/BF01111276).
double largest_on_face(const LiftInCell::Series& q) {
  constexpr int degree = LiftInCell::resolution + 2, zeros = 4 * degree;
  const double pi = std::acos(-1.0);
  double most = 0;
  for (int m = 0; m < zeros; ++m) {
    const double s = 0.5 + 0.5 * std::cos((m + 0.5) * pi / zeros);
    most = std::max(most, std::abs(s * (1 - s) * series(q, s)[0]));
  }
  return most / std::cos(pi * degree / (2 * zeros));
}

}  // namespace

BoundaryLift::Value BoundaryLift::operator()(int alpha, LocalIndex place, double xi, double eta) const {
  const auto K = mesh::cell_geometry(host_.coordinates, host_.cell_vertices, on_host(layer_)(place));
  const LiftInCell& lift = lift_[alpha][place];
  const double lambda[3] = {1 - xi - eta, xi, eta};
  double slope[3];
  Value sum;
  sum.value = basis_.bernstein().value(lift.v.data(), lambda);
  basis_.bernstein().gradient(lift.v.data(), lambda, slope);
  for (int f = 0; f < lift.faces; ++f) {
    const int i = lift.face[f], j = (i + 1) % 3, k = (i + 2) % 3;
    const auto [q, dq] = series(lift.q[f], lambda[k] + 0.5 * lambda[i]);
    sum.value += lambda[j] * lambda[k] * q;
    slope[i] += 0.5 * lambda[j] * lambda[k] * dq;
    slope[j] += lambda[k] * q;
    slope[k] += lambda[j] * q + lambda[j] * lambda[k] * dq;
  }
  for (int a = 0; a < 3; ++a)
    for (int d = 0; d < 2; ++d) sum.gradient[d] += slope[a] * K.gradient[a][d];
  return sum;
}

LiftInCell BoundaryLift::difference(LocalIndex place) const {
  LiftInCell difference = lift_[0][place];
  if (count_ == 1) return difference;
  const LiftInCell& lower = lift_[1][place];
  for (std::size_t k = 0; k < lower.v.size(); ++k) difference.v[k] -= lower.v[k];
  for (int f = 0; f < lower.faces; ++f)
    for (std::size_t j = 0; j < lower.q[f].size(); ++j) difference.q[f][j] -= lower.q[f][j];
  return difference;
}

double BoundaryLift::bound_of_difference(LocalIndex place) const {
  const LiftInCell D = difference(place);
  double bound = 0;
  for (const double v : D.v) bound = std::max(bound, std::abs(v));
  for (int f = 0; f < D.faces; ++f) bound += largest_on_face(D.q[f]);
  return bound;
}

/// By the rule for |grad L|² where there is a face, which is more than enough.
View<double* [2]> BoundaryLift::change(const BoundaryLift* before) const {
  const bool then = before && !before->empty_;
  if (empty_ && !then) return {};
  const BoundaryLift& layer = empty_ ? *before : *this;
  const mesh::Mesh& mesh = space_.mesh();
  const View<double* [2]> norm("thixis::bound::change_of_lift", mesh.owned_cells);
  const auto on_faces = method::make_quadrature(mesh, layer.owned_, lift_order, nullptr),
             inside = method::make_quadrature(mesh, layer.owned_, 2 * degree_of_v, nullptr);
  const LiftTable of_faces = table(on_faces.rule_xi), of_inside = table(inside.rule_xi);
  const auto owned = on_host(layer.owned_);
  const auto out = Kokkos::create_mirror_view(norm);
  const auto face_weight = on_host(on_faces.rule_weight), inner_weight = on_host(inside.rule_weight);
  std::vector<double> L[3], other[3];
  for (LocalIndex k = 0; k < owned.extent_int(0); ++k) {
    const LocalIndex K = owned(k);
    const double area = mesh::cell_area(host_.coordinates, host_.cell_vertices, K);
    for (int alpha = 0; alpha < count_; ++alpha) {
      const LiftInCell& lift = layer.lift_[alpha][k];
      const mesh::ConstHostView<const double*> weight = lift.faces > 0 ? face_weight : inner_weight;
      const LiftTable& values = lift.faces > 0 ? of_faces : of_inside;
      values.evaluate(lift, L);
      if (then && !empty_) values.evaluate(before->lift_[alpha][k], other);
      double square = 0;
      for (int q = 0; q < values.points(); ++q) {
        const double difference = L[0][q] - (then && !empty_ ? other[0][q] : 0);
        square += 2 * area * weight(q) * difference * difference;
      }
      out(K, alpha) = std::sqrt(square);
    }
  }
  Kokkos::deep_copy(norm, out);
  return norm;
}

}  // namespace thixis::bound
