#include <new>

#include "thixis/core/memory.hpp"

namespace thixis::core {
namespace {

/// Kokkos turns the bad_alloc of a View into a runtime_error with these words, and Comm that of a rank into an internal error.
bool of_memory(const std::exception& caught) {
  const std::string words = caught.what();
  return dynamic_cast<const std::bad_alloc*>(&caught) != nullptr || words.find("failed to allocate memory") != std::string::npos ||
         words == std::bad_alloc().what();
}

}  // namespace

Error as_error(const std::exception& caught) {
  const auto* error = dynamic_cast<const Error*>(&caught);
  if (error && error->code() != ExitCode::internal) return *error;
  if (of_memory(caught))
    return InputError(
        "the memory of this machine is not enough for the deck; take fewer refinements or a lower degree, an iterative solver in place of "
        "'direct', or more machines.");
  return {ExitCode::internal, caught.what()};
}

}  // namespace thixis::core
