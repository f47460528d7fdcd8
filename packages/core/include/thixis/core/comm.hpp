#pragma once
#include <mpi.h>

#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "thixis/core/error.hpp"

namespace thixis::core {

/// A communicator as a value: copies are free, nothing is owned. Unless said otherwise, members are collective: every rank calls them.
class Comm {
 public:
  explicit Comm(MPI_Comm comm = MPI_COMM_WORLD);

  int rank() const { return rank_; }        ///< not collective
  int size() const { return size_; }        ///< not collective
  bool root() const { return rank_ == 0; }  ///< not collective
  MPI_Comm mpi() const { return comm_; }    ///< not collective
  void barrier() const;

  /// Sum, largest, smallest of one value per rank; the result is the same on every rank. NaN on any rank gives NaN.
  double sum(double value) const;
  int sum(int value) const;
  long long sum(long long value) const;
  double max(double value) const;
  int max(int value) const;
  long long max(long long value) const;
  double min(double value) const;
  int min(int value) const;
  long long min(long long value) const;

  /// The same entry by entry, in place; the vectors have equal length on all ranks.
  void sum(std::vector<double>& values) const;
  void sum(std::vector<int>& values) const;
  void sum(std::vector<long long>& values) const;
  void max(std::vector<double>& values) const;
  void max(std::vector<int>& values) const;
  void max(std::vector<long long>& values) const;
  void min(std::vector<double>& values) const;
  void min(std::vector<int>& values) const;
  void min(std::vector<long long>& values) const;

  bool any(bool value) const { return max(static_cast<int>(value)) != 0; }  ///< true on some rank
  bool all(bool value) const { return min(static_cast<int>(value)) != 0; }  ///< true on every rank

  /// Sum of the values of the lower ranks; 0 on the root. Where this rank's entities begin in a global numbering.
  long long offset(long long value) const;

  /// The root's value, text or array (its length, too) for everybody.
  void broadcast(std::string& text) const;
  template <class T, class = std::enable_if_t<std::is_trivially_copyable_v<T>>>
  void broadcast(T& value) const {
    broadcast_bytes(&value, sizeof(T));
  }
  template <class T>
  void broadcast(std::vector<T>& values) const;

  /// One value per rank, on every rank, in the order of the ranks.
  template <class T>
  std::vector<T> gather(const T& value) const;
  /// The arrays of all ranks one after the other, on every rank.
  template <class T>
  std::vector<T> gather(const std::vector<T>& values) const;
  /// The same on the root only; empty elsewhere.
  template <class T>
  std::vector<T> gather_on_root(const std::vector<T>& values) const;

  /// If any rank brings an error, every rank throws the one of the lowest such rank: same class, code and message. Call it before a
  /// collective operation that the failed ranks would not reach.
  void throw_together(const std::optional<Error>& error) const;

  /// Runs f() on every rank and then throws together what it threw (a std::exception that is no Error becomes one with code `internal`).
  /// f must not communicate. Returns what f returned.
  template <class F>
  auto together(F&& f) const {
    return run(true, std::forward<F>(f));
  }

  /// Runs f() on the root alone, throws its error on all ranks, and returns its result (nothing, a trivially copyable value, a string or a
  /// vector of trivially copyable values) on all ranks.
  template <class F>
  auto on_root(F&& f) const {
    if constexpr (std::is_void_v<std::invoke_result_t<F>>) {
      run(root(), std::forward<F>(f));
    } else {
      auto result = run(root(), std::forward<F>(f));
      broadcast(result);
      return result;
    }
  }

 private:
  template <class F>
  auto run(bool here, F&& f) const;
  void broadcast_bytes(void* data, std::size_t bytes) const;
  std::vector<char> gather_bytes(const void* data, std::size_t count, std::size_t size, bool everywhere) const;

  MPI_Comm comm_;
  int rank_ = 0;
  int size_ = 1;
};

/// An Error of the class that belongs to its code (InputError, FileError, NotConverged), thrown.
[[noreturn]] void throw_error(ExitCode code, const std::string& sentence);

// ---------------------------------------------------------------------------------------------------------------------------------

template <class F>
auto Comm::run(bool here, F&& f) const {
  using Result = std::invoke_result_t<F>;
  std::optional<Error> error;
  const auto guarded = [&](auto&& action) {
    try {
      if (here) action();
    } catch (const Error& caught) {
      error = caught;
    } catch (const std::exception& caught) {
      error = Error(ExitCode::internal, caught.what());
    }
    throw_together(error);
  };
  if constexpr (std::is_void_v<Result>) {
    guarded([&] { f(); });
  } else {
    Result result{};
    guarded([&] { result = f(); });
    return result;
  }
}

template <class T>
void Comm::broadcast(std::vector<T>& values) const {
  static_assert(std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool>);
  std::size_t count = values.size();
  broadcast(count);
  values.resize(count);
  broadcast_bytes(values.data(), count * sizeof(T));
}

namespace detail {
template <class T>
std::vector<T> from_bytes(const std::vector<char>& bytes) {
  static_assert(std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool>);
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!bytes.empty()) std::char_traits<char>::copy(reinterpret_cast<char*>(values.data()), bytes.data(), bytes.size());
  return values;
}
}  // namespace detail

template <class T>
std::vector<T> Comm::gather(const T& value) const {
  return detail::from_bytes<T>(gather_bytes(&value, 1, sizeof(T), true));
}
template <class T>
std::vector<T> Comm::gather(const std::vector<T>& values) const {
  return detail::from_bytes<T>(gather_bytes(values.data(), values.size(), sizeof(T), true));
}
template <class T>
std::vector<T> Comm::gather_on_root(const std::vector<T>& values) const {
  return detail::from_bytes<T>(gather_bytes(values.data(), values.size(), sizeof(T), false));
}

}  // namespace thixis::core
