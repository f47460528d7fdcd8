#pragma once
#include <fmt/core.h>

#include <chrono>
#include <string>
#include <utility>

/// The log of the process: the root of MPI_COMM_WORLD prints to the terminal (standard output; warnings and errors, too), and writes the
/// same lines to a file. Other ranks are silent.
namespace thixis::core::log {

enum class Level {
  quiet,   ///< warnings, errors and the verdict
  normal,  ///< what a user wants to see
  verbose  ///< details, too
};
void set_level(Level level);
Level level();

enum class Old { overwrite, keep };  ///< what becomes of the lines of an existing file

/// From now on the lines go to this file, too; first of all those printed so far. Another call moves on to another file, which gets them
/// all, too. Throws FileError on the root if it can not be written; not collective.
void open(const std::string& path, Old old = Old::overwrite);
/// Stops writing to the file and forgets the lines so far.
void close();

void write_info(const std::string& line);
void write_warning(const std::string& line);
void write_error(const std::string& line);
void write_detail(const std::string& line);
void write_verdict(const std::string& line);

/// Format strings are those of fmt.
template <class... A>
void info(fmt::format_string<A...> format, A&&... a) {
  write_info(fmt::format(format, std::forward<A>(a)...));
}
/// The line begins with "warning: ".
template <class... A>
void warn(fmt::format_string<A...> format, A&&... a) {
  write_warning(fmt::format(format, std::forward<A>(a)...));
}
/// The line begins with "error: "; a message of several lines has it on the first.
template <class... A>
void error(fmt::format_string<A...> format, A&&... a) {
  write_error(fmt::format(format, std::forward<A>(a)...));
}
/// Shown by level verbose only.
template <class... A>
void detail(fmt::format_string<A...> format, A&&... a) {
  write_detail(fmt::format(format, std::forward<A>(a)...));
}
/// Shown by every level: the last line of a run.
template <class... A>
void verdict(fmt::format_string<A...> format, A&&... a) {
  write_verdict(fmt::format(format, std::forward<A>(a)...));
}

/// A bar with the estimated time left, drawn over itself on the terminal of the root; nothing is shown if standard output is no terminal or
/// the level is quiet, and nothing goes to the file. It disappears with the object; log lines in between go above it.
class Progress {
 public:
  explicit Progress(const std::string& name);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// `fraction` of the work, in [0, 1], is done; `note` stands behind the bar.
  void update(double fraction, const std::string& note = "");

 private:
  std::string name_;
  std::chrono::steady_clock::time_point begin_, shown_;
};

/// "[=====>    ] 52 %, 1 min 20 s left": the bar as text. No time is estimated before some of the work is done.
std::string progress_text(const std::string& name, double fraction, double seconds_so_far, const std::string& note = "");
/// "3 s", "1 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

}  // namespace thixis::core::log
