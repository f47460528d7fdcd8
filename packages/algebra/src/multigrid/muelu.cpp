#include "multigrid/muelu.hpp"

#include <MueLu_CreateTpetraPreconditioner.hpp>
#include <limits>

#include "thixis/algebra/tpetra.hpp"

namespace thixis::algebra {
namespace {

/// Levels with fewer rows per rank than this move to fewer ranks. As it is larger than `coarse_rows`, the coarsest level lives on one rank,
/// where KLU2 can be trusted (on several it can not).
constexpr int rows_per_rank = 2000;

/// MueLu validates the names.
Teuchos::ParameterList options(int fields, int ranks, const Teuchos::RCP<const MultiVector>& coordinates) {
  Teuchos::ParameterList list;
  list.set("verbosity", "none");
  list.set("multigrid algorithm", "sa");
  list.set("number of equations", fields);
  list.set("coarse: max size", coarse_rows);
  list.set("smoother: type", "CHEBYSHEV");
  // The smoother is definite only below its bound on the eigenvalues. Ten power iterations and 10 % on top, the defaults, fall short of the
  // largest one on unstructured meshes.
  auto& smoother = list.sublist("smoother: params");
  smoother.set("chebyshev: degree", 3);
  smoother.set("chebyshev: eigenvalue max iterations", 20);
  smoother.set("chebyshev: boost factor", 1.2);
  if (ranks == 1) return list;
  list.set("repartition: enable", true);
  list.set("repartition: partitioner", "zoltan2");
  list.set("repartition: start level", 1);
  // Cutting into several parts needs coordinates; moving all to one rank does not.
  const bool cut = !coordinates.is_null();
  list.set("repartition: min rows per proc", cut ? rows_per_rank : std::numeric_limits<int>::max());
  list.sublist("repartition: params").set("algorithm", std::string(cut ? "multijagged" : "block"));
  if (cut) list.sublist("user data").set("Coordinates", Teuchos::rcp_const_cast<MultiVector>(coordinates));
  return list;
}

}  // namespace

extern "C" MueluCycle thixis_muelu_cycle;

void thixis_muelu_cycle(const Teuchos::RCP<Matrix>& A, int fields, const Teuchos::RCP<const MultiVector>& coordinates,
                        Teuchos::RCP<const Operator>& cycle) {
  auto list = options(fields, A->getComm()->getSize(), coordinates);
  cycle = MueLu::CreateTpetraPreconditioner(Teuchos::RCP<Operator>(A), list);
}

}  // namespace thixis::algebra
