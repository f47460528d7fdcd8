#include "projected_jacobi.hpp"

namespace thixis::models {
namespace {

constexpr double damping = 2.0 / 3;

template <class In, class Out>
struct Sweep {
  algebra::Matrix::local_matrix_device_type S[2];
  double factor[2];
  In u;  ///< two columns, ghosts included
  In F[2], D;
  Out x;  ///< out: u1, u2, lambda

  KOKKOS_FUNCTION void operator()(int l) const {
    double balanced[2], diagonal[2] = {0, 0};
    for (int alpha = 0; alpha < 2; ++alpha) {
      double force = F[alpha](l, 0);
      for (std::size_t e = S[alpha].graph.row_map(l); e < S[alpha].graph.row_map(l + 1); ++e) {
        const LocalIndex m = S[alpha].graph.entries(e);
        const double value = factor[alpha] * S[alpha].values(e);
        force -= value * u(m, alpha);
        if (m == l) diagonal[alpha] = value;
      }
      balanced[alpha] = u(l, alpha) + damping * force / diagonal[alpha];
    }
    const bool contact = balanced[0] <= balanced[1];
    const double together = (diagonal[0] * balanced[0] + diagonal[1] * balanced[1]) / (diagonal[0] + diagonal[1]);
    x(l, 0) = contact ? together : balanced[0];
    x(l, 1) = contact ? together : balanced[1];
    x(l, 2) = contact ? diagonal[0] * (together - balanced[0]) / (damping * D(l, 0)) : 0;
  }
};

}  // namespace

void projected_jacobi(const MembraneOperator& membranes, int sweeps, algebra::MultiVector& x) {
  algebra::MultiVector ghosted(membranes.matrix[0]->getColMap(), 2);
  const auto import = membranes.matrix[0]->getGraph()->getImporter();
  const auto read = [](const algebra::MultiVector& v) { return v.getLocalViewDevice(Tpetra::Access::ReadOnly); };
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    {
      const auto owned = x.subView(Teuchos::Range1D(0, 1));
      if (import.is_null()) ghosted.assign(*owned);
      else ghosted.doImport(*owned, *import, Tpetra::INSERT);
    }
    const auto u = read(ghosted);
    const auto out = x.getLocalViewDevice(Tpetra::Access::ReadWrite);
    Kokkos::parallel_for("thixis::models::projected_jacobi", Kokkos::RangePolicy<algebra::Vector::execution_space>(0, out.extent_int(0)),
                         Sweep<std::decay_t<decltype(u)>, std::decay_t<decltype(out)>>{
                             {membranes.matrix[0]->getLocalMatrixDevice(), membranes.matrix[1]->getLocalMatrixDevice()},
                             {membranes.factor[0], membranes.factor[1]},
                             u,
                             {read(*membranes.load[0]), read(*membranes.load[1])},
                             read(*membranes.pairing),
                             out});
  }
}

}  // namespace thixis::models
