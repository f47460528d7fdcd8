#include "thixis/output/history.hpp"

#include <fmt/core.h>

#include "table.hpp"

namespace thixis::output {
namespace {

const std::string header =
    "level,time_step,time,newton,linear,active,changed,residual,eta_disc,eta_lin,eta_alg,eta_total,eta_time,promise,energy_error,seconds\n";

template <class... T>
std::string line(const std::optional<T>&... entries) {
  std::string text;
  ((text += entries ? fmt::format("{},", *entries) : std::string(",")), ...);
  text.back() = '\n';
  return text;
}

}  // namespace

History::History(const std::string& path, const core::Comm& comm, bool enabled) : History(path, 0, enabled, comm) {}

History History::go_on(const std::string& path, GlobalIndex rows, const core::Comm& comm, bool enabled) {
  return {path, rows, enabled, comm};
}

History::History(const std::string& path, GlobalIndex rows_kept, bool enabled, const core::Comm& comm) {
  if (enabled) table_ = std::make_unique<Table>(path, header, rows_kept, comm);
}
History::~History() = default;
History::History(History&&) noexcept = default;
History& History::operator=(History&&) noexcept = default;

void History::append(const HistoryRow& row) {
  if (!table_) return;
  table_->append(line(row.level, row.time_step, row.time, row.newton, row.linear, row.active, row.changed, row.residual, row.eta_disc,
                      row.eta_lin, row.eta_alg, row.eta_total, row.eta_time, row.promise, row.energy_error, row.seconds));
}

GlobalIndex History::rows() const { return table_ ? table_->rows() : 0; }

}  // namespace thixis::output
