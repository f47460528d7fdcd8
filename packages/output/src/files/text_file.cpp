#include "files/text_file.hpp"

#include <fmt/core.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "thixis/core/error.hpp"
#include "thixis/core/file.hpp"

namespace thixis::output {

std::string not_written(const std::string& path, int error_number) {
  return fmt::format("The file '{}' can not be written: {}.", path, std::strerror(error_number));
}

void write_text(const std::string& path, const std::string& text) {
  const std::string temporary = path + ".part";
  core::require_plain_place(path);
  core::require_plain_place(temporary);
  std::FILE* file = std::fopen(temporary.c_str(), "w");
  if (file == nullptr) throw core::FileError(not_written(path, errno));
  int error = 0;
  if (std::fwrite(text.data(), 1, text.size(), file) != text.size() || std::fflush(file) != 0) error = errno;
  if (std::fclose(file) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return;
  std::remove(temporary.c_str());
  throw core::FileError(not_written(path, error));
}

}  // namespace thixis::output
