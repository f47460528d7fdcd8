#include "slabs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>

namespace thixis::output {
namespace {

std::vector<int> offsets(const std::vector<int>& counts) {
  std::vector<int> result(counts.size(), 0);
  std::partial_sum(counts.begin(), counts.end() - 1, result.begin() + 1);
  return result;
}

}  // namespace

SlabExchange::SlabExchange(const std::vector<GlobalIndex>& id, const std::vector<int>& owner, GlobalIndex total, const std::string& entity,
                           const core::Comm& comm)
    : comm_(comm), send_counts_(comm.size(), 0), receive_counts_(comm.size(), 0) {
  const GlobalIndex height = std::max<GlobalIndex>(1, (total + comm.size() - 1) / comm.size());
  slab_.total = total;
  slab_.begin = std::min(total, comm.rank() * height);
  slab_.size = std::min(total, slab_.begin + height) - slab_.begin;

  comm.together([&] {
    for (std::size_t i = 0; i < id.size(); ++i) {
      if (owner[i] != comm.rank()) continue;
      if (id[i] < 0 || id[i] >= total)
        throw core::Error(core::ExitCode::internal, fmt::format("A {} has the number {}, there are {}.", entity, id[i], total));
      ++send_counts_[id[i] / height];
    }
  });
  send_offsets_ = offsets(send_counts_);
  MPI_Alltoall(send_counts_.data(), 1, MPI_INT, receive_counts_.data(), 1, MPI_INT, comm.mpi());
  receive_offsets_ = offsets(receive_counts_);

  sent_.resize(send_offsets_.back() + send_counts_.back());
  std::vector<int> next = send_offsets_;
  std::vector<GlobalIndex> sent_id(sent_.size());
  for (std::size_t i = 0; i < id.size(); ++i) {
    if (owner[i] != comm.rank()) continue;
    const int at = next[id[i] / height]++;
    sent_[at] = static_cast<LocalIndex>(i);
    sent_id[at] = id[i];
  }
  received_.resize(receive_offsets_.back() + receive_counts_.back());
  MPI_Alltoallv(sent_id.data(), send_counts_.data(), send_offsets_.data(), MPI_LONG_LONG, received_.data(), receive_counts_.data(),
                receive_offsets_.data(), MPI_LONG_LONG, comm.mpi());

  comm.together([&] {
    std::vector<char> filled(slab_.size, 0);
    for (GlobalIndex& row : received_) {
      row -= slab_.begin;
      if (filled[row]++) throw core::Error(core::ExitCode::internal, fmt::format("The {} {} has two owners.", entity, row + slab_.begin));
    }
  });
  const GlobalIndex missing = comm.sum(slab_.size - static_cast<GlobalIndex>(received_.size()));
  if (missing != 0) throw core::Error(core::ExitCode::internal, fmt::format("{} of {} {}s have no owner.", missing, total, entity));
}

template <class T>
std::vector<T> SlabExchange::exchange(const T* values, int components, int columns, MPI_Datatype type) const {
  std::vector<T> sent(sent_.size() * components), received(received_.size() * components);
  for (std::size_t i = 0; i < sent_.size(); ++i)
    std::copy_n(values + static_cast<std::size_t>(sent_[i]) * components, components, sent.begin() + i * components);

  // Counts of MPI are ints: counting entities instead of numbers keeps them small.
  MPI_Datatype entity;
  MPI_Type_contiguous(components, type, &entity);
  MPI_Type_commit(&entity);
  MPI_Alltoallv(sent.data(), send_counts_.data(), send_offsets_.data(), entity, received.data(), receive_counts_.data(),
                receive_offsets_.data(), entity, comm_.mpi());
  MPI_Type_free(&entity);

  std::vector<T> rows(slab_.size * columns, T(0));
  for (std::size_t i = 0; i < received_.size(); ++i)
    std::copy_n(received.begin() + i * components, components, rows.begin() + received_[i] * columns);
  return rows;
}

std::vector<double> SlabExchange::operator()(const double* values, int components, int columns) const {
  return exchange(values, components, columns, MPI_DOUBLE);
}
std::vector<GlobalIndex> SlabExchange::operator()(const GlobalIndex* values, int components, int columns) const {
  return exchange(values, components, columns, MPI_LONG_LONG);
}

}  // namespace thixis::output
