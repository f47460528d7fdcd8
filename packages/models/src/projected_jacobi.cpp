#include "projected_jacobi.hpp"

#include <algorithm>

namespace thixis::models {
namespace {

/// Estimate of the largest eigenvalue of diag(S)^{-1} S, a little too small.
double largest_eigenvalue(const algebra::Matrix& S) {
  algebra::Vector diagonal(S.getRowMap()), inverse(S.getRowMap()), v(S.getRowMap()), w(S.getRowMap());
  S.getLocalDiagCopy(diagonal);
  inverse.reciprocal(diagonal);
  {  // anything rough
    const auto out = algebra::host_overwrite(v);
    for (std::size_t l = 0; l < out.extent(0); ++l) out(l) = l % 2 == 0 ? 1 : -0.7;
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

template <class In, class Out>
struct Sweep {
  int count;
  double damping;
  algebra::Matrix::local_matrix_device_type S[2];
  double factor[2];
  In u;  ///< a column for each membrane, ghosts included
  In F[2], D;
  In psi;      ///< count = 1
  Out x;       ///< out: u_1, …
  Out lambda;  ///< out

  KOKKOS_FUNCTION void operator()(int l) const {
    double balanced[2], diagonal[2] = {0, 0};
    for (int alpha = 0; alpha < count; ++alpha) {
      double force = F[alpha](l, 0);
      for (std::size_t e = S[alpha].graph.row_map(l); e < S[alpha].graph.row_map(l + 1); ++e) {
        const LocalIndex m = S[alpha].graph.entries(e);
        const double value = factor[alpha] * S[alpha].values(e);
        force -= value * u(m, alpha);
        if (m == l) diagonal[alpha] = value;
      }
      balanced[alpha] = u(l, alpha) + damping * force / diagonal[alpha];
    }
    if (l >= lambda.extent_int(0)) {  // no contact point
      for (int alpha = 0; alpha < count; ++alpha) x(l, alpha) = balanced[alpha];
      return;
    }
    const double below = count == 2 ? balanced[1] : psi(l, 0);
    const bool contact = balanced[0] <= below;
    const double together = count == 2 ? (diagonal[0] * balanced[0] + diagonal[1] * below) / (diagonal[0] + diagonal[1]) : below;
    x(l, 0) = contact ? together : balanced[0];
    if (count == 2) x(l, 1) = contact ? together : below;
    lambda(l, 0) = contact ? diagonal[0] * (together - balanced[0]) / (damping * D(l, 0)) : 0;
  }
};

}  // namespace

ProjectedJacobi::ProjectedJacobi(const MembraneOperator& membranes) : membranes_(membranes) {
  double largest = largest_eigenvalue(*membranes.matrix[0]);
  if (!membranes.shared()) largest = std::max(largest, largest_eigenvalue(*membranes.matrix[1]));
  damping_ = largest > 2 ? 4 / (3 * largest) : 2.0 / 3;
}

void ProjectedJacobi::operator()(int sweeps, Fields& x) const {
  algebra::MultiVector ghosted(membranes_.matrix[0]->getColMap(), membranes_.count);
  const auto import = membranes_.matrix[0]->getGraph()->getImporter();
  const auto read = [](const algebra::MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadOnly); };
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    if (import.is_null()) ghosted.assign(x.u);
    else ghosted.doImport(x.u, *import, Tpetra::INSERT);
    const auto u = read(ghosted);
    const auto out = x.u.getLocalViewDevice(Tpetra::Access::ReadWrite);
    Sweep<std::decay_t<decltype(u)>, std::decay_t<decltype(out)>> kernel{membranes_.count,
                                                                         damping_,
                                                                         {},
                                                                         {membranes_.factor[0], membranes_.factor[1]},
                                                                         u,
                                                                         {},
                                                                         read(*membranes_.pairing),
                                                                         {},
                                                                         out,
                                                                         x.lambda.getLocalViewDevice(Tpetra::Access::OverwriteAll)};
    for (int alpha = 0; alpha < membranes_.count; ++alpha) {
      kernel.S[alpha] = membranes_.matrix[alpha]->getLocalMatrixDevice();
      kernel.F[alpha] = read(*membranes_.load[alpha]);
    }
    if (membranes_.count == 1) kernel.psi = read(*membranes_.obstacle);
    Kokkos::parallel_for("thixis::models::projected_jacobi",
                         Kokkos::RangePolicy<algebra::Vector::execution_space>(0, kernel.x.extent_int(0)), kernel);
  }
}

}  // namespace thixis::models
