#include "seal.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <charconv>
#include <vector>

#include "files/text_file.hpp"
#include "thixis/core/error.hpp"

namespace thixis::output {
namespace {

const std::string hdf5_signature = "\x89HDF\r\n\x1a\n";

std::string format_line(int format) { return fmt::format("format {}\n", format); }

unsigned long crc(unsigned long so_far, const char* bytes, std::size_t count) {
  return crc32_z(so_far, reinterpret_cast<const Bytef*>(bytes), count);
}

/// What stands behind the seal.
struct Content {
  std::size_t bytes = 0;
  unsigned long checksum = 0;
  std::string beginning;
};

Content content_of(core::RegularFile& file) {
  Content content;
  std::vector<char> block(std::size_t{1} << 20);
  for (;;) {
    const std::size_t count = file.read(block.data(), block.size());
    if (content.bytes == 0) content.beginning.assign(block.data(), std::min<std::size_t>(count, 8));
    content.checksum = crc(content.checksum, block.data(), count);
    content.bytes += count;
    if (count < block.size()) return content;
  }
}

std::string text_of(const Seal& seal, const Content& content) {
  const std::string line = format_line(seal.format);
  std::string text =
      fmt::format("{}\n{}bytes {}\ncrc32 {:08x}\n", seal.kind, line, content.bytes, crc(content.checksum, line.data(), line.size()));
  text.resize(seal_bytes, '\0');
  return text;
}

/// The format that a seal of this kind names, or 0.
int format_of(const std::string& front, const std::string& kind) {
  const std::string begin = kind + "\nformat ";
  if (front.compare(0, begin.size(), begin) != 0) return 0;
  int format = 0;
  std::from_chars(front.data() + begin.size(), front.data() + front.size(), format);
  return format;
}

void put(int file, const std::string& text, const std::string& path) {
  if (::pwrite(file, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()) || ::fsync(file) != 0)
    throw core::FileError(not_written(path, errno));
}

}  // namespace

void write_seal(const std::string& path, const Seal& seal) {
  core::RegularFile whole(path);
  std::string front(seal_bytes, '\0');
  if (!whole.open() || whole.read(front.data(), front.size()) < front.size()) throw core::FileError(not_written(path, EIO));
  const std::string text = text_of(seal, content_of(whole));
  const int file = ::open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) throw core::FileError(not_written(path, errno));
  try {
    put(file, text, path);
  } catch (...) {
    ::close(file);
    throw;
  }
  ::close(file);
}

SealFound look_at_seal(core::RegularFile& file, const Seal& wanted) {
  std::string front(seal_bytes, '\0');
  front.resize(file.read(front.data(), front.size()));
  const Content content = content_of(file);
  if (front == text_of(wanted, content)) return {SealState::whole, wanted.format};
  const int format = format_of(front, wanted.kind);
  if (format != wanted.format && front == text_of({wanted.kind, format}, content)) return {SealState::other_format, format};
  const bool begins_so = front.compare(0, wanted.kind.size(), wanted.kind) == 0;
  return {begins_so || content.beginning == hdf5_signature ? SealState::damaged : SealState::none, 0};
}

}  // namespace thixis::output
