#include "thixis/core/comm.hpp"

#include <algorithm>
#include <climits>
#include <cmath>
#include <limits>
#include <numeric>

#include "thixis/core/memory.hpp"

namespace thixis::core {

namespace {

MPI_Datatype type_of(double) { return MPI_DOUBLE; }
MPI_Datatype type_of(int) { return MPI_INT; }
MPI_Datatype type_of(long long) { return MPI_LONG_LONG; }

int checked_count(std::size_t count) {
  if (count > static_cast<std::size_t>(INT_MAX)) throw Error(ExitCode::internal, "a message between ranks has more than 2^31 entries");
  return static_cast<int>(count);
}

template <class T>
T reduced(T value, MPI_Op op, MPI_Comm comm) {
  T result = value;
  MPI_Allreduce(&value, &result, 1, type_of(value), op, comm);
  return result;
}
template <class T>
void reduce(std::vector<T>& values, MPI_Op op, MPI_Comm comm) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), checked_count(values.size()), type_of(T{}), op, comm);
}

/// MPI leaves open what MPI_MAX and MPI_MIN make of NaN: count the NaNs beside it.
template <class Reduce>
double with_nan(double value, MPI_Comm comm, Reduce reduce_finite) {
  const int bad = reduced(static_cast<int>(std::isnan(value)), MPI_MAX, comm);
  const double result = reduce_finite(std::isnan(value) ? 0.0 : value);
  return bad != 0 ? std::numeric_limits<double>::quiet_NaN() : result;
}
void extremes(std::vector<double>& values, MPI_Op op, MPI_Comm comm) {
  std::vector<int> bad(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::isnan(values[i])) bad[i] = 1, values[i] = 0;
  reduce(bad, MPI_MAX, comm);
  reduce(values, op, comm);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (bad[i] != 0) values[i] = std::numeric_limits<double>::quiet_NaN();
}

/// A run of bytes sent as entries of `size` bytes, so that counts stay below 2^31 for large arrays.
class Record {
 public:
  explicit Record(std::size_t size) {
    MPI_Type_contiguous(checked_count(size), MPI_BYTE, &type_);
    MPI_Type_commit(&type_);
  }
  ~Record() { MPI_Type_free(&type_); }
  Record(const Record&) = delete;
  Record& operator=(const Record&) = delete;
  MPI_Datatype type() const { return type_; }

 private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

}  // namespace

Comm::Comm(MPI_Comm comm) : comm_(comm) {
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &size_);
}

void Comm::barrier() const { MPI_Barrier(comm_); }

double Comm::sum(double value) const { return reduced(value, MPI_SUM, comm_); }
int Comm::sum(int value) const { return reduced(value, MPI_SUM, comm_); }
long long Comm::sum(long long value) const { return reduced(value, MPI_SUM, comm_); }
double Comm::max(double value) const {
  return with_nan(value, comm_, [this](double finite) { return reduced(finite, MPI_MAX, comm_); });
}
int Comm::max(int value) const { return reduced(value, MPI_MAX, comm_); }
long long Comm::max(long long value) const { return reduced(value, MPI_MAX, comm_); }
double Comm::min(double value) const {
  return with_nan(value, comm_, [this](double finite) { return reduced(finite, MPI_MIN, comm_); });
}
int Comm::min(int value) const { return reduced(value, MPI_MIN, comm_); }
long long Comm::min(long long value) const { return reduced(value, MPI_MIN, comm_); }

void Comm::sum(std::vector<double>& values) const { reduce(values, MPI_SUM, comm_); }
void Comm::sum(std::vector<int>& values) const { reduce(values, MPI_SUM, comm_); }
void Comm::sum(std::vector<long long>& values) const { reduce(values, MPI_SUM, comm_); }
void Comm::max(std::vector<double>& values) const { extremes(values, MPI_MAX, comm_); }
void Comm::max(std::vector<int>& values) const { reduce(values, MPI_MAX, comm_); }
void Comm::max(std::vector<long long>& values) const { reduce(values, MPI_MAX, comm_); }
void Comm::min(std::vector<double>& values) const { extremes(values, MPI_MIN, comm_); }
void Comm::min(std::vector<int>& values) const { reduce(values, MPI_MIN, comm_); }
void Comm::min(std::vector<long long>& values) const { reduce(values, MPI_MIN, comm_); }

long long Comm::offset(long long value) const {
  long long below = 0;
  MPI_Exscan(&value, &below, 1, MPI_LONG_LONG, MPI_SUM, comm_);
  return rank_ == 0 ? 0 : below;
}

void Comm::broadcast(std::string& text) const {
  std::size_t count = text.size();
  broadcast(count);
  text.resize(count);
  broadcast_bytes(text.data(), count);
}

void Comm::broadcast_bytes(void* data, std::size_t bytes) const {
  constexpr std::size_t piece = std::size_t{1} << 30;
  for (std::size_t begin = 0; begin < bytes; begin += piece)
    MPI_Bcast(static_cast<char*>(data) + begin, static_cast<int>(std::min(piece, bytes - begin)), MPI_BYTE, 0, comm_);
}

std::vector<char> Comm::gather_bytes(const void* data, std::size_t count, std::size_t size, bool everywhere) const {
  const int mine = checked_count(count);
  std::vector<int> counts(size_), begins(size_, 0);
  MPI_Allgather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, comm_);
  const auto total = std::accumulate(counts.begin(), counts.end(), 0LL);
  checked_count(static_cast<std::size_t>(total));
  for (int r = 1; r < size_; ++r) begins[r] = begins[r - 1] + counts[r - 1];
  const Record record(size);
  std::vector<char> all(everywhere || root() ? static_cast<std::size_t>(total) * size : 0);
  if (everywhere) MPI_Allgatherv(data, mine, record.type(), all.data(), counts.data(), begins.data(), record.type(), comm_);
  else MPI_Gatherv(data, mine, record.type(), all.data(), counts.data(), begins.data(), record.type(), 0, comm_);
  return all;
}

void Comm::throw_together(const std::optional<Error>& here) const {
  const auto error = here ? std::optional<Error>(as_error(*here)) : std::nullopt;
  const int first = reduced(error ? rank_ : size_, MPI_MIN, comm_);
  if (first == size_) return;
  int code = error ? static_cast<int>(error->code()) : 0;
  std::string sentence = error ? error->what() : "";
  unsigned long long length = sentence.size();
  MPI_Bcast(&code, 1, MPI_INT, first, comm_);
  MPI_Bcast(&length, 1, MPI_UNSIGNED_LONG_LONG, first, comm_);
  sentence.resize(length);
  MPI_Bcast(sentence.data(), checked_count(length), MPI_CHAR, first, comm_);
  throw_error(static_cast<ExitCode>(code), sentence);
}

void throw_error(ExitCode code, const std::string& sentence) {
  switch (code) {
    case ExitCode::input:
      throw InputError(sentence);
    case ExitCode::input_output:
      throw FileError(sentence);
    case ExitCode::not_converged:
      throw NotConverged(sentence);
    default:
      throw Error(code, sentence);
  }
}

}  // namespace thixis::core
