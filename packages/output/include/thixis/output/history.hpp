#pragma once
#include <memory>
#include <optional>
#include <string>

#include "thixis/core/comm.hpp"
#include "thixis/core/types.hpp"

namespace thixis::output {

class Table;

/// A row of the history: of a linear check, a Newton step, a mesh level or a time step. What was not computed stays empty.
struct HistoryRow {
  std::optional<int> level, time_step;
  std::optional<double> time;                  ///< in the unit of the deck
  std::optional<int> newton;                   ///< step k
  std::optional<int> linear;                   ///< Krylov iterations of that step so far
  std::optional<GlobalIndex> active, changed;  ///< contact points
  std::optional<double> residual;
  std::optional<double> eta_disc, eta_lin, eta_alg, eta_total;
  std::optional<double> eta_time;      ///< how much of eta_disc shorter steps would take away
  std::optional<std::string> promise;  ///< what eta_total promises, in words
  std::optional<double> energy_error;
  std::optional<double> seconds;  ///< since the start of the run; behind a restart with those spent before it
};

/// The file `history.csv`: the header
/// `level,time_step,time,newton,linear,active,changed,residual,eta_disc,eta_lin,eta_alg,eta_total,eta_time,promise,energy_error,seconds`,
/// then one line per row, in the file as soon as append() returns. Numbers read back as they were (`nan`, `inf` for those that are not
/// finite).
class History {
 public:
  /// Overwrites the file. A history that is not enabled writes nothing and touches no file. Collective; throws FileError on all ranks.
  History(const std::string& path, const core::Comm& comm, bool enabled = true);
  /// Goes on with the file of an interrupted run: the header and the first `rows` rows stay (fewer, if there are fewer; a row that was cut
  /// off when the program was killed is not one), later ones, which the run will write again, are removed. A file that is absent or no
  /// history begins anew.
  static History go_on(const std::string& path, GlobalIndex rows, const core::Comm& comm, bool enabled = true);
  ~History();
  History(History&&) noexcept;
  History& operator=(History&&) noexcept;

  /// Writes the row of the root. Collective; throws FileError on all ranks.
  void append(const HistoryRow& row);
  /// Rows in the file so far, on all ranks; 0 if not enabled. Not collective.
  GlobalIndex rows() const;

 private:
  History(const std::string& path, GlobalIndex rows_kept, bool enabled, const core::Comm& comm);
  std::unique_ptr<Table> table_;  ///< none if not enabled
};

}  // namespace thixis::output
