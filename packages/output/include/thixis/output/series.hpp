#pragma once
#include <memory>
#include <string>
#include <vector>

#include "thixis/core/comm.hpp"
#include "thixis/core/types.hpp"

namespace thixis::output {

class Table;

/// The file `series.csv`: the header `time,<names>`, then one line per time, in the file as soon as append() returns: a run that is killed
/// leaves all of them and at most one that is cut off. Numbers read back as they were (`nan`, `inf` for those that are not finite).
class Series {
 public:
  /// Overwrites the file. Names are letters, digits and '_', each there once (Error, code `internal`). Collective; throws FileError on all
  /// ranks.
  Series(const std::string& path, const std::vector<std::string>& names, const core::Comm& comm);
  /// Goes on with the file of an interrupted run: the first `rows` rows stay (fewer, if there are fewer), later ones, which the run will
  /// write again, are removed. A file that is absent or has other columns begins anew.
  static Series go_on(const std::string& path, const std::vector<std::string>& names, GlobalIndex rows, const core::Comm& comm);
  ~Series();
  Series(Series&&) noexcept;
  Series& operator=(Series&&) noexcept;

  /// Writes the row of the root: the time in the unit of the deck and a value for each name (Error, code `internal`). Collective; throws
  /// FileError on all ranks.
  void append(double time, const std::vector<double>& values);
  /// Rows in the file so far, on all ranks. Not collective.
  GlobalIndex rows() const;

 private:
  Series(const std::string& path, const std::vector<std::string>& names, GlobalIndex rows_kept, const core::Comm& comm);

  core::Comm comm_;
  std::size_t columns_;  ///< behind the time
  std::unique_ptr<Table> table_;
};

}  // namespace thixis::output
