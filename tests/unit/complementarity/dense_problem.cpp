#include "dense_problem.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <limits>

#include "views.hpp"

namespace thixis::complementarity::test {
namespace {

Values second_difference(int n, double factor) {  // factor/h tridiag(-1, 2, -1) on the n - 1 interior points
  const int m = n - 1;
  Values S(static_cast<std::size_t>(m) * m, 0.0);
  for (int i = 0; i < m; ++i) {
    S[i * m + i] = 2 * factor * n;
    if (i > 0) S[i * m + i - 1] = -factor * n;
    if (i + 1 < m) S[i * m + i + 1] = -factor * n;
  }
  return S;
}

double gap_of_string(double d) { return d < 0.25 ? 4 * (d - 0.25) * (d - 0.25) : 0.0; }
double distance_to_end(int n, int point) { return std::min(point + 1, n - 1 - point) / static_cast<double>(n); }

}  // namespace

Values eliminate(Values A, Values b) {
  const int n = static_cast<int>(b.size());
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(A[i * n + k]) > std::abs(A[pivot * n + k])) pivot = i;
    std::swap_ranges(A.begin() + k * n, A.begin() + (k + 1) * n, A.begin() + pivot * n);
    std::swap(b[k], b[pivot]);
    for (int i = k + 1; i < n; ++i) {
      const double factor = A[i * n + k] / A[k * n + k];
      if (factor == 0) continue;
      for (int j = k; j < n; ++j) A[i * n + j] -= factor * A[k * n + j];
      b[i] -= factor * b[k];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int j = k + 1; j < n; ++j) b[k] -= A[k * n + j] * b[j];
    b[k] /= A[k * n + k];
  }
  return b;
}

DenseProblem::DenseProblem(DenseData data) : data_(std::move(data)) {
  const auto comm = Tpetra::getDefaultComm();
  points_ = Teuchos::rcp(new algebra::Map(data_.n, 0, comm));
  own_ = algebra::local_size(*points_);
  first_ = own_ > 0 ? static_cast<int>(points_->getMinGlobalIndex()) : 0;
  map_ = Teuchos::rcp(new algebra::Map(data_.fields() * data_.n, data_.fields() * own_, 0, comm));
}

Values DenseProblem::gather(const algebra::Vector& X) const {
  const auto own = X.getData();
  return comm_of(*X.getMap()).gather(Values(own.begin(), own.end()));
}

algebra::Vector DenseProblem::vector(const std::function<double(int, int)>& value) const {
  algebra::Vector X(map_);
  auto x = X.getDataNonConst();
  for (int i = 0; i < own_; ++i)
    for (int f = 0; f < data_.fields(); ++f) x[data_.fields() * i + f] = value(f, first_ + i);
  return X;
}

void DenseProblem::equations(const algebra::Vector& X, algebra::Vector& R) const {
  ++equations_asked;
  const Values x = gather(X);
  const int n = data_.n, fields = data_.fields();
  auto r = R.getDataNonConst();
  for (int l = 0; l < own_; ++l) {
    const int i = first_ + l;
    for (int body = 0; body + 1 < fields; ++body) {
      const double u = x[fields * i + body], sign = body == 0 ? -1 : 1;
      double row = data_.cubic * u * u * u + sign * data_.D[i] * x[fields * i + fields - 1] - data_.F[body][i];
      for (int j = 0; j < n; ++j) row += data_.M[body][i * n + j] * x[fields * j + body];
      r[fields * l + body] = spoil ? spoil(row) : row;
    }
    r[fields * l + fields - 1] = 0;
  }
}

void DenseProblem::arguments(const algebra::Vector& X, algebra::Vector& K, algebra::Vector& G) const {
  const int fields = data_.fields();
  const auto x = X.getData();
  auto k = K.getDataNonConst(), g = G.getDataNonConst();
  for (int l = 0; l < own_; ++l) {
    k[l] = x[fields * l] - (fields == 2 ? data_.psi[first_ + l] : x[fields * l + 1]);
    g[l] = x[fields * l + fields - 1];
  }
}

void DenseProblem::scaling(algebra::Vector& s) const {
  auto own = s.getDataNonConst();
  for (int l = 0; l < own_; ++l) own[l] = data_.scaling[first_ + l];
}

void DenseProblem::insert(const algebra::Vector& C, algebra::Vector& R) const {
  const auto c = C.getData();
  auto r = R.getDataNonConst();
  for (int l = 0; l < own_; ++l) r[data_.fields() * l + data_.fields() - 1] = c[l];
}

