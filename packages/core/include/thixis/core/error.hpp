#pragma once
#include <stdexcept>
#include <string>

namespace thixis::core {

/// What the program returns to the shell, the same on every rank count.
enum class ExitCode : int { done = 0, internal = 1, input = 2, not_converged = 3, target_missed = 4, input_output = 5, interrupted = 6 };

/// An error that ends the run, with a sentence that says what to do instead. Thrown on all ranks before a collective operation.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& sentence) : std::runtime_error(sentence), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// Command line or deck are wrong (exit 2); the message may hold several lines, one per mistake.
struct InputError : Error {
  explicit InputError(const std::string& sentence) : Error(ExitCode::input, sentence) {}
};
/// A file can not be read or written (exit 5).
struct FileError : Error {
  explicit FileError(const std::string& sentence) : Error(ExitCode::input_output, sentence) {}
};
/// A solver stopped without its criterion being met (exit 3).
struct NotConverged : Error {
  explicit NotConverged(const std::string& sentence) : Error(ExitCode::not_converged, sentence) {}
};

}  // namespace thixis::core
