#include "thixis/core/file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "thixis/core/error.hpp"

namespace thixis::core {
namespace {

RegularFile::State state_of(const struct stat& found) {
  return S_ISREG(found.st_mode)   ? RegularFile::State::open
         : S_ISDIR(found.st_mode) ? RegularFile::State::folder
                                  : RegularFile::State::special;
}

}  // namespace

RegularFile::RegularFile(const std::string& path) : path_(path) {
  struct stat found {};
  // Looked at first, for opening a device can do something by itself; and once more behind it, for the name may mean another file by then.
  if (path.find('\0') != std::string::npos || ::stat(path.c_str(), &found) != 0) {
    state_ = errno == ENOENT || errno == ENOTDIR || errno == ENAMETOOLONG ? State::absent : State::unreadable;
    return;
  }
  state_ = state_of(found);
  if (!open()) return;
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  state_ = descriptor_ < 0 || ::fstat(descriptor_, &found) != 0 ? State::unreadable : state_of(found);
  size_ = static_cast<std::size_t>(found.st_size);
}

RegularFile::~RegularFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::size_t RegularFile::read(char* bytes, std::size_t most) {
  constexpr std::size_t piece = std::size_t{1} << 30;
  std::size_t count = 0;
  while (count < most) {
    const ssize_t more = ::read(descriptor_, bytes + count, std::min(piece, most - count));
    if (more < 0 && errno == EINTR) continue;
    if (more < 0) throw FileError(fmt::format("The file '{}' can not be read: {}.", path_, std::strerror(errno)));
    if (more == 0) break;
    count += static_cast<std::size_t>(more);
  }
  return count;
}

std::string RegularFile::read_up_to(std::size_t most) {
  std::string text;
  constexpr std::size_t piece = std::size_t{1} << 16;
  for (;;) {
    const std::size_t before = text.size(), wanted = std::min(piece, most + 1 - before);
    text.resize(before + wanted);
    text.resize(before + read(text.data() + before, wanted));
    if (text.size() < before + wanted || text.size() > most) return text;
  }
}

void require_plain_place(const std::string& path) {
  struct stat found {};
  if (::lstat(path.c_str(), &found) != 0 || S_ISREG(found.st_mode)) return;
  const char* kind = S_ISLNK(found.st_mode) ? "a link" : S_ISDIR(found.st_mode) ? "a folder" : "no regular file";
  throw FileError(
      fmt::format("The file '{}' can not be written: there is {} of this name, and results are written to files of their own "
                  "only; remove it, or name another folder by output/directory in the deck or by --output.",
                  path, kind));
}

}  // namespace thixis::core
