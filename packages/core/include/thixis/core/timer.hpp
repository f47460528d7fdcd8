#pragma once
#include <chrono>
#include <string>
#include <vector>

#include "thixis/core/comm.hpp"

namespace thixis::core {

/// Wall-clock time between construction and destruction, added to the region of that name, and a region of the Kokkos profiling tools.
/// Regions may be nested; a region inside itself counts once. One thread only.
///
///     { core::Region region("assembly"); assemble(); }
class Region {
 public:
  explicit Region(const std::string& name);
  ~Region();
  Region(const Region&) = delete;
  Region& operator=(const Region&) = delete;

 private:
  std::size_t index_;
};

struct RegionTime {
  std::string name;
  double seconds = 0;  ///< with the regions inside; of a running region: up to now
  int calls = 0;
  int depth = 0;  ///< regions around it when it was entered first
};

/// Of this rank, since the start or the last reset; 0 for a region never entered.
double seconds(const std::string& name);
/// In the order of the first entry.
std::vector<RegionTime> regions();
/// Sets all to zero; those that run go on from now.
void reset_regions();
/// Collective: an aligned table with one row per region of the root: its longest time over the ranks, share of `total`, and calls.
/// Regions that the root did not enter are not shown.
std::string region_table(const Comm& comm, double total);

/// A stopwatch that runs from its construction.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }
  void restart() { begin_ = std::chrono::steady_clock::now(); }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace thixis::core
