#include "thixis/contact/projected_jacobi.hpp"

#include <algorithm>

#include "constrained_solver.hpp"

namespace thixis::contact {
namespace {

using algebra::MultiVector;
using Range = Kokkos::RangePolicy<algebra::Vector::execution_space>;

/// Estimate of the largest eigenvalue of diag(S)^{-1} S, a little too small.
double largest_eigenvalue(const algebra::Matrix& S) {
  algebra::Vector diagonal(S.getRowMap()), inverse(S.getRowMap()), v(S.getRowMap()), w(S.getRowMap());
  S.getLocalDiagCopy(diagonal);
  inverse.reciprocal(diagonal);
  {  // anything rough
    const auto out = v.getLocalViewDevice(Tpetra::Access::OverwriteAll);
    Kokkos::parallel_for(
        "thixis::contact::rough", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int l) { out(l, 0) = l % 2 == 0 ? 1 : -0.7; });
  }
  double value = 0;
  for (int k = 0; k < 12; ++k) {
    const double length = v.norm2();
    if (!(length > 0)) return 0;
    v.scale(1 / length);
    S.apply(v, w);
    v.elementWiseMultiply(1, inverse, w, 0);
    value = v.norm2();
  }
  return value;
}

/// mu >= 0 with K + M mu >= 0 and mu (K + M mu) = 0, for gaps that narrow each other as they are pressed apart, M_gh <= 0: who is added
/// stays.
struct Closing {
  int gaps;
  Small M;
  double K[most_fields], mu[most_fields];
  bool closed[most_fields];

  KOKKOS_FUNCTION double opened(int g) const {
    double sum = K[g];
    for (int h = 0; h < gaps; ++h) sum += M(g, h) * mu[h];
    return sum;
  }
  KOKKOS_FUNCTION bool add() {
    bool added = false;
    for (int g = 0; g < gaps; ++g)
      if (!closed[g] && opened(g) <= 0) added = closed[g] = true;
    return added;
  }
  /// Elimination without pivoting: M is positive definite.
  KOKKOS_FUNCTION void close() {
    Small A = M;
    double x[most_fields] = {};
    for (int g = 0; g < gaps; ++g) {
      x[g] = closed[g] ? -K[g] : 0;
      for (int h = 0; h < gaps; ++h)
        if (!closed[g] || !closed[h]) A(g, h) = g == h ? 1 : 0;
    }
    for (int g = 0; g < gaps; ++g)
      for (int h = g + 1; h < gaps; ++h) {
        const double factor = A(h, g) / A(g, g);
        for (int k = g; k < gaps; ++k) A(h, k) -= factor * A(g, k);
        x[h] -= factor * x[g];
      }
    for (int g = gaps - 1; g >= 0; --g) {
      for (int h = g + 1; h < gaps; ++h) x[g] -= A(g, h) * mu[h];
      mu[g] = x[g] / A(g, g);
    }
  }
  KOKKOS_FUNCTION void solve() {
    for (int g = 0; g < gaps; ++g) {
      mu[g] = 0;
      closed[g] = false;
    }
    while (add()) close();
  }
};

template <class In, class Out>
struct Sweep {
  int fields, gaps, matrices;
  double damping;
  LocalMatrix S[most_matrices];
  Small c[most_matrices];
  Frames frames;
  Kokkos::View<const LocalIndex*> point;  ///< of each node, or -1
  In u;                                   ///< ghosts included
  In F, D, offset;
  Out x, lambda;  ///< out

