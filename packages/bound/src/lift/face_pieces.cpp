#include "lift/face_pieces.hpp"

#include <cmath>

#include "thixis/reference/quadrature.hpp"

namespace thixis::bound {
namespace {

constexpr int modes = LiftInCell::resolution + 1;

std::vector<double> ends() {
  std::vector<double> s;
  for (int m = 0; m <= FacePieces::count; ++m) s.push_back(FacePieces::s(m));
  return s;
}

}  // namespace

std::vector<double> traces(const reference::CellBasis& basis, int i, const std::vector<double>& s) {
  constexpr double corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  std::vector<double> at;
  for (const double place : s)
    for (int d = 0; d < 2; ++d) at.push_back((1 - place) * corner[(i + 1) % 3][d] + place * corner[(i + 2) % 3][d]);
  return basis.tabulate(static_cast<int>(s.size()), at.data()).value;
}

std::vector<double> legendre_at(const std::vector<double>& s) {
  std::vector<double> values;
  for (const double place : s)
    for (const double value : reference::legendre(modes, place)) values.push_back(value);
  return values;
}

FacePieces::FacePieces(const reference::CellBasis& basis) : functions_(basis.size()), legendre_(legendre_at(ends())) {
  for (int i = 0; i < 3; ++i) trace_[i] = traces(basis, i, ends());
}

void FacePieces::subtract(int i, const double* u, std::vector<double>& g) const {
  for (int m = 0; m <= count; ++m)
    for (int l = 0; l < functions_; ++l) g[m] -= trace_[i][m * functions_ + l] * u[l];
}

void FacePieces::subtract_lift(const LiftInCell::Series& q, std::vector<double>& delta) const {
  for (int m = 0; m <= count; ++m)
    for (int j = 0; j < modes; ++j) delta[m] -= s(m) * (1 - s(m)) * q[j] * legendre_[m * modes + j];
}

double FacePieces::energy(const std::vector<double>& rho, const double (&a)[2], const double (&b)[2], const double (&c)[2]) {
  const double e[2] = {b[0] - a[0], b[1] - a[1]}, d[2] = {c[0] - a[0], c[1] - a[1]};
  const double length2 = e[0] * e[0] + e[1] * e[1], twice_area = std::abs(e[0] * d[1] - e[1] * d[0]);
  const double foot = (e[0] * d[0] + e[1] * d[1]) / length2, height2 = twice_area * twice_area / length2;
  double sum = 0;
  for (int m = 0; m < count; ++m) {
    const double slope = count * (rho[m + 1] - rho[m]), mean = 0.5 * (rho[m] + rho[m + 1]);
    const double across = slope * (0.5 * (s(m) + s(m + 1)) - foot) - mean;
    sum += (slope * slope / length2 + across * across / height2) / count;
  }
  return 0.5 * twice_area * sum;
}

}  // namespace thixis::bound
