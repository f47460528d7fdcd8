#include "thixis/output/history.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "text_file.hpp"
#include "thixis/core/error.hpp"

namespace thixis::output {
namespace {

const std::string header =
    "level,time_step,time,newton,linear,active,changed,residual,eta_disc,eta_lin,eta_alg,eta_total,energy_error,seconds\n";

template <class... T>
std::string line(const std::optional<T>&... entries) {
  std::string text;
  ((text += entries ? fmt::format("{},", *entries) : std::string(",")), ...);
  text.back() = '\n';
  return text;
}

/// Header and at most `rows` whole rows of the file; nothing if it does not begin with the header.
std::string beginning(const std::string& path, GlobalIndex rows) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  if (file) content << file.rdbuf();
  const std::string text = content.str();
  if (text.compare(0, header.size(), header) != 0) return {};
  std::size_t end = header.size();
  for (GlobalIndex row = 0; row < rows; ++row) {
    const std::size_t next = text.find('\n', end);
    if (next == std::string::npos) break;
    end = next + 1;
  }
  return text.substr(0, end);
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

struct History::Impl {
  std::string path;
  core::Comm comm;
  std::unique_ptr<std::FILE, CloseFile> file;  ///< on the root
  GlobalIndex rows = 0;

  void write(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() || std::fflush(file.get()) != 0)
      throw core::FileError(not_written(path, errno));
  }
};

History::History(const std::string& path, const core::Comm& comm, bool enabled) : History(path, 0, enabled, comm) {}

History History::go_on(const std::string& path, GlobalIndex rows, const core::Comm& comm, bool enabled) {
  return {path, rows, enabled, comm};
}

History::History(const std::string& path, GlobalIndex rows_kept, bool enabled, const core::Comm& comm) {
  if (!enabled) return;
  impl_.reset(new Impl{path, comm, nullptr});
  impl_->rows = comm.on_root([&] {
    const std::string kept = rows_kept > 0 ? beginning(path, rows_kept) : std::string();
    if (!kept.empty() && ::truncate(path.c_str(), static_cast<off_t>(kept.size())) != 0) throw core::FileError(not_written(path, errno));
    impl_->file.reset(std::fopen(path.c_str(), kept.empty() ? "w" : "a"));
    if (!impl_->file) throw core::FileError(not_written(path, errno));
    if (kept.empty()) impl_->write(header);
    return std::max<GlobalIndex>(0, std::count(kept.begin(), kept.end(), '\n') - 1);
  });
}
History::~History() = default;
History::History(History&&) noexcept = default;
History& History::operator=(History&&) noexcept = default;

void History::append(const HistoryRow& row) {
  if (!impl_) return;
  impl_->comm.on_root([&] {
    impl_->write(line(row.level, row.time_step, row.time, row.newton, row.linear, row.active, row.changed, row.residual, row.eta_disc,
                      row.eta_lin, row.eta_alg, row.eta_total, row.energy_error, row.seconds));
  });
  ++impl_->rows;
}

GlobalIndex History::rows() const { return impl_ ? impl_->rows : 0; }

}  // namespace thixis::output
