#pragma once
#include <map>

#include "thixis/drive/evolve.hpp"
#include "thixis/drive/params.hpp"
#include "thixis/drive/stationary.hpp"

namespace thixis::drive {

/// What a run has found: what `expect` judges and the summary shows. What is not known is empty.
struct Found {
  bool solved = true;  ///< false: nothing was to be solved, only the counts are judged
  models::Sizes sizes;
  GlobalIndex cells = 0;
  std::optional<double> energy_error, energy_norm;
  std::optional<complementarity::Estimate> estimate;
  std::vector<std::string> doubts;  ///< what keeps it from being guaranteed
  std::optional<models::PublishedEstimate> published;
  std::optional<complementarity::Kkt> kkt;
  std::optional<models::Contact> contact;
  std::map<std::string, double> at;  ///< by the names of ExpectParams::at
  std::optional<int> newton_iterations, newton_finest, linear_iterations;
  std::optional<long long> active;
  std::optional<output::SummaryTime> in_time;
  std::vector<models::Expectation> of_model;
  std::vector<output::SummaryEntry> summary;

  std::optional<double> effectivity() const;  ///< estimate / energy error, if both are known
};
Found found(const Outcome& outcome);
Found found(const RunParams& params, const models::Model& model, const models::Evolution& evolution, const EvolutionOutcome& outcome);

/// The expectations that are missed, a clause each: "energy error 2.1e-03 is above 2.0e-03".
std::vector<std::string> missed(const ExpectParams& expect, const Found& found);

}  // namespace thixis::drive
