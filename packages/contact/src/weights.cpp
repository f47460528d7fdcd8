#include "thixis/contact/weights.hpp"

#include "thixis/algebra/tpetra.hpp"

namespace thixis::contact {

using algebra::MultiVector;

Teuchos::RCP<const MultiVector> stiffness_of_gaps(const System& system, const MultiVector& diagonals) {
  auto stiffness = Teuchos::rcp(new MultiVector(system.points(), system.gaps()));
  const auto S = diagonals.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto kappa = stiffness->getLocalViewDevice(Tpetra::Access::OverwriteAll);
  const auto node = system.constraint.node;
  const auto frames = system.constraint.frames;
  const int m = system.fields(), q = system.gaps();
  Kokkos::parallel_for(
      "thixis::contact::stiffness", Kokkos::RangePolicy<algebra::Vector::execution_space>(0, kappa.extent_int(0)), KOKKOS_LAMBDA(int p) {
        const LocalIndex l = node(p);
        const Small& Q = frames.inverse(frames.at(l));
        for (int g = 0; g < q; ++g) {
          double softness = 0;
          for (int i = 0; i < m; ++i) softness += Q(m - q + g, i) * Q(m - q + g, i) / S(l, i);
          kappa(p, g) = 1 / softness;
        }
      });
  return stiffness;
}

}  // namespace thixis::contact
