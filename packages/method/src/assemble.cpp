#include "thixis/method/assemble.hpp"

#include <algorithm>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/method/gradient_form.hpp"

namespace thixis::method {

algebra::MatrixPtr assemble(const core::Comm& comm, const algebra::GraphPtr& graph, const ElementUnknowns& elements, const CellForm& form) {
  const auto A = Teuchos::rcp(new algebra::Matrix(graph));
  A->fillComplete();
  const int n = elements.extent_int(1);
  const LocalIndex count = elements.extent_int(0), most = std::min(cells_per_block(n), count);
  const LocalMatrices local("thixis::method::local_matrices", most, n, n);
  comm.together([&] {
    for (LocalIndex first = 0; first < count; first += most) {
      const LocalMatrices block = Kokkos::subview(local, std::pair(0, std::min(most, count - first)), Kokkos::ALL, Kokkos::ALL);
      form.matrices(first, block);
      scatter(elements, first, block, *A);
    }
  });
  return A;
}

}  // namespace thixis::method
