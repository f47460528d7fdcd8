#pragma once
#include <fmt/core.h>

#include <string>
#include <type_traits>

/// Checks of the program's own invariants, compiled in with THIXIS_ASSERTIONS. A violated one throws core::Error with code `internal` and
/// the file and line; bad input is never judged by them.
///
///     THIXIS_ASSERT(volume > 0, "cell {} has volume {}", K, volume);
///     THIXIS_ASSERT_EQ(rows, columns, "the matrix of patch {} is square", a);
///
/// Not for kernels that run on a device.
namespace thixis::core {

[[noreturn]] void assertion_failed(const char* file, int line, const char* condition, const std::string& message);

/// Invalid operations, divisions by zero and overflows stop the program from now on (SIGFPE).
void enable_floating_point_traps();

/// Switches the traps off while it lives: around libraries that compute with NaN or infinity on purpose.
class WithoutFloatingPointTraps {
 public:
  WithoutFloatingPointTraps();
  ~WithoutFloatingPointTraps();
  WithoutFloatingPointTraps(const WithoutFloatingPointTraps&) = delete;
  WithoutFloatingPointTraps& operator=(const WithoutFloatingPointTraps&) = delete;

 private:
  int enabled_;
};

namespace detail {
inline std::string message_of() { return ""; }
template <class... A>
std::string message_of(fmt::format_string<A...> format, A&&... a) {
  return fmt::format(format, std::forward<A>(a)...);
}
}  // namespace detail

}  // namespace thixis::core

#ifdef THIXIS_ASSERTIONS
#define THIXIS_ASSERT(condition, ...)                                                                                                    \
  do {                                                                                                                                   \
    if (!(condition)) ::thixis::core::assertion_failed(__FILE__, __LINE__, #condition, ::thixis::core::detail::message_of(__VA_ARGS__)); \
  } while (false)
#define THIXIS_ASSERT_COMPARISON(a, op, b, ...)                                                                                           \
  do {                                                                                                                                    \
    const auto& thixis_a = (a);                                                                                                           \
    const auto& thixis_b = (b);                                                                                                           \
    if (!(thixis_a op thixis_b))                                                                                                          \
      ::thixis::core::assertion_failed(__FILE__, __LINE__, #a " " #op " " #b,                                                             \
                                       fmt::format("{} and {}; ", thixis_a, thixis_b) + ::thixis::core::detail::message_of(__VA_ARGS__)); \
  } while (false)
#else
#define THIXIS_ASSERT(condition, ...) static_cast<void>(0)
#define THIXIS_ASSERT_COMPARISON(a, op, b, ...) static_cast<void>(0)
#endif
#define THIXIS_ASSERT_EQ(a, b, ...) THIXIS_ASSERT_COMPARISON(a, ==, b, __VA_ARGS__)
#define THIXIS_ASSERT_LT(a, b, ...) THIXIS_ASSERT_COMPARISON(a, <, b, __VA_ARGS__)
#define THIXIS_ASSERT_LE(a, b, ...) THIXIS_ASSERT_COMPARISON(a, <=, b, __VA_ARGS__)
