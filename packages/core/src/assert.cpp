#include "thixis/core/assert.hpp"

#include <cfenv>

#include "thixis/core/error.hpp"

namespace thixis::core {

void assertion_failed(const char* file, int line, const char* condition, const std::string& message) {
  throw Error(ExitCode::internal,
              fmt::format("{}:{}: the assertion '{}' failed{}{}", file, line, condition, message.empty() ? "" : ": ", message));
}

void enable_floating_point_traps() { feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW); }

WithoutFloatingPointTraps::WithoutFloatingPointTraps() : enabled_(fegetexcept()) {
  if (enabled_ != 0) fedisableexcept(FE_ALL_EXCEPT);
}

WithoutFloatingPointTraps::~WithoutFloatingPointTraps() {
  if (enabled_ == 0) return;
  std::feclearexcept(FE_ALL_EXCEPT);
  feenableexcept(enabled_);
}

}  // namespace thixis::core
