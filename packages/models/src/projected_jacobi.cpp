#include "projected_jacobi.hpp"

namespace thixis::models {
namespace {

constexpr double damping = 2.0 / 3;

template <class In, class Out>
struct Sweep {
  int count;
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
    const double below = count == 2 ? balanced[1] : psi(l, 0);
    const bool contact = balanced[0] <= below;
    const double together = count == 2 ? (diagonal[0] * balanced[0] + diagonal[1] * below) / (diagonal[0] + diagonal[1]) : below;
    x(l, 0) = contact ? together : balanced[0];
    if (count == 2) x(l, 1) = contact ? together : below;
    lambda(l, 0) = contact ? diagonal[0] * (together - balanced[0]) / (damping * D(l, 0)) : 0;
  }
};

}  // namespace

void projected_jacobi(const MembraneOperator& membranes, int sweeps, Fields& x) {
  algebra::MultiVector ghosted(membranes.matrix[0]->getColMap(), membranes.count);
  const auto import = membranes.matrix[0]->getGraph()->getImporter();
  const auto read = [](const algebra::MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadOnly); };
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    if (import.is_null()) ghosted.assign(x.u);
    else ghosted.doImport(x.u, *import, Tpetra::INSERT);
    const auto u = read(ghosted);
    const auto out = x.u.getLocalViewDevice(Tpetra::Access::ReadWrite);
    Sweep<std::decay_t<decltype(u)>, std::decay_t<decltype(out)>> kernel{membranes.count,
                                                                         {},
                                                                         {membranes.factor[0], membranes.factor[1]},
                                                                         u,
                                                                         {},
                                                                         read(*membranes.pairing),
                                                                         {},
                                                                         out,
                                                                         x.lambda.getLocalViewDevice(Tpetra::Access::OverwriteAll)};
    for (int alpha = 0; alpha < membranes.count; ++alpha) {
      kernel.S[alpha] = membranes.matrix[alpha]->getLocalMatrixDevice();
      kernel.F[alpha] = read(*membranes.load[alpha]);
    }
    if (membranes.count == 1) kernel.psi = read(*membranes.obstacle);
    Kokkos::parallel_for("thixis::models::projected_jacobi",
                         Kokkos::RangePolicy<algebra::Vector::execution_space>(0, kernel.lambda.extent_int(0)), kernel);
  }
}

}  // namespace thixis::models
