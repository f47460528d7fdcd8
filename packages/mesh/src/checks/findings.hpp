#pragma once
#include <string>
#include <vector>

#include "thixis/core/comm.hpp"
#include "thixis/core/types.hpp"

namespace thixis::mesh {

/// Counts of what is wrong on this rank; every rank makes the same entries in the same order.
class Findings {
 public:
  explicit Findings(const core::Comm& comm) : comm_(comm) {}

  void add(const std::string& what, long long count) {
    what_.push_back(what);
    counts_.push_back(count);
  }
  /// Counts the entities 0..size-1 for which wrong(entity) holds.
  template <class Wrong>
  void count(const std::string& what, LocalIndex size, const Wrong& wrong) {
    long long found = 0;
    for (LocalIndex k = 0; k < size; ++k) found += wrong(k) ? 1 : 0;
    add(what, found);
  }
  /// What was found on all ranks together.
  std::vector<std::string> sentences() const {
    std::vector<long long> totals = counts_;
    comm_.sum(totals);
    std::vector<std::string> found;
    for (std::size_t k = 0; k < totals.size(); ++k)
      if (totals[k] != 0) found.push_back(what_[k] + ": " + std::to_string(totals[k]));
    return found;
  }

 private:
  core::Comm comm_;
  std::vector<std::string> what_;
  std::vector<long long> counts_;
};

inline bool inside(GlobalIndex k, GlobalIndex size) { return 0 <= k && k < size; }

}  // namespace thixis::mesh
