#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "thixis/core/comm.hpp"
#include "thixis/core/types.hpp"

namespace thixis::output {

/// An estimate of the energy error and its parts.
struct SummaryEstimate {
  double total = 0, discretization = 0, linearization = 0, algebraic = 0;
  std::string promise;                                ///< what it promises, in words
  std::vector<std::string> doubts;                    ///< what keeps it from being guaranteed; none: no such key
  std::vector<std::pair<std::string, double>> terms;  ///< further keys: every term of the bound by its name
  std::optional<double> time = std::nullopt;  ///< key `time` of scenes in time: how much of discretization shorter steps would take away
};

/// What a run in time adds.
struct SummaryTime {
  GlobalIndex steps = 0;    ///< accepted
  GlobalIndex retries = 0;  ///< steps that failed and were begun again, shorter
  double end = 0;           ///< key `time_end`: the end of the last step, in the unit of the deck
};

/// What only one model has to say: a number, or an object of numbers.
struct SummaryEntry {
  std::string key;
  std::optional<double> value;                        ///< none: null
  std::vector<std::pair<std::string, double>> parts;  ///< of the object, if there are any
};

/// What a run says about itself: the object of `summary.json`, members in the order of its keys. What does not exist is null, and so is
/// what is not finite.
struct Summary {
  std::string verdict;  ///< one sentence
  int exit_code = 0;
  std::string model, problem_case, method;  ///< `problem_case`: key `case`
  int degree = 1;
  int ranks = 1, threads = 1;
  GlobalIndex cells = 0;
  struct {
    GlobalIndex all = 0;     ///< all fields with lambda, Dirichlet values not counted
    GlobalIndex global = 0;  ///< rows of the Krylov system
  } unknowns;
  GlobalIndex nonzeros = 0;
  // Behind a restart the counts are totals that include what was done before it.
  GlobalIndex newton_iterations = 0;  ///< on all levels, in all time steps
  GlobalIndex newton_finest = 0;
  GlobalIndex linear_iterations = 0;
  std::optional<SummaryTime> in_time;  ///< keys `steps`, `retries`, `time_end`, which stationary scenes do not have
  std::optional<double> energy_error;  ///< if there is an exact solution
  std::optional<double> energy_norm;
  std::optional<SummaryEstimate> estimate, estimate_published;
  std::optional<double> effectivity, effectivity_published;
  struct {
    std::optional<double> infeasible, negative, complementary, between_nodes, equilibrium;
  } kkt;
  std::optional<GlobalIndex> active_points;
  struct {
    double total = 0, mesh = 0, assembly = 0, preconditioner = 0, linear = 0, estimate = 0, output = 0;
  } time;                ///< seconds
  double memory_mb = 0;  ///< sum over the ranks
  std::vector<std::pair<std::string, std::string>> versions;
  std::vector<SummaryEntry> of_model;  ///< they must not repeat a key (Error, code `internal`)

  bool enabled = true;  ///< write() does something

  /// The object as text, indented.
  std::string text() const;
  /// Writes the root's summary; at any moment either the old or the new file is there. Collective; throws FileError on all ranks.
  void write(const std::string& path, const core::Comm& comm) const;
};

}  // namespace thixis::output
