#include "lift/lift_tables.hpp"

#include <cmath>

namespace thixis::bound {
namespace {

constexpr int modes = LiftInCell::resolution + 1;

/// out(point) += table (point, ·) · c
void add_product(const std::vector<double>& table, int columns, const double* c, std::vector<double>& out) {
  const double* row = table.data();
  for (double& sum : out) {
    for (int k = 0; k < columns; ++k) sum += row[k] * c[k];
    row += columns;
  }
}

}  // namespace

std::array<double, 2> series(const LiftInCell::Series& q, double s) {
  const double x = 2 * s - 1;
  double P[3] = {0, 1, x}, dP[3] = {0, 0, 1}, value = q[0], slope = 0;  // of degrees j-2, j-1, j
  for (int j = 1; j < modes; ++j) {
    if (j > 1) {
      P[2] = ((2 * j - 1) * x * P[1] - (j - 1) * P[0]) / j;
      dP[2] = dP[0] + (2 * j - 1) * P[1];
    }
    const double norm = std::sqrt(2.0 * j + 1);
    value += q[j] * norm * P[2];
    slope += 2 * q[j] * norm * dP[2];
    for (int i = 0; i < 2; ++i) {
      P[i] = P[i + 1];
      dP[i] = dP[i + 1];
    }
  }
  return {value, slope};
}

LiftTable::LiftTable(const reference::Bernstein& of_v, const View<const double* [2]>& at) : points_(at.extent_int(0)), size_(of_v.size) {
  const auto xi = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), at);
  for (auto& table : v_) table.resize(points_ * size_);
  for (auto& face : of_face_)
    for (auto& table : face) table.resize(points_ * modes);
  for (int q = 0; q < points_; ++q) {
    const double lambda[3] = {1 - xi(q, 0) - xi(q, 1), xi(q, 0), xi(q, 1)};
    double B[reference::max_functions], dB[reference::max_functions][3];
    of_v.values(lambda, B);
    of_v.derivatives(lambda, dB);
    for (int k = 0; k < size_; ++k) {
      v_[0][q * size_ + k] = B[k];
      for (int d = 1; d < 3; ++d) v_[d][q * size_ + k] = dB[k][d] - dB[k][0];
    }
    for (int i = 0; i < 3; ++i)
      for (int m = 0; m < modes; ++m) {
        LiftInCell::Series unit = {};
        unit[m] = 1;
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const auto [L, slope] = series(unit, lambda[k] + 0.5 * lambda[i]);
        double derivative[3];  // in lambda_i, lambda_j, lambda_k as if independent
        derivative[i] = 0.5 * lambda[j] * lambda[k] * slope;
        derivative[j] = lambda[k] * L;
        derivative[k] = lambda[j] * L + lambda[j] * lambda[k] * slope;
        of_face_[i][0][q * modes + m] = lambda[j] * lambda[k] * L;
        for (int d = 1; d < 3; ++d) of_face_[i][d][q * modes + m] = derivative[d] - derivative[0];
      }
  }
}

void LiftTable::evaluate(const LiftInCell& lift, std::vector<double> (&out)[3]) const {
  for (int d = 0; d < 3; ++d) {
    out[d].assign(points_, 0.0);
    add_product(v_[d], size_, lift.v.data(), out[d]);
    for (int f = 0; f < lift.faces; ++f) add_product(of_face_[lift.face[f]][d], modes, lift.q[f].data(), out[d]);
  }
}

}  // namespace thixis::bound
