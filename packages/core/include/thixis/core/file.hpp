#pragma once
#include <cstddef>
#include <string>

/// Files of others are data, and nothing else: regular files are read, and results are written to regular files.
namespace thixis::core {

/// A regular file, open for reading. A folder, a pipe, a device or a socket is not opened: reading it could block, or never end.
/// Nothing here is collective.
class RegularFile {
 public:
  explicit RegularFile(const std::string& path);
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;

  enum class State { open, absent, folder, special, unreadable };
  State state() const { return state_; }
  bool open() const { return state_ == State::open; }
  std::size_t size() const { return size_; }  ///< bytes, as the folder says; 0 where the system makes the file up while it is read

  /// The next bytes: at most `most`, fewer at the end of the file only. Throws FileError where the disk fails.
  std::size_t read(char* bytes, std::size_t most);
  /// Everything from here on, but not more than `most` + 1 bytes: more than `most` show that the file is larger.
  std::string read_up_to(std::size_t most);

 private:
  std::string path_;
  int descriptor_ = -1;
  State state_ = State::unreadable;
  std::size_t size_ = 0;
};

/// Where a result is written, nothing stands, or a regular file that is no link: nothing is ever written through a link, into a pipe or to
/// a device. Throws FileError with a sentence otherwise. Not collective.
void require_plain_place(const std::string& path);

}  // namespace thixis::core
