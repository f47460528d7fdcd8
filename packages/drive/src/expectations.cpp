#include "expectations.hpp"

#include <fmt/format.h>

namespace thixis::drive {
namespace {

struct Clauses {
  std::vector<std::string> missed;

  template <class T, class Bound>
  void at_most(const char* what, const std::optional<T>& value, const std::optional<Bound>& bound) {
    if (!bound) return;
    if (!value) missed.push_back(fmt::format("{} is not known", what));
    else if (!(*value <= *bound))
      missed.push_back(fmt::format("{} {:.5g} is above {:.5g}", what, static_cast<double>(*value), static_cast<double>(*bound)));
  }
  void between(const char* what, const std::optional<double>& value, const std::optional<std::vector<double>>& bounds) {
    if (!bounds) return;
    if (!value) missed.push_back(fmt::format("{} is not known", what));
    else if (!(*value >= bounds->at(0) && *value <= bounds->at(1)))
      missed.push_back(fmt::format("{} {:.5g} is not between {:.5g} and {:.5g}", what, *value, bounds->at(0), bounds->at(1)));
  }
  void equal(const char* what, long long value, const std::optional<long long>& expected) {
    if (expected && value != *expected) missed.push_back(fmt::format("{} {}, not {}", what, value, *expected));
  }
};

}  // namespace

std::vector<std::string> missed(const ExpectParams& expect, const Outcome& outcome, long long cells) {
  Clauses clauses;
  std::optional<double> kkt;
  std::optional<double> bound;
  if (outcome.estimate) bound = outcome.estimate->total;
  if (outcome.kkt) kkt = outcome.kkt->worst();
  if (!outcome.not_wanted) {
    clauses.at_most("energy error", outcome.energy_error, expect.energy_error_at_most);
    clauses.between("energy error", outcome.energy_error, expect.energy_error_between);
    clauses.at_most("number of Newton steps", std::optional(outcome.at.newton_iterations), expect.newton_iterations_at_most);
    clauses.at_most("number of Newton steps on the finest level", std::optional(outcome.at.newton_on_level), expect.newton_finest_at_most);
    clauses.at_most("number of Krylov iterations", std::optional(outcome.at.linear_iterations), expect.linear_iterations_at_most);
    clauses.at_most("violation of the contact conditions", kkt, expect.kkt_at_most);
    clauses.at_most("bound", bound, expect.bound_at_most);
    clauses.between("effectivity", outcome.effectivity(), expect.effectivity_between);
  }
  clauses.equal("unknowns:", outcome.discretization->sizes().unknowns_all, expect.unknowns);
  clauses.equal("cells:", cells, expect.cells);
  return clauses.missed;
}

}  // namespace thixis::drive
