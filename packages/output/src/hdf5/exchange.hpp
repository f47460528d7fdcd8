#pragma once
#include <cstddef>
#include <vector>

#include "thixis/core/comm.hpp"
#include "thixis/core/types.hpp"

namespace thixis::output {

/// The way of items between ranks: item i of this rank goes to the rank target[i]. Values travel there and answers back by one
/// MPI_Alltoallv each. They arrive in the order of the ranks they come from, those of one rank in the order they have there.
class Exchange {
 public:
  /// Collective. target[i] = -1: item i goes nowhere.
  Exchange(const std::vector<int>& target, const core::Comm& comm);

  std::size_t items() const { return items_; }        ///< on this rank, also those that go nowhere
  std::size_t received() const { return received_; }  ///< that come to this rank

  /// values [items][components] -> [received][components], T = double or GlobalIndex. Collective.
  template <class T>
  std::vector<T> forward(const T* values, int components = 1) const;
  /// The way back: answers [received][components] -> [items][components], 0 for items that went nowhere. Collective.
  template <class T>
  std::vector<T> backward(const T* answers, int components = 1) const;

 private:
  core::Comm comm_;
  std::size_t items_ = 0, received_ = 0;
  std::vector<LocalIndex> sent_;                                                    ///< items in the order of their targets
  std::vector<int> send_counts_, send_offsets_, receive_counts_, receive_offsets_;  ///< of items, by rank
};

}  // namespace thixis::output
