#include "lift/held_faces.hpp"

#include <algorithm>
#include <cmath>

#include "data/on_host.hpp"
#include "lift/face_pieces.hpp"
#include "thixis/mesh/remoteness.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::bound {
namespace {

constexpr int modes = LiftInCell::resolution + 1;

/// The largest of some values of a tension at points, all of them if it varies.
double largest_tension(const scene::Field& tension, const std::vector<double>& x, const std::vector<double>& y) {
  if (const double* constant = tension.constant()) return *constant;
  std::vector<double> mu(x.size());
  tension.evaluate({x.size(), x.data(), y.data()}, 0, mu.data());
  return *std::max_element(mu.begin(), mu.end());
}

/// The face from corner 0 to corner 1 of a cell, opposite to its corner 2.
struct Face {
  int i;
  double corner[3][2];

  /// Of the places at s.
  std::vector<double> coordinates(const std::vector<double>& s, int d) const {
    std::vector<double> x;
    for (const double place : s) x.push_back((1 - place) * corner[0][d] + place * corner[1][d]);
    return x;
  }
};

/// Points on a face.
struct Points {
  std::vector<double> s, x, y;

  std::vector<double> values(const scene::Field& field, double time) const {
    std::vector<double> g(x.size());
    field.evaluate({x.size(), x.data(), y.data()}, time, g.data());
    return g;
  }
};

class Examination {
 public:
  Examination(const method::Space& space, const std::array<scene::FieldPtr, 2>& tension, double time)
      : tension_(tension), time_(time), n_(space.basis().size()), pieces_(space.basis()) {
    const auto rule = reference::line_quadrature(2 * LiftInCell::resolution + 8);
    weight_ = rule.weight;
    coarse_.s = rule.point;
    for (int m = 0; m <= FacePieces::count; ++m) fine_.s.push_back(FacePieces::s(m));
    for (int i = 0; i < 3; ++i) trace_[i] = traces(space.basis(), i, rule.point);
    legendre_ = legendre_at(rule.point);
  }

  /// Goes to a face.
  void look_at(const Face& face) {
    face_ = face;
    for (Points* points : {&coarse_, &fine_}) {
      points->x = face.coordinates(points->s, 0);
      points->y = face.coordinates(points->s, 1);
    }
  }
  /// q of the data of a membrane there, whose interpolant has the coefficients u in the cell; returns |||E|||².
  double examine(int alpha, const scene::Field& g, const std::vector<double>& u, LiftInCell::Series& q);

  double largest() const { return largest_; }
  bool round_off() const { return largest_ <= 1e-13 * size_; }

 private:
  const std::array<scene::FieldPtr, 2>& tension_;
  double time_;
  int n_;
  FacePieces pieces_;
  Points coarse_, fine_;
  std::vector<double> weight_, trace_[3], legendre_;
  Face face_{};
  double largest_ = 0, size_ = 0;
};

double Examination::examine(int alpha, const scene::Field& field, const std::vector<double>& u, LiftInCell::Series& q) {
  const auto g = coarse_.values(field, time_);
  const auto [low, high] = std::minmax_element(g.begin(), g.end());
  const double by_place = mesh::remoteness(3, [&](int v, int d) { return face_.corner[v][d]; }) * (*high - *low);
  size_ = std::max({size_, field.cancelled(), by_place});
  q = {};
  for (std::size_t p = 0; p < g.size(); ++p) {
    double delta = g[p];
    for (int l = 0; l < n_; ++l) delta -= trace_[face_.i][p * n_ + l] * u[l];
    largest_ = std::max(largest_, std::abs(delta));
    size_ = std::max(size_, std::abs(g[p]));
    const double s = coarse_.s[p], quotient = delta / (s * (1 - s));
    for (int j = 0; j < modes; ++j) q[j] += weight_[p] * quotient * legendre_[p * modes + j];
  }
  auto rho = fine_.values(field, time_);
  pieces_.subtract(face_.i, u.data(), rho);
  for (const double delta : rho) largest_ = std::max(largest_, std::abs(delta));
  pieces_.subtract_lift(q, rho);
  return largest_tension(*tension_[alpha], fine_.x, fine_.y) * FacePieces::energy(rho, face_.corner[0], face_.corner[1], face_.corner[2]);
}

}  // namespace

HeldFaces held_faces(const method::Space& space, const ContinuousNodes& nodes, const std::array<scene::FieldPtr, 2>& tension,
                     const std::array<method::BoundaryValues, 2>& boundary, const std::vector<double> (&held)[2], int count, double time) {
  const auto host = mesh::on_host(space.mesh());
  const auto of_cells = on_host(nodes.of_cells);
  const auto cells = on_host(space.cells());
  Examination examination(space, tension, time);
  HeldFaces found;
  std::vector<double> u(space.basis().size());
  for (LocalIndex k = 0; k < cells.extent_int(0); ++k) {
    HeldFaces::Cell cell{k, {}};
    double energy = 0;
    for (int i = 0; i < 3; ++i) {
      const LocalIndex tag = host.face_tag(host.cell_faces(cells(k), i));
      if (tag < 0 || !boundary[0].dirichlet[tag]) continue;
      Face face{i, {}};
      for (int v = 0; v < 3; ++v)
        for (int d = 0; d < 2; ++d) face.corner[v][d] = host.coordinates(host.cell_vertices(cells(k), (i + 1 + v) % 3), d);
      examination.look_at(face);
      double square = 0;
      for (int alpha = 0; alpha < count; ++alpha) {
        for (std::size_t l = 0; l < u.size(); ++l) u[l] = held[alpha][of_cells(k, l)];
        LiftInCell& lift = cell.l[alpha];
        lift.face[lift.faces] = i;
        square += examination.examine(alpha, *boundary[alpha].dirichlet[tag], u, lift.q[lift.faces++]);
      }
      energy += std::sqrt(square);
    }
    if (cell.l[0].faces == 0) continue;
    found.cells.push_back(cell);
    if (k < space.mesh().owned_cells) found.remainder.push_back({k, energy});
  }
  found.largest = examination.largest();
  found.empty = examination.round_off();
  if (found.empty) found.remainder.clear();
  return found;
}

}  // namespace thixis::bound
