#include "thixis/core/log.hpp"

#include <mpi.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <vector>

#include "thixis/core/error.hpp"
#include "thixis/core/file.hpp"
#include "thixis/core/text.hpp"

namespace thixis::core::log {

namespace {

/// Rank 0 of the world; before MPI begins everybody, after its end whoever was.
bool on_root() {
  static bool root = true;
  int begun = 0, over = 0, rank = 0;
  MPI_Initialized(&begun);
  MPI_Finalized(&over);
  if (begun != 0 && over == 0) {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    root = rank == 0;
  }
  return root;
}

/// Whether somebody looks at the root's standard output. Open MPI gives its processes a pseudo terminal for standard output (and pipes for
/// standard error) wherever mpirun itself writes to; then mpirun's own output, the parent's, decides.
bool on_terminal() {
  if (isatty(STDOUT_FILENO) == 0) return false;
  if (isatty(STDERR_FILENO) != 0 || std::getenv("OMPI_COMM_WORLD_SIZE") == nullptr) return true;
  std::error_code error;
  const auto target = std::filesystem::read_symlink(fmt::format("/proc/{}/fd/1", getppid()), error).string();
  return !error && (target.rfind("/dev/pts/", 0) == 0 || target.rfind("/dev/tty", 0) == 0);
}

std::unique_ptr<spdlog::logger> logger_on(const spdlog::sink_ptr& sink, const char* pattern) {
  auto logger = std::make_unique<spdlog::logger>("thixis", sink);
  logger->set_pattern(pattern);
  logger->set_level(spdlog::level::trace);
  logger->flush_on(spdlog::level::trace);
  return logger;
}

struct Log {
  Level level = Level::normal;
  std::shared_ptr<spdlog::sinks::stdout_color_sink_mt> output = std::make_shared<spdlog::sinks::stdout_color_sink_mt>();
  std::unique_ptr<spdlog::logger> terminal = logger_on(output, "%^%v%$");
  std::unique_ptr<spdlog::logger> file;
  std::vector<std::string> lines;  ///< shown so far
  bool bar = false;                ///< a progress bar stands on the terminal's last line

  Log() { output->set_color(spdlog::level::info, ""); }
  void clear_bar() {
    if (bar) std::fputs("\r\033[K", stdout);
    bar = false;
  }
  /// Here, and in what ends the program, words of decks, meshes and file names reach the terminal: as nothing but words.
  void show(spdlog::level::level_enum severity, const std::string& words) {
    if (!on_root()) return;
    const std::string line = printable(words);
    clear_bar();
    output->set_color_mode(on_terminal() ? spdlog::color_mode::automatic : spdlog::color_mode::never);
    terminal->log(severity, line);
    if (file) file->log(severity, line);
    lines.push_back(line);
  }
};

Log& the_log() {
  static Log log;
  return log;
}

}  // namespace

void set_level(Level level) { the_log().level = level; }
Level level() { return the_log().level; }

void open(const std::string& path, Old old) {
  if (!on_root()) return;
  Log& log = the_log();
  log.file.reset();
  require_plain_place(path);
  try {
    log.file = logger_on(std::make_shared<spdlog::sinks::basic_file_sink_mt>(path, old == Old::overwrite), "%v");
  } catch (const spdlog::spdlog_ex&) {
    throw FileError(fmt::format("{}: the log can not be written there; choose another output directory.", path));
  }
  for (const auto& line : log.lines) log.file->info(line);
}

void close() {
  the_log().file.reset();
  the_log().lines.clear();
}

void write_info(const std::string& line) {
  if (the_log().level != Level::quiet) the_log().show(spdlog::level::info, line);
}
void write_detail(const std::string& line) {
  if (the_log().level == Level::verbose) the_log().show(spdlog::level::info, line);
}
void write_verdict(const std::string& line) { the_log().show(spdlog::level::info, line); }
void write_warning(const std::string& line) { the_log().show(spdlog::level::warn, "warning: " + line); }
void write_error(const std::string& line) { the_log().show(spdlog::level::err, "error: " + line); }

Progress::Progress(const std::string& name) : name_(name), begin_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
  the_log().clear_bar();
  std::fflush(stdout);
}

void Progress::update(double fraction, const std::string& note) {
  using Seconds = std::chrono::duration<double>;
  constexpr double redraw_after = 0.1;
  if (the_log().level == Level::quiet || !on_root() || !on_terminal()) return;
  const auto now = std::chrono::steady_clock::now();
  if (the_log().bar && Seconds(now - shown_).count() < redraw_after) return;
  the_log().clear_bar();
  std::fputs(one_line(progress_text(name_, fraction, Seconds(now - begin_).count(), note)).c_str(), stdout);
  std::fflush(stdout);
  the_log().bar = true;
  shown_ = now;
}

std::string progress_text(const std::string& name, double fraction, double seconds_so_far, const std::string& note) {
  constexpr int width = 30;
  const double part = std::isfinite(fraction) ? std::fmin(std::fmax(fraction, 0.0), 1.0) : 0.0;
  const int full = static_cast<int>(part * width);
  std::string bar(full, '=');
  if (full < width) bar += '>' + std::string(width - full - 1, ' ');
  const std::string left = part > 0 ? ", " + duration_text(seconds_so_far * (1 - part) / part) + " left" : "";
  return fmt::format("{} [{}] {:.0f} %{}{}", name, bar, 100 * part, left, note.empty() ? "" : "  " + note);
}

std::string duration_text(double seconds) {
  if (!(seconds < 1e15)) return "unknown time";
  const auto whole = static_cast<long long>(std::llround(std::fmax(seconds, 0.0)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace thixis::core::log
