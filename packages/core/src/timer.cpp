#include "thixis/core/timer.hpp"

#include <fmt/core.h>

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <sstream>
#include <unordered_map>

namespace thixis::core {

namespace {

struct Entry {
  RegionTime time;
  int running = 0;  ///< how often it is entered at the moment
  Stopwatch watch;
};

struct Regions {
  std::vector<Entry> entries;
  std::unordered_map<std::string, std::size_t> index;
  int depth = 0;

  std::size_t find_or_add(const std::string& name) {
    const auto [place, added] = index.emplace(name, entries.size());
    if (added) {
      entries.emplace_back();
      entries.back().time.name = name;
      entries.back().time.depth = depth;
    }
    return place->second;
  }
};

Regions& the_regions() {
  static Regions regions;
  return regions;
}

double seconds_of(const Entry& entry) { return entry.time.seconds + (entry.running > 0 ? entry.watch.seconds() : 0); }

}  // namespace

Region::Region(const std::string& name) : index_(the_regions().find_or_add(name)) {
  Entry& entry = the_regions().entries[index_];
  Kokkos::Profiling::pushRegion(name);
  ++the_regions().depth;
  ++entry.time.calls;
  if (entry.running++ == 0) entry.watch.restart();
}

Region::~Region() {
  Entry& entry = the_regions().entries[index_];
  if (--entry.running == 0) entry.time.seconds += entry.watch.seconds();
  --the_regions().depth;
  Kokkos::Profiling::popRegion();
}

double seconds(const std::string& name) {
  const auto& all = the_regions();
  const auto found = all.index.find(name);
  return found == all.index.end() ? 0 : seconds_of(all.entries[found->second]);
}

std::vector<RegionTime> regions() {
  std::vector<RegionTime> times;
  for (const auto& entry : the_regions().entries) {
    times.push_back(entry.time);
    times.back().seconds = seconds_of(entry);
  }
  return times;
}

void reset_regions() {
  for (auto& entry : the_regions().entries) {
    entry.time.seconds = 0;
    entry.time.calls = 0;
    entry.watch.restart();
  }
}

std::string region_table(const Comm& comm, double total) {
  std::string names;
  if (comm.root())
    for (const auto& region : regions()) names += region.name + '\n';
  comm.broadcast(names);
  std::vector<double> longest;
  std::istringstream stream(names);
  for (std::string name; std::getline(stream, name);) longest.push_back(seconds(name));
  comm.max(longest);
  if (!comm.root()) return "";

  const auto times = regions();
  std::size_t width = 6;
  for (const auto& region : times) width = std::max(width, region.name.size() + 2 * region.depth);
  std::string table = fmt::format("{:<{}}  {:>10}  {:>6}  {:>8}\n", "region", width, "seconds", "share", "calls");
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double share = total > 0 ? 100 * longest[i] / total : 0;
    table += fmt::format("{:<{}}  {:>10.3f}  {:>4.0f} %  {:>8}\n", std::string(2 * times[i].depth, ' ') + times[i].name, width, longest[i],
                         share, times[i].calls);
  }
  return table;
}

}  // namespace thixis::core
