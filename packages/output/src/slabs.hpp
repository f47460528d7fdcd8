#pragma once
#include <string>
#include <vector>

#include "thixis/core/comm.hpp"
#include "thixis/core/types.hpp"

namespace thixis::output {

/// Consecutive rows of an array with `total` rows, those of one rank. Slabs of ranks follow each other, the last ones may be empty.
struct Slab {
  GlobalIndex begin = 0, size = 0, total = 0;
};

/// Brings values of owned entities, whose ids are scattered over 0..total-1, to the slabs in which they are consecutive. One
/// MPI_Alltoallv per array: then every rank writes one contiguous piece of a file.
class SlabExchange {
 public:
  /// Collective. Throws an Error on all ranks unless each id has exactly one owner; `entity` is the word for it in the sentence.
  SlabExchange(const std::vector<GlobalIndex>& id, const std::vector<int>& owner, GlobalIndex total, const std::string& entity,
               const core::Comm& comm);

  const Slab& slab() const { return slab_; }

  /// values [local entities][components] -> [slab.size][columns], columns >= components, the further ones 0. Collective.
  std::vector<double> operator()(const double* values, int components, int columns) const;
  std::vector<GlobalIndex> operator()(const GlobalIndex* values, int components, int columns) const;

 private:
  template <class T>
  std::vector<T> exchange(const T* values, int components, int columns, MPI_Datatype type) const;

  core::Comm comm_;
  Slab slab_;
  std::vector<LocalIndex> sent_;                                                    ///< local entities in the order of their targets
  std::vector<GlobalIndex> received_;                                               ///< rows of the slab in the order in which they arrive
  std::vector<int> send_counts_, send_offsets_, receive_counts_, receive_offsets_;  ///< of entities, by rank
};

}  // namespace thixis::output