void DenseProblem::linearize(const algebra::Vector& X, const algebra::Vector& a, const algebra::Vector& b) {
  const Values x = gather(X), all_a = gather(a), all_b = gather(b);
  const int n = data_.n, fields = data_.fields(), rows = fields * n;
  A_.assign(static_cast<std::size_t>(rows) * rows, 0.0);
  for (int i = 0; i < n; ++i) {
    for (int body = 0; body + 1 < fields; ++body) {
      double* row = &A_[(fields * i + body) * rows];
      for (int j = 0; j < n; ++j) row[fields * j + body] = data_.M[body][i * n + j];
      row[fields * i + body] += 3 * data_.cubic * x[fields * i + body] * x[fields * i + body];
      row[fields * i + fields - 1] = (body == 0 ? -1 : 1) * data_.D[i];
    }
    double* row = &A_[(fields * i + fields - 1) * rows];
    row[fields * i] = all_a[i];
    if (fields == 3) row[fields * i + 1] = -all_a[i];
    row[fields * i + fields - 1] = all_b[i];
  }
}

algebra::LinearReport DenseProblem::solve(const algebra::Vector& R, algebra::Vector& dX, const algebra::LinearStop& stop) {
  tolerances.push_back(stop.tolerance);
  const Values exact = eliminate(A_, gather(R));
  const double start = R.norm2();
  algebra::LinearReport report;
  const auto put = [&](double part) {
    auto own = dX.getDataNonConst();
    const int offset = data_.fields() * first_;
    for (int l = 0; l < data_.fields() * own_; ++l)
      own[l] = linear.gives_nan ? std::numeric_limits<double>::quiet_NaN() : -linear.overshoot * part * exact[offset + l];
  };
  double left = 1;
  report.residual = start;
  report.converged = start <= stop.tolerance;
  put(0);
  for (int i = 1; i <= linear.max_iterations && !report.converged; ++i) {
    left *= linear.rate;
    report.iterations = i;
    report.residual = left * start;
    put(1 - left);
    if (report.residual <= stop.tolerance) {
      report.converged = true;
      break;
    }
    if (stop.check_every > 0 && i % stop.check_every == 0 && stop.criterion && stop.criterion(dX, i, report.residual)) {
      report.converged = report.by_criterion = true;
      break;
    }
  }
  if (!report.converged) report.reason = "too few iterations";
  if (linear.gives_nan) report.reason = linear.reason;
  return report;
}

double DenseProblem::reference_norm() const {
  double sum = 0;
  for (const Values& F : data_.F)
    for (const double f : F) sum += f * f;
  return std::sqrt(sum);
}

DenseData string_over_obstacle(int n, double length, double tension) {
  DenseData data;
  const double h = 1.0 / n;
  data.n = n - 1;
  data.M = {second_difference(n, tension)};
  data.F = {Values(data.n, -8 * length * tension * h)};
  data.psi.assign(data.n, -0.25 * length);
  data.D.assign(data.n, h);
  data.scaling.assign(data.n, h * h / (2 * tension));  // D_l / (μ S_ll)
  return data;
}

double string_solution(int n, int field, int point, double length, double tension) {
  const double d = distance_to_end(n, point);
  if (field == 0) return length * (gap_of_string(d) - 0.25);
  return length * tension * (d > 0.25 ? 8 : d == 0.25 ? 4 : 0);
}

/// z'' = 8 where free, w'' = -2 everywhere: f_1 = -μ_1 u_1'' - λ, f_2 = -μ_2 u_2'' + λ with u_1 = (w + 3 z)/5, u_2 = (w - 2 z)/5.
DenseData two_strings(int n) {
  DenseData data;
  const double h = 1.0 / n, mu[2] = {2, 3};
  data.n = n - 1;
  data.M = {second_difference(n, mu[0]), second_difference(n, mu[1])};
  const double f1 = -mu[0] * (-2 + 3 * 8) / 5, f2 = -mu[1] * (-2 - 2 * 8) / 5;
  data.F = {Values(data.n, f1 * h), Values(data.n, f2 * h)};
  const double w = 0.5, z = 0.25, end[2] = {(w + 3 * z) / 5, (w - 2 * z) / 5};
  for (int body = 0; body < 2; ++body)
    for (const int i : {0, data.n - 1}) data.F[body][i] += mu[body] / h * end[body];
  data.D.assign(data.n, h);
  data.scaling.assign(data.n, (1 / mu[0] + 1 / mu[1]) * h * h / 2);
  return data;
}

double two_strings_solution(int n, int field, int point) {
  const double x = (point + 1.0) / n, d = distance_to_end(n, point), z = gap_of_string(d), w = 0.5 + x * (1 - x);
  if (field == 0) return (w + 3 * z) / 5;
  if (field == 1) return (w - 2 * z) / 5;
  return 8.0 * 6 / 5 * (d > 0.25 ? 1.0 : d == 0.25 ? 0.5 : 0.0);
}

DenseData linear_complementarity(const Values& M, const Values& q) {
  DenseData data;
  data.n = static_cast<int>(q.size());
  data.M = {M};
  data.F = {q};
  for (double& f : data.F[0]) f = -f;
  data.psi.assign(data.n, 0);
  data.D.assign(data.n, 1);
  data.scaling.assign(data.n, 1);
  return data;
}

}  // namespace thixis::complementarity::test
