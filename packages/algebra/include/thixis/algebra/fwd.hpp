#pragma once
/// The Tpetra types that Thixis uses, declared without a Tpetra header: one scalar, one pair of ordinals, the default node.
/// `src/aliases.cpp` proves that they are Tpetra's own defaults.
#include <Teuchos_RCPDecl.hpp>

#include "thixis/algebra/compat.hpp"
#include "thixis/core/types.hpp"

namespace Tpetra {
template <class LO, class GO, class Node>
class Map;
template <class S, class LO, class GO, class Node>
class Vector;
template <class S, class LO, class GO, class Node>
class MultiVector;
template <class S, class LO, class GO, class Node>
class CrsMatrix;
template <class S, class LO, class GO, class Node>
class Operator;
template <class LO, class GO, class Node>
class CrsGraph;
template <class LO, class GO, class Node>
class Import;
}  // namespace Tpetra

namespace thixis::algebra {
#ifdef KOKKOS_ENABLE_OPENMP
using Node = compat::KokkosDeviceWrapperNode<Kokkos::OpenMP, Kokkos::HostSpace>;
#else
using Node = compat::KokkosDeviceWrapperNode<Kokkos::Serial, Kokkos::HostSpace>;
#endif
using Map = Tpetra::Map<LocalIndex, GlobalIndex, Node>;
using Vector = Tpetra::Vector<double, LocalIndex, GlobalIndex, Node>;
using MultiVector = Tpetra::MultiVector<double, LocalIndex, GlobalIndex, Node>;
using Matrix = Tpetra::CrsMatrix<double, LocalIndex, GlobalIndex, Node>;
using Operator = Tpetra::Operator<double, LocalIndex, GlobalIndex, Node>;
using Graph = Tpetra::CrsGraph<LocalIndex, GlobalIndex, Node>;
using Import = Tpetra::Import<LocalIndex, GlobalIndex, Node>;
using MapPtr = Teuchos::RCP<const Map>;
using GraphPtr = Teuchos::RCP<const Graph>;
using MatrixPtr = Teuchos::RCP<Matrix>;
}  // namespace thixis::algebra
