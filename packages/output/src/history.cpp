#include "thixis/output/history.hpp"

#include <fmt/core.h>

#include <cerrno>
#include <cstdio>

#include "text_file.hpp"
#include "thixis/core/error.hpp"

namespace thixis::output {
namespace {

const char* const header =
    "level,time_step,time,newton,linear,active,changed,residual,eta_disc,eta_lin,eta_alg,eta_total,energy_error,seconds\n";

template <class... T>
std::string line(const std::optional<T>&... entries) {
  std::string text;
  ((text += entries ? fmt::format("{},", *entries) : std::string(",")), ...);
  text.back() = '\n';
  return text;
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

struct History::Impl {
  std::string path;
  core::Comm comm;
  std::unique_ptr<std::FILE, CloseFile> file;  ///< on the root

  void write(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() || std::fflush(file.get()) != 0)
      throw core::FileError(not_written(path, errno));
  }
};

History::History(const std::string& path, const core::Comm& comm, bool enabled) {
  if (!enabled) return;
  impl_.reset(new Impl{path, comm, nullptr});
  comm.on_root([&] {
    impl_->file.reset(std::fopen(path.c_str(), "w"));
    if (!impl_->file) throw core::FileError(not_written(path, errno));
    impl_->write(header);
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
}

}  // namespace thixis::output
