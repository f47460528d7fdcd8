#pragma once
#include "thixis/algebra/tpetra.hpp"
#include "thixis/contact/system.hpp"

namespace thixis::contact {

using LocalMatrix = algebra::Matrix::local_matrix_device_type;

/// Some coordinates of each node as unknowns of a linear system: unknown i is y_{coordinate[i]} / stretch[i], and its row is multiplied by
/// stretch[i].
struct Part {
  int size = 0;
  int coordinate[most_fields] = {};
  double stretch[most_fields] = {1, 1, 1};

  KOKKOS_INLINE_FUNCTION int gap(int i, int means) const { return coordinate[i] - means; }  ///< < 0: a mean
};

/// The weights of the blocks of Tᵀ S T between two nodes: block (i, j) = sum_k c_k(i, j) A_k(l, m), for the unknowns of a part.
struct TransformedBlocks {
  int fields, matrices;
  Small weight[most_matrices];
  Frames frames;
  Part part;
  Small uniform[most_matrices];  ///< of frames that are the same everywhere

  TransformedBlocks(const System& system, const Part& part);

  KOKKOS_INLINE_FUNCTION void between(const Small& left, const Small& right, Small* c) const {
    for (int k = 0; k < matrices; ++k)
      for (int i = 0; i < part.size; ++i)
        for (int j = 0; j < part.size; ++j) {
          double sum = 0;
          for (int a = 0; a < fields; ++a)
            for (int b = 0; b < fields; ++b) sum += left(a, part.coordinate[i]) * weight[k](a, b) * right(b, part.coordinate[j]);
          c[k](i, j) = part.stretch[i] * sum * part.stretch[j];
        }
  }
  /// `room` is used where frames differ.
  KOKKOS_INLINE_FUNCTION const Small* at(LocalIndex l, LocalIndex m, Small* room) const {
    if (frames.uniform()) return uniform;
    between(frames.T(frames.at(l)), frames.T(frames.at(m)), room);
    return room;
  }
};

/// What contact makes of the unknowns of a part: gaps that are known, and what free ones add to the diagonal, stretched as the part is.
template <class View>
struct GapsOfPart {
  Part part;
  int means;
  View contact, penalty;  ///< of each gap, at columns as far as they are asked for

  KOKKOS_INLINE_FUNCTION bool known(LocalIndex node, int i) const {
    const int gap = part.gap(i, means);
    return gap >= 0 && contact(node, gap) > 0;
  }
  KOKKOS_INLINE_FUNCTION double added(LocalIndex node, int i) const {
    const int gap = part.gap(i, means);
    return gap >= 0 ? part.stretch[i] * part.stretch[i] * penalty(node, gap) : 0;
  }
};

/// Tᵀ S T, applied.
class TransformedOperator {
 public:
  /// product: room for a column a field, used in calls only.
  TransformedOperator(const System& system, const Teuchos::RCP<algebra::MultiVector>& product);
  /// out <- Tᵀ S T y: one product with each matrix.
  void apply(const algebra::MultiVector& y, algebra::MultiVector& out) const;
  /// The diagonal of the rows `first`, first + 1, …
  void diagonal(int first, algebra::MultiVector& out) const;

 private:
  const System& system_;
  TransformedBlocks blocks_;
  BlockOperator uniform_;  ///< of frames that are the same everywhere: other weights of the same matrices
  Teuchos::RCP<algebra::MultiVector> product_;
  Teuchos::RCP<algebra::MultiVector> u_;  ///< T y, of other frames
};

/// u <- T y, y <- Tᵀ r, and r <- T^{-T} y, node by node; both may be the same columns.
void apply_frames(const System& system, const algebra::MultiVector& y, algebra::MultiVector& u);
void transpose_frames(const System& system, const algebra::MultiVector& r, algebra::MultiVector& y);
void leave_frames(const System& system, const algebra::MultiVector& y, algebra::MultiVector& r);

Part all_coordinates(int fields);

/// The contact point at each node of this rank, or -1.
Kokkos::View<const LocalIndex*> points_of_nodes(const System& system);

}  // namespace thixis::contact
