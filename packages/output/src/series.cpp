#include "thixis/output/series.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "table.hpp"
#include "thixis/core/error.hpp"

namespace thixis::output {
namespace {

[[noreturn]] void wrong(const std::string& sentence) { throw core::Error(core::ExitCode::internal, sentence); }

bool is_word(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

std::string header(const std::vector<std::string>& names) {
  std::set<std::string> taken{"time"};
  std::string text = "time";
  for (const std::string& name : names) {
    if (!is_word(name)) wrong(fmt::format("A column can not be called '{}': its name must be made of letters, digits and '_'.", name));
    if (!taken.insert(name).second) wrong(fmt::format("Two columns are called '{}'.", name));
    text += "," + name;
  }
  return text + "\n";
}

}  // namespace

Series::Series(const std::string& path, const std::vector<std::string>& names, const core::Comm& comm) : Series(path, names, 0, comm) {}

Series Series::go_on(const std::string& path, const std::vector<std::string>& names, GlobalIndex rows, const core::Comm& comm) {
  return {path, names, rows, comm};
}

Series::Series(const std::string& path, const std::vector<std::string>& names, GlobalIndex rows_kept, const core::Comm& comm)
    : comm_(comm), columns_(names.size()) {
  const std::string first_line = comm.together([&] { return header(names); });
  table_ = std::make_unique<Table>(path, first_line, rows_kept, comm);
}
Series::~Series() = default;
Series::Series(Series&&) noexcept = default;
Series& Series::operator=(Series&&) noexcept = default;

void Series::append(double time, const std::vector<double>& values) {
  const std::string line = comm_.together([&] {
    if (values.size() != columns_) wrong(fmt::format("A row of the series has {} values where {} are needed.", values.size(), columns_));
    std::string text = fmt::format("{}", time);
    for (const double value : values) text += fmt::format(",{}", value);
    return text + "\n";
  });
  table_->append(line);
}

GlobalIndex Series::rows() const { return table_->rows(); }

}  // namespace thixis::output
