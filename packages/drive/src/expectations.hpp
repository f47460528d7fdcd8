#pragma once
#include <map>

#include "thixis/drive/params.hpp"
#include "thixis/drive/stationary.hpp"
#include "thixis/models/evolution.hpp"

namespace thixis::drive {

/// What a run has found, as far as `expect` can judge it; what is not known is empty.
struct Found {
  bool solved = true;  ///< false: nothing was to be solved, only the counts are judged
  std::optional<double> energy_error, kkt, bound, effectivity;
  std::optional<complementarity::Promise> promise;
  std::optional<int> newton_iterations, newton_finest, linear_iterations, steps, retries;
  std::vector<models::Expectation> of_model;
  std::optional<double> energy_norm;
  std::optional<models::Contact> contact;
  std::map<std::string, double> at;  ///< by the names of ExpectParams::at
  GlobalIndex unknowns = 0, cells = 0;
};
Found found(const Outcome& outcome);

/// The values that `expect` asks for among all fields at its points, [point][field].
std::map<std::string, double> values_by_name(const ExpectParams& expect, const std::vector<std::string>& fields,
                                             const std::vector<double>& values);

/// The expectations that are missed, a clause each: "energy error 2.1e-03 is above 2.0e-03".
std::vector<std::string> missed(const ExpectParams& expect, const Found& found);

}  // namespace thixis::drive
