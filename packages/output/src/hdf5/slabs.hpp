#pragma once
#include <string>
#include <vector>

#include "hdf5/exchange.hpp"

namespace thixis::output {

/// Consecutive rows of an array with `total` rows, those of one rank. Slabs of ranks follow each other.
struct Slab {
  GlobalIndex begin = 0, size = 0, total = 0;
};

/// The number of rows in all slabs that are full when `total` rows are shared evenly, at least 1: row i is in the slab of rank i / height.
GlobalIndex slab_height(GlobalIndex total, const core::Comm& comm);
/// The slab of this rank then; the last ones may be shorter or empty. Not collective.
Slab even_slab(GlobalIndex total, const core::Comm& comm);

/// Brings values of owned entities, whose ids are scattered over 0..total-1, to the slabs in which they are consecutive: then every rank
/// writes one contiguous piece of a file.
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
  std::vector<T> rows(const T* values, int components, int columns) const;

  Slab slab_;
  Exchange exchange_;
  std::vector<GlobalIndex> row_;  ///< of the slab, in the order in which entities arrive
};

}  // namespace thixis::output
