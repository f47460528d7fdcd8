#include "judge/expectations.hpp"

#include <fmt/format.h>

namespace thixis::drive {
namespace {

struct Clauses {
  std::vector<std::string> missed;

  template <class T, class Bound>
  void at_most(const std::string& what, const std::optional<T>& value, const std::optional<Bound>& bound) {
    if (!bound) return;
    if (!value) missed.push_back(fmt::format("{} is not known", what));
    else if (!(*value <= *bound))
      missed.push_back(fmt::format("{} {:.5g} is above {:.5g}", what, static_cast<double>(*value), static_cast<double>(*bound)));
  }
  void between(const std::string& what, const std::optional<double>& value, const std::optional<std::vector<double>>& bounds) {
    if (!bounds) return;
    if (!value) missed.push_back(fmt::format("{} is not known", what));
    else if (!(*value >= bounds->at(0) && *value <= bounds->at(1)))
      missed.push_back(fmt::format("{} {:.5g} is not between {:.5g} and {:.5g}", what, *value, bounds->at(0), bounds->at(1)));
  }
  void within(const models::Expectation& expected) {
    if (!expected.least) return at_most(expected.what, expected.value, expected.most);
    between(expected.what, expected.value, std::vector<double>{*expected.least, *expected.most});
  }
  void promised(const std::optional<complementarity::Promise>& promise, const std::optional<complementarity::Promise>& expected) {
    if (!expected) return;
    if (!promise) missed.push_back("what the bound promises is not known");
    else if (*promise > *expected) missed.push_back(fmt::format("the bound is '{}', not '{}'", to_text(*promise), to_text(*expected)));
  }
  void equal(const char* what, long long value, const std::optional<long long>& expected) {
    if (expected && value != *expected) missed.push_back(fmt::format("{} {}, not {}", what, value, *expected));
  }
};

/// A part of what may not be known.
template <class T, class Part>
auto part(const std::optional<T>& whole, Part f) -> std::optional<std::decay_t<decltype(f(*whole))>> {
  return whole ? std::optional(f(*whole)) : std::nullopt;
}

}  // namespace

std::vector<std::string> missed(const ExpectParams& expect, const Found& found) {
  Clauses clauses;
  if (found.solved) {
    clauses.at_most("energy error", found.energy_error, expect.energy_error_at_most);
    clauses.between("energy error", found.energy_error, expect.energy_error_between);
    clauses.at_most("number of Newton steps", found.newton_iterations, expect.newton_iterations_at_most);
    clauses.at_most("number of Newton steps on the finest level", found.newton_finest, expect.newton_finest_at_most);
    clauses.at_most("number of Krylov iterations", found.linear_iterations, expect.linear_iterations_at_most);
    clauses.at_most("violation of the contact conditions", part(found.kkt, [](const auto& kkt) { return kkt.worst(); }),
                    expect.kkt_at_most);
    clauses.at_most("bound", part(found.estimate, [](const auto& eta) { return eta.total; }), expect.bound_at_most);
    clauses.promised(part(found.estimate, [](const auto& eta) { return eta.promise; }), expect.promise);
    clauses.between("effectivity", found.effectivity(), expect.effectivity_between);
    clauses.at_most("number of time steps", part(found.in_time, [](const auto& time) { return time.steps; }), expect.steps_at_most);
    clauses.at_most("number of steps that were begun again", part(found.in_time, [](const auto& time) { return time.retries; }),
                    expect.retries_at_most);
    for (const models::Expectation& expected : found.of_model) clauses.within(expected);
    clauses.between("energy norm", found.energy_norm, expect.energy_norm_between);
    clauses.between("contact area", part(found.contact, [](const auto& contact) { return contact.area; }), expect.contact_area_between);
    clauses.between("contact force", part(found.contact, [](const auto& contact) { return contact.force; }), expect.force_between);
    for (const auto& [name, at] : expect.at) {
      const auto value = found.at.find(name);
      clauses.between(fmt::format("{} at '{}'", at.field, name), value == found.at.end() ? std::nullopt : std::optional(value->second),
                      at.between);
    }
  }
  clauses.equal("unknowns:", found.sizes.unknowns_all, expect.unknowns);
  clauses.equal("cells:", found.cells, expect.cells);
  return clauses.missed;
}

}  // namespace thixis::drive
