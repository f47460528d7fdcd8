/// fwd.hpp names Tpetra's classes without their headers; this file proves that the names mean Tpetra's defaults.
#include <type_traits>

#include "thixis/algebra/tpetra.hpp"

namespace thixis::algebra {
static_assert(std::is_same_v<Node, Tpetra::Map<>::node_type>);
static_assert(std::is_same_v<LocalIndex, Tpetra::Map<>::local_ordinal_type>);
static_assert(std::is_same_v<GlobalIndex, Tpetra::Map<>::global_ordinal_type>);
static_assert(std::is_same_v<Map, Tpetra::Map<>>);
static_assert(std::is_same_v<Vector, Tpetra::Vector<>>);
static_assert(std::is_same_v<MultiVector, Tpetra::MultiVector<>>);
static_assert(std::is_same_v<Matrix, Tpetra::CrsMatrix<>>);
static_assert(std::is_same_v<Operator, Tpetra::Operator<>>);
static_assert(std::is_same_v<Graph, Tpetra::CrsGraph<>>);
static_assert(std::is_same_v<Import, Tpetra::Import<>>);
}  // namespace thixis::algebra
