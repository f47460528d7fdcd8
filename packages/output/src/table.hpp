#pragma once
#include <memory>
#include <string>

#include "thixis/core/comm.hpp"
#include "thixis/core/types.hpp"

namespace thixis::output {

/// A text file of a header and rows, one line each, to which the root appends. A row is in the file as soon as append() returns, so that a
/// program that is killed leaves all its rows and at most one that was cut off, which has no end of line.
class Table {
 public:
  /// The header (with its end of line) and the first `rows_kept` rows of an older file stay, fewer if it has fewer whole ones; the rest of
  /// it is removed. A file that is absent, or has another header, or rows_kept = 0 begin anew. Collective; throws FileError on all ranks.
  Table(const std::string& path, const std::string& header, GlobalIndex rows_kept, const core::Comm& comm);
  ~Table();
  Table(Table&&) noexcept;
  Table& operator=(Table&&) noexcept;

  /// Writes the line of the root, which ends it. Collective; throws FileError on all ranks.
  void append(const std::string& line);
  /// In the file so far, on all ranks. Not collective.
  GlobalIndex rows() const { return rows_; }

 private:
  struct File;
  void write(const std::string& text);

  std::string path_;
  core::Comm comm_;
  std::unique_ptr<File> file_;  ///< open on the root
  GlobalIndex rows_ = 0;
};

}  // namespace thixis::output
