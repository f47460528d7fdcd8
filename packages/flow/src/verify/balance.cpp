#include "verify/balance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thixis::flow {
namespace {

const std::array<const char*, components> names = {"water", "hydrogen"};
constexpr double last_place = 1e-8;  // of what is there: at a tolerance of 1e-6 some units in the last place of the masses

}  // namespace

TwoPhaseBalance::Account TwoPhaseBalance::added(Account account, int component, const FlowFindings& found) {
  const FlowFindings::Account& of_step = found.accounts[component];
  account.defect = of_step.defect;
  account.total += of_step.defect;
  account.brought += of_step.brought;
  account.drawn += of_step.drawn;
  account.in_place = of_step.in_place;
  account.worst = std::max(account.worst, std::abs(account.defect) / reference(component, account));
  return account;
}

void TwoPhaseBalance::add(const FlowFindings& found) {
  for (int c = 0; c < components; ++c) accounts_[c] = added(accounts_[c], c, found);
}

std::string TwoPhaseBalance::objection(const FlowFindings& found, double tolerance) const {
  for (int c = 0; c < components; ++c) {
    const Account account = added(accounts_[c], c, found);
    const double counts = std::max({reference(c, account), account.drawn, last_place * account.in_place});
    const double lost = std::max(std::abs(account.defect), std::abs(account.total)) / counts;
    if (lost <= tolerance) continue;
    return fmt::format(
        "The {} of the whole domain is out of balance by {:.2e} of {}. Try linear/solver = direct or a smaller stopping/linear tolerance; "
        "where a phase flows so easily that its pressure hardly differs from cell to cell, give it a larger viscosity (scene/flow).",
        names[c], lost,
        account.drawn >= counts                ? "what has been drawn"
        : c == hydrogen && account.brought > 0 ? "what has come in"
                                               : "what is there");
  }
  return "";
}

double TwoPhaseBalance::reference(int component, const Account& account) {
  const double wanted = component == hydrogen && account.brought > 0 ? account.brought : account.in_place;
  return wanted > 0 ? wanted : 1;
}

std::vector<models::Balance> TwoPhaseBalance::balances() const {
  std::vector<models::Balance> all;
  for (int c = 0; c < components; ++c) {
    const Account& account = accounts_[c];
    all.push_back(
        {names[c], std::abs(account.defect) / reference(c, account), account.worst, std::abs(account.total) / reference(c, account)});
  }
  return all;
}

std::map<std::string, double> TwoPhaseBalance::save() const {
  std::map<std::string, double> saved;
  for (int c = 0; c < components; ++c) {
    const Account& account = accounts_[c];
    const std::string name = names[c];
    saved[name + "_defect"] = account.defect;
    saved[name + "_worst"] = account.worst;
    saved[name + "_total"] = account.total;
    saved[name + "_brought"] = account.brought;
    saved[name + "_drawn"] = account.drawn;
    saved[name + "_in_place"] = account.in_place;
  }
  return saved;
}

void TwoPhaseBalance::restore(const output::StoredCheckpoint& stored) {
  for (int c = 0; c < components; ++c) {
    const auto read = [&](const char* what) { return stored.number(std::string(names[c]) + "_" + what); };
    const bool knows_drawn = stored.has_attribute(std::string(names[c]) + "_drawn");
    accounts_[c] = {read("defect"), read("worst"), read("total"), read("brought"), knows_drawn ? read("drawn") : 0, read("in_place")};
  }
}

}  // namespace thixis::flow
