#include "multiplier/least_squares.hpp"

#include <algorithm>
#include <cmath>

#include "multiplier/multiplier_fits.hpp"

namespace thixis::bound {

bool append_fit(const std::vector<double>& A, LocalIndex rows, int n, std::vector<double>& fit) {
  double scale = 0;
  for (const double value : A) scale = std::max(scale, std::abs(value));
  double normal[most_coefficients][2 * most_coefficients] = {};
  for (int i = 0; i < n; ++i) {
    normal[i][n + i] = 1;
    for (int j = 0; j < n; ++j)
      for (LocalIndex l = 0; l < rows; ++l) normal[i][j] += A[l * n + i] * A[l * n + j] / (scale * scale);
  }
  for (int k = 0; k < n; ++k) {  // Gauss–Jordan: the matrix is symmetric and positive, or the patch has no fit
    if (!(normal[k][k] > 1e-9)) return false;
    const double pivot = normal[k][k];
    for (int j = 0; j < 2 * n; ++j) normal[k][j] /= pivot;
    for (int i = 0; i < n; ++i) {
      const double factor = normal[i][k];
      if (i == k || factor == 0) continue;
      for (int j = 0; j < 2 * n; ++j) normal[i][j] -= factor * normal[k][j];
    }
  }
  for (int b = 0; b < n; ++b)
    for (LocalIndex l = 0; l < rows; ++l) {
      double sum = 0;
      for (int j = 0; j < n; ++j) sum += normal[b][n + j] * A[l * n + j];
      fit.push_back(sum / (scale * scale));
    }
  return true;
}

}  // namespace thixis::bound
