#include "verify/worst.hpp"

#include <cmath>
#include <limits>

namespace thixis::flow {
namespace {

constexpr int water = 0, hydrogen = 1;
constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

void see(FlowFindings::Worst& worst, double violation, GlobalIndex cell) {
  if (!(violation <= infinite)) violation = infinite;
  if (violation > worst.violation) worst = {violation, cell, {0, 0}};
}

void settle(const fv::Grid& grid, const fv::HostGrid& on_host, FlowFindings& found) {
  FlowFindings::Worst* const all[] = {&found.unbalanced[water],
                                      &found.unbalanced[hydrogen],
                                      &found.negative_gas,
                                      &found.supersaturated,
                                      &found.both_open,
                                      &found.negative_dissolved,
                                      &found.negative_pressure,
                                      &found.all_dissolved,
                                      &found.dry,
                                      &found.not_finite};
  std::vector<double> worst, minus_id, centres;
  for (const auto* of : all) worst.push_back(of->violation);
  grid.comm.max(worst);
  for (std::size_t i = 0; i < worst.size(); ++i)
    minus_id.push_back(all[i]->cell >= 0 && all[i]->violation == worst[i] ? -static_cast<double>(all[i]->cell) : -infinite);
  std::vector<double> chosen = minus_id;
  grid.comm.max(chosen);
  for (std::size_t i = 0; i < worst.size(); ++i) {
    const bool here = all[i]->cell >= 0 && minus_id[i] == chosen[i];
    LocalIndex K = 0;
    while (here && grid.cell_id[K] != all[i]->cell) ++K;
    for (int k = 0; k < 2; ++k) centres.push_back(here ? on_host.centre(K, k) : 0);
  }
  grid.comm.sum(centres);
  for (std::size_t i = 0; i < worst.size(); ++i)
    *all[i] = {worst[i], std::isfinite(chosen[i]) ? static_cast<GlobalIndex>(-chosen[i]) : -1, {centres[2 * i], centres[2 * i + 1]}};
}

}  // namespace thixis::flow