  /// (A u)_l of N fields; returns A_ll.
  template <int N>
  KOKKOS_FUNCTION double product(const LocalMatrix& A, int l, double* sum) const {
    double own = 0, s[N] = {};
    for (std::size_t e = A.graph.row_map(l); e < A.graph.row_map(l + 1); ++e) {
      const LocalIndex m = A.graph.entries(e);
      const double value = A.values(e);
      for (int j = 0; j < N; ++j) s[j] += value * u(m, j);
      if (m == l) own = value;
    }
    for (int j = 0; j < N; ++j) sum[j] = s[j];
    return own;
  }
  KOKKOS_FUNCTION void balance(int l, double* balanced, double* diagonal) const {
    double force[most_fields], sum[most_fields];
    for (int i = 0; i < fields; ++i) {
      force[i] = F(l, i);
      diagonal[i] = 0;
    }
    for (int k = 0; k < matrices; ++k) {
      const double own = fields == 1 ? product<1>(S[k], l, sum) : fields == 2 ? product<2>(S[k], l, sum) : product<3>(S[k], l, sum);
      for (int i = 0; i < fields; ++i) {
        for (int j = 0; j < fields; ++j) force[i] -= c[k](i, j) * sum[j];
        diagonal[i] += c[k](i, i) * own;
      }
    }
    for (int i = 0; i < fields; ++i) balanced[i] = u(l, i) + damping * force[i] / diagonal[i];
  }
  KOKKOS_FUNCTION void operator()(int l) const {
    double balanced[most_fields], diagonal[most_fields];
    balance(l, balanced, diagonal);
    const LocalIndex p = point(l);
    if (p >= 0 && gaps == 1) keep_one_apart(l, p, balanced, diagonal);
    else if (p >= 0) keep_apart(l, p, balanced, diagonal);
    for (int i = 0; i < fields; ++i) x(l, i) = balanced[i];
  }
  /// The same for a single gap: mu = max(0, -K/M).
  KOKKOS_FUNCTION void keep_one_apart(int l, LocalIndex p, double* balanced, const double* diagonal) const {
    const int last = fields - 1, kind = frames.at(l);
    const Small &T = frames.T(kind), &Q = frames.inverse(kind);
    const double k0 = offset.extent(0) > 0 ? offset(p, 0) : 0;
    double K = k0, M = 0;
    for (int i = 0; i < fields; ++i) {
      K += Q(last, i) * balanced[i];
      M += Q(last, i) * Q(last, i) / diagonal[i];
    }
    lambda(p, 0) = 0;
    if (!(K <= 0)) return;
    const double mu = -K / M;
    lambda(p, 0) = mu / (damping * D(p, 0));
    for (int i = 0; i < fields; ++i) balanced[i] += Q(last, i) * mu / diagonal[i];
    double y[most_fields];
    for (int i = 0; i < fields; ++i) {
      y[i] = i == last ? -k0 : 0;
      for (int j = 0; j < fields && i < last; ++j) y[i] += Q(i, j) * balanced[j];
    }
    for (int i = 0; i < fields; ++i) {
      balanced[i] = 0;
      for (int j = 0; j < fields; ++j) balanced[i] += T(i, j) * y[j];
    }
  }
  KOKKOS_FUNCTION void keep_apart(int l, LocalIndex p, double* balanced, const double* diagonal) const {
    const Small& Q = frames.inverse(frames.at(l));
    const int means = fields - gaps;
    Closing closing;
    closing.gaps = gaps;
    for (int g = 0; g < gaps; ++g) {
      closing.K[g] = offset.extent(0) > 0 ? offset(p, g) : 0;
      for (int i = 0; i < fields; ++i) closing.K[g] += Q(means + g, i) * balanced[i];
      for (int h = 0; h < gaps; ++h) {
        closing.M(g, h) = 0;
        for (int i = 0; i < fields; ++i) closing.M(g, h) += Q(means + g, i) * Q(means + h, i) / diagonal[i];
      }
    }
    closing.solve();
    for (int g = 0; g < gaps; ++g) {
      for (int i = 0; i < fields; ++i) balanced[i] += Q(means + g, i) * closing.mu[g] / diagonal[i];
      lambda(p, g) = closing.mu[g] / (damping * D(p, 0));
    }
    shut(l, p, closing, balanced);
  }
  /// Gaps that are closed are so to the last digit: nothing but rounding changes.
  KOKKOS_FUNCTION void shut(int l, LocalIndex p, const Closing& closing, double* u_l) const {
    const Small &T = frames.T(frames.at(l)), &Q = frames.inverse(frames.at(l));
    const int means = fields - gaps;
    double y[most_fields];
    bool any = false;
    for (int i = 0; i < fields; ++i) {
      const bool closed = i >= means && closing.closed[i - means];
      any = any || closed;
      y[i] = closed && offset.extent(0) > 0 ? -offset(p, i - means) : 0;
      for (int j = 0; j < fields && !closed; ++j) y[i] += Q(i, j) * u_l[j];
    }
    for (int i = 0; i < fields && any; ++i) {
      u_l[i] = 0;
      for (int j = 0; j < fields; ++j) u_l[i] += T(i, j) * y[j];
    }
  }
};

}  // namespace

ProjectedJacobi::ProjectedJacobi(const System& system) : system_(system), point_(points_of_nodes(system)) {
  double largest = 0;
  for (const auto& matrix : system.S.matrix) largest = std::max(largest, largest_eigenvalue(*matrix));
  damping_ = largest > 2 ? 4 / (3 * largest) : 2.0 / 3;
}

void ProjectedJacobi::operator()(int sweeps, algebra::Vector& X) const {
  if (sweeps == 0) return;
  MultiVector u_columns = fields_nonconst(system_, X), lambda_columns = multipliers_nonconst(system_, X);
  const auto read = [](const MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadOnly); };
  MultiVector ghosted = at_columns(system_, u_columns);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    if (sweep > 0) to_columns(system_, u_columns, ghosted);
    const auto u = read(ghosted);
    const auto out = u_columns.getLocalViewDevice(Tpetra::Access::ReadWrite);
    Sweep<std::decay_t<decltype(u)>, std::decay_t<decltype(out)>> kernel;
    kernel.fields = system_.fields();
    kernel.gaps = system_.gaps();
    kernel.matrices = static_cast<int>(system_.S.matrix.size());
    kernel.damping = damping_;
    for (int k = 0; k < kernel.matrices; ++k) {
      kernel.S[k] = system_.S.matrix[k]->getLocalMatrixDevice();
      kernel.c[k] = system_.S.weight[k];
    }
    kernel.frames = system_.constraint.frames;
    kernel.point = point_;
    kernel.u = u;
    kernel.F = read(*system_.load);
    kernel.D = read(*system_.constraint.pairing);
    if (!system_.constraint.offset.is_null()) kernel.offset = read(*system_.constraint.offset);
    kernel.x = out;
    kernel.lambda = lambda_columns.getLocalViewDevice(Tpetra::Access::OverwriteAll);
    Kokkos::parallel_for("thixis::contact::projected_jacobi", Range(0, out.extent_int(0)), kernel);
  }
}

}  // namespace thixis::contact
