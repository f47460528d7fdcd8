#include "thixis/contact/block_operator.hpp"

#include <algorithm>

#include "thixis/algebra/tpetra.hpp"

namespace thixis::contact {
namespace {

using algebra::MultiVector;

/// The fields that matrix_k acts on, first to last; none: {0, 0}.
struct Acting {
  int begin = most_fields, end = 0;
  explicit Acting(const Small& weight, int fields) {
    for (int i = 0; i < fields; ++i)
      for (int j = 0; j < fields; ++j)
        if (weight(i, j) != 0) {
          begin = std::min(begin, j);
          end = std::max(end, j + 1);
        }
  }
  bool any() const { return begin < end; }
  Teuchos::Range1D columns() const { return {begin, end - 1}; }
};

}  // namespace

algebra::MapPtr BlockOperator::map() const { return matrix[0]->getRowMap(); }

bool BlockOperator::diagonal() const {
  for (const Small& c : weight)
    for (int i = 0; i < fields; ++i)
      for (int j = 0; j < fields; ++j)
        if (i != j && c(i, j) != 0) return false;
  return true;
}

void BlockOperator::apply(const MultiVector& u, MultiVector& y, MultiVector& product) const {
  y.putScalar(0);
  for (std::size_t k = 0; k < matrix.size(); ++k) {
    const Acting acting(weight[k], fields);
    if (!acting.any()) continue;
    matrix[k]->apply(*u.subView(acting.columns()), *product.subViewNonConst(acting.columns()));
    const auto Au = product.getLocalViewDevice(Tpetra::Access::ReadOnly);
    const auto out = y.getLocalViewDevice(Tpetra::Access::ReadWrite);
    const Small c = weight[k];
    const int m = fields, begin = acting.begin, end = acting.end;
    Kokkos::parallel_for(
        "thixis::contact::blocks", Kokkos::RangePolicy<algebra::Vector::execution_space>(0, out.extent_int(0)), KOKKOS_LAMBDA(int l) {
          for (int i = 0; i < m; ++i)
            for (int j = begin; j < end; ++j) out(l, i) += c(i, j) * Au(l, j);
        });
  }
}

void BlockOperator::diagonals(MultiVector& d) const {
  algebra::Vector of_matrix(map());
  d.putScalar(0);
  for (std::size_t k = 0; k < matrix.size(); ++k) {
    matrix[k]->getLocalDiagCopy(of_matrix);
    for (int i = 0; i < fields; ++i)
      if (weight[k](i, i) != 0) d.getVectorNonConst(i)->update(weight[k](i, i), of_matrix, 1);
  }
}

}  // namespace thixis::contact
