#pragma once
#include <optional>
#include <string>
#include <vector>

#include "thixis/complementarity/newton.hpp"
#include "thixis/core/error.hpp"
#include "thixis/drive/effort.hpp"
#include "thixis/drive/params.hpp"

namespace thixis::drive {

struct Verdict {
  core::ExitCode code = core::ExitCode::done;
  std::string sentence;
};

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

/// "3 Newton steps and 20 Krylov iterations".
std::string effort_clause(const Effort& effort);

/// "energy error at most 1.2345e-02 (guaranteed)": an estimate by its name, with what it promises.
std::string bound_clause(const std::string& name, const complementarity::Estimate& eta);

/// ", less than the error: …" where the error of an exact solution is above a bound on it, with what may be the reason: no bound of a wrong
/// problem. Empty where it is not, but for round-off and differences of the exact solution; `norm`: that of the solution, in the same
/// measure.
std::string contradiction(const complementarity::Estimate& eta, std::optional<double> error, double norm);

/// "contact conditions hold to 1.0e-13", and where they do not, that nobody asks.
std::string contact_clause(const complementarity::Kkt& kkt, double tolerance);

/// Why X, where Newton stopped, breaks the contact conditions, and what to try; empty: it does not, or the rule adaptive does not judge.
std::string not_in_contact(const RunParams& params, const complementarity::NewtonReport& newton,
                           const std::optional<complementarity::Kkt>& kkt, double tolerance);

}  // namespace thixis::drive
