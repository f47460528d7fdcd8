#include "thixis/output/directory.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "files/lock.hpp"
#include "files/text_file.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/file.hpp"

namespace thixis::output {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw core::FileError(fmt::format(
      "The output directory '{}' can not be used: {}. Name another one by output/directory in the deck or by --output.", path, reason));
}

/// The file that stands where the directory or one of its parents should be, or an empty path.
fs::path file_in_the_way(const fs::path& path) {
  fs::path part;
  std::error_code unknown;
  for (const fs::path& name : path) {
    part /= name;
    const fs::file_status status = fs::status(part, unknown);
    if (fs::exists(status) && !fs::is_directory(status)) return part;
  }
  return {};
}

void make(const std::string& path) {
  if (path.empty()) refuse(path, "its name is empty");
  const fs::path blocking = file_in_the_way(path);
  if (!blocking.empty()) refuse(path, fmt::format("'{}' is a file", blocking.string()));
  std::error_code error;
  fs::create_directories(path, error);
  if (error) refuse(path, error.message());
  if (::access(path.c_str(), W_OK | X_OK) != 0) refuse(path, std::strerror(errno));
}

/// What a run writes, or keeps beside it for a moment.
void require_plain_places(const fs::path& folder) {
  for (const char* name : {"deck.xml", "log.txt", "history.csv", "summary.json", "series.csv", "checkpoint.h5", "fields.h5", "fields.xdmf"})
    for (const char* ending : {"", ".part"}) core::require_plain_place((folder / (std::string(name) + ending)).string());
  std::error_code unknown;
  if (fs::is_symlink(folder / "fields", unknown)) core::require_plain_place((folder / "fields").string());
}

}  // namespace

void RunDirectory::create(const core::Comm& comm) {
  comm.on_root([&] {
    make(path_);
    if (!lock_) lock_ = std::make_shared<FolderLock>(path_);
    require_plain_places(path_);
  });
}

void RunDirectory::write_deck(const std::string& xml, const core::Comm& comm) const {
  comm.on_root([&] { write_text(deck(), xml); });
}

std::string RunDirectory::file(const std::string& name) const { return (fs::path(path_) / name).string(); }

}  // namespace thixis::output
