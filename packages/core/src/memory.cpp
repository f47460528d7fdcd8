#include "thixis/core/memory.hpp"

#include <fmt/core.h>
#include <sys/resource.h>
#include <sys/sysinfo.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "thixis/core/text.hpp"

namespace thixis::core {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

/// The smallest number in files of this name in the folder of the group and those above it, up to where the file system is mounted.
double smallest_of_group(const std::string& mount, const std::string& group, const char* name) {
  double least = no_limit;
  const std::filesystem::path top(mount);
  for (std::filesystem::path folder = mount + group;; folder = folder.parent_path()) {
    std::string text;
    std::ifstream(folder / name) >> text;
    if (const auto bytes = to_double(text); bytes && *bytes > 0) least = std::min(least, *bytes);
    if (folder == top || !folder.has_relative_path()) return least;
  }
}

/// Bytes, of version 2 ("0::/group") and of version 1 ("5:memory:/group") of control groups.
double group_limit() {
  double least = no_limit;
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const auto first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1), group = line.substr(second + 1);
    if (controllers.empty()) least = std::min(least, smallest_of_group("/sys/fs/cgroup", group, "memory.max"));
    if (("," + controllers + ",").find(",memory,") != std::string::npos)
      least = std::min(least, smallest_of_group("/sys/fs/cgroup/memory", group, "memory.limit_in_bytes"));
  }
  return least;
}

double resource_limit(int resource) {
  rlimit limit{};
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return no_limit;
  return static_cast<double>(limit.rlim_cur);
}

/// Ranks on the machine of this one. Collective.
int ranks_here(const Comm& comm) {
  MPI_Comm here;
  MPI_Comm_split_type(comm.mpi(), MPI_COMM_TYPE_SHARED, comm.rank(), MPI_INFO_NULL, &here);
  int count = 1;
  MPI_Comm_size(here, &count);
  MPI_Comm_free(&here);
  return count;
}

std::string gigabytes(double megabytes) { return fmt::format("{:.3g} GB", megabytes / 1000); }

}  // namespace

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024 / 1e6;  // Linux counts in KiB
}

double machine_memory_mb() {
  struct sysinfo found {};
  const double machine =
      sysinfo(&found) != 0 ? no_limit : (static_cast<double>(found.totalram) + static_cast<double>(found.totalswap)) * found.mem_unit;
  return std::min(machine, group_limit()) / 1e6;
}

double process_memory_mb() { return std::min(resource_limit(RLIMIT_AS), resource_limit(RLIMIT_DATA)) / 1e6; }

void require_memory(double megabytes, const std::string& path, const Comm& comm) {
  const double of_rank = megabytes / comm.size();
  const double has = comm.min(std::min(machine_memory_mb() / ranks_here(comm), process_memory_mb()));
  if (of_rank <= has) return;
  const std::string each = comm.size() == 1 ? "" : fmt::format(" on each of {} ranks", comm.size());
  throw InputError(
      fmt::format("{}: the run needs {} of memory or more{}, and there are {}; take fewer cells or a lower degree, or more machines.", path,
                  gigabytes(of_rank), each, gigabytes(has)));
}

}  // namespace thixis::core
