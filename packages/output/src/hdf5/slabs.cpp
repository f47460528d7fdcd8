#include "hdf5/slabs.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace thixis::output {
namespace {

/// The rank to which each owned entity goes, -1 for those of other owners.
std::vector<int> targets(const std::vector<GlobalIndex>& id, const std::vector<int>& owner, GlobalIndex total, const std::string& entity,
                         const core::Comm& comm) {
  const GlobalIndex height = slab_height(total, comm);
  std::vector<int> target(id.size(), -1);
  comm.together([&] {
    for (std::size_t i = 0; i < id.size(); ++i) {
      if (owner[i] != comm.rank()) continue;
      if (id[i] < 0 || id[i] >= total)
        throw core::Error(core::ExitCode::internal, fmt::format("A {} has the number {}, there are {}.", entity, id[i], total));
      target[i] = static_cast<int>(id[i] / height);
    }
  });
  return target;
}

}  // namespace

GlobalIndex slab_height(GlobalIndex total, const core::Comm& comm) {
  return std::max<GlobalIndex>(1, (total + comm.size() - 1) / comm.size());
}

Slab even_slab(GlobalIndex total, const core::Comm& comm) {
  const GlobalIndex height = slab_height(total, comm);
  const GlobalIndex begin = std::min(total, comm.rank() * height);
  return {begin, std::min(total, begin + height) - begin, total};
}

SlabExchange::SlabExchange(const std::vector<GlobalIndex>& id, const std::vector<int>& owner, GlobalIndex total, const std::string& entity,
                           const core::Comm& comm)
    : slab_(even_slab(total, comm)), exchange_(targets(id, owner, total, entity, comm), comm), row_(exchange_.forward(id.data())) {
  comm.together([&] {
    std::vector<char> filled(slab_.size, 0);
    for (GlobalIndex& row : row_) {
      row -= slab_.begin;
      if (filled[row]++) throw core::Error(core::ExitCode::internal, fmt::format("The {} {} has two owners.", entity, row + slab_.begin));
    }
  });
  const GlobalIndex missing = comm.sum(slab_.size - static_cast<GlobalIndex>(row_.size()));
  if (missing != 0) throw core::Error(core::ExitCode::internal, fmt::format("{} of {} {}s have no owner.", missing, total, entity));
}

template <class T>
std::vector<T> SlabExchange::rows(const T* values, int components, int columns) const {
  const auto received = exchange_.forward(values, components);
  std::vector<T> result(slab_.size * columns, T(0));
  for (std::size_t i = 0; i < row_.size(); ++i)
    std::copy_n(received.begin() + i * components, components, result.begin() + row_[i] * columns);
  return result;
}

std::vector<double> SlabExchange::operator()(const double* values, int components, int columns) const {
  return rows(values, components, columns);
}
std::vector<GlobalIndex> SlabExchange::operator()(const GlobalIndex* values, int components, int columns) const {
  return rows(values, components, columns);
}

}  // namespace thixis::output
