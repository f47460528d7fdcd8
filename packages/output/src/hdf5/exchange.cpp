#include "hdf5/exchange.hpp"

#include <algorithm>
#include <numeric>

namespace thixis::output {
namespace {

std::vector<int> offsets(const std::vector<int>& counts) {
  std::vector<int> result(counts.size(), 0);
  std::partial_sum(counts.begin(), counts.end() - 1, result.begin() + 1);
  return result;
}

template <class T>
MPI_Datatype mpi_type();
template <>
MPI_Datatype mpi_type<double>() {
  return MPI_DOUBLE;
}
template <>
MPI_Datatype mpi_type<GlobalIndex>() {
  return MPI_LONG_LONG;
}

/// `components` numbers as one unit: counts of MPI are ints, and counting items instead of numbers keeps them small.
class Unit {
 public:
  Unit(MPI_Datatype type, int components) {
    MPI_Type_contiguous(components, type, &unit_);
    MPI_Type_commit(&unit_);
  }
  ~Unit() { MPI_Type_free(&unit_); }
  Unit(const Unit&) = delete;
  Unit& operator=(const Unit&) = delete;
  operator MPI_Datatype() const { return unit_; }

 private:
  MPI_Datatype unit_;
};

}  // namespace

Exchange::Exchange(const std::vector<int>& target, const core::Comm& comm)
    : comm_(comm), items_(target.size()), send_counts_(comm.size(), 0), receive_counts_(comm.size(), 0) {
  for (const int rank : target)
    if (rank >= 0) ++send_counts_[rank];
  send_offsets_ = offsets(send_counts_);
  MPI_Alltoall(send_counts_.data(), 1, MPI_INT, receive_counts_.data(), 1, MPI_INT, comm.mpi());
  receive_offsets_ = offsets(receive_counts_);
  received_ = static_cast<std::size_t>(receive_offsets_.back()) + receive_counts_.back();

  sent_.resize(static_cast<std::size_t>(send_offsets_.back()) + send_counts_.back());
  std::vector<int> next = send_offsets_;
  for (std::size_t i = 0; i < target.size(); ++i)
    if (target[i] >= 0) sent_[next[target[i]]++] = static_cast<LocalIndex>(i);
}

template <class T>
std::vector<T> Exchange::forward(const T* values, int components) const {
  std::vector<T> sent(sent_.size() * components), received(received_ * components);
  for (std::size_t i = 0; i < sent_.size(); ++i)
    std::copy_n(values + static_cast<std::size_t>(sent_[i]) * components, components, sent.begin() + i * components);
  const Unit unit(mpi_type<T>(), components);
  MPI_Alltoallv(sent.data(), send_counts_.data(), send_offsets_.data(), unit, received.data(), receive_counts_.data(),
                receive_offsets_.data(), unit, comm_.mpi());
  return received;
}

template <class T>
std::vector<T> Exchange::backward(const T* answers, int components) const {
  std::vector<T> arrived(sent_.size() * components), values(items_ * components, T(0));
  const Unit unit(mpi_type<T>(), components);
  MPI_Alltoallv(answers, receive_counts_.data(), receive_offsets_.data(), unit, arrived.data(), send_counts_.data(), send_offsets_.data(),
                unit, comm_.mpi());
  for (std::size_t i = 0; i < sent_.size(); ++i)
    std::copy_n(arrived.begin() + i * components, components, values.begin() + static_cast<std::size_t>(sent_[i]) * components);
  return values;
}

template std::vector<double> Exchange::forward(const double*, int) const;
template std::vector<double> Exchange::backward(const double*, int) const;
template std::vector<GlobalIndex> Exchange::forward(const GlobalIndex*, int) const;
template std::vector<GlobalIndex> Exchange::backward(const GlobalIndex*, int) const;

}  // namespace thixis::output
