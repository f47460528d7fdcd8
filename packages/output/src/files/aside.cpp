#include "files/aside.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "files/text_file.hpp"
#include "thixis/core/error.hpp"

namespace thixis::output {
namespace {

void sync_folder(const std::string& path) {
  const auto folder = std::filesystem::absolute(path).parent_path().string();
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void move_into_place(const std::string& temporary, const std::string& path) {
  if (std::rename(temporary.c_str(), path.c_str()) != 0) throw core::FileError(not_written(path, errno));
  sync_folder(path);
}

void discard(const std::string& path) { std::remove(path.c_str()); }

}  // namespace thixis::output
