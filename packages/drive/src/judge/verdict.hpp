#pragma once
#include <optional>
#include <string>
#include <vector>

#include "thixis/core/error.hpp"
#include "thixis/drive/stationary.hpp"

namespace thixis::drive {

struct Verdict {
  core::ExitCode code = core::ExitCode::done;
  std::string sentence;
};

/// Why a run that ended with X is no solution, and what to try: Newton has not converged, or did and X breaks the contact conditions.
std::string not_converged(const complementarity::NewtonReport& newton);
std::string not_in_contact(const complementarity::NewtonReport& newton, const complementarity::Kkt& kkt, double tolerance);

/// "energy error at most 1.2345e-02 (guaranteed)": an estimate by its name, with what it promises.
std::string bound_clause(const std::string& name, const complementarity::Estimate& eta);

/// ", less than the error: …" where the error of an exact solution is above a bound on it, with what may be the reason: no bound of a wrong
/// problem. Empty where it is not, but for round-off and differences of the exact solution; `norm`: that of the solution, in the same
/// measure.
std::string contradiction(const complementarity::Estimate& eta, std::optional<double> error, double norm);

/// How a run ended, in sentences; the first one that is not empty speaks.
struct Ending {
  bool not_wanted = false;  ///< max iterations = 0
  std::string interrupted;  ///< told to end
  std::string mistaken;     ///< data of a later step are wrong
  std::string failed;       ///< not converged, or no solution
  std::string target;       ///< the target is missed, without the full stop
  std::string solved;
};

/// Did the run do what was asked, in one sentence. `missed`: expectations, a clause each.
Verdict judge(const Ending& ending, const std::vector<std::string>& missed);
Verdict judge(const RunParams& params, const Outcome& outcome);

}  // namespace thixis::drive
