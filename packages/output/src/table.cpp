#include "table.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "files/text_file.hpp"
#include "thixis/core/error.hpp"
#include "thixis/core/file.hpp"

namespace thixis::output {
namespace {

/// Header and at most `rows` whole rows of the file; nothing if it does not begin with the header.
std::string beginning(const std::string& path, const std::string& header, GlobalIndex rows) {
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

struct Table::File {
  std::unique_ptr<std::FILE, CloseFile> stream;
};

Table::Table(const std::string& path, const std::string& header, GlobalIndex rows_kept, const core::Comm& comm)
    : path_(path), comm_(comm), file_(std::make_unique<File>()) {
  rows_ = comm.on_root([&] {
    core::require_plain_place(path);
    const std::string kept = rows_kept > 0 ? beginning(path, header, rows_kept) : std::string();
    if (!kept.empty() && ::truncate(path.c_str(), static_cast<off_t>(kept.size())) != 0) throw core::FileError(not_written(path, errno));
    file_->stream.reset(std::fopen(path.c_str(), kept.empty() ? "w" : "a"));
    if (!file_->stream) throw core::FileError(not_written(path, errno));
    if (kept.empty()) write(header);
    return std::max<GlobalIndex>(0, std::count(kept.begin(), kept.end(), '\n') - 1);
  });
}
Table::~Table() = default;
Table::Table(Table&&) noexcept = default;
Table& Table::operator=(Table&&) noexcept = default;

void Table::write(const std::string& text) {
  std::FILE* file = file_->stream.get();
  if (std::fwrite(text.data(), 1, text.size(), file) != text.size() || std::fflush(file) != 0)
    throw core::FileError(not_written(path_, errno));
}

void Table::append(const std::string& line) {
  comm_.on_root([&] { write(line); });
  ++rows_;
}

}  // namespace thixis::output
