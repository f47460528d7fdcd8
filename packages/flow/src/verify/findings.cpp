#include "verify/findings.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thixis::flow {
namespace {

constexpr int water = 0, hydrogen = 1;
const char* const names[] = {"water", "hydrogen"};

}  // namespace

double FlowFindings::worst() const {
  double worst = 0;
  for (const Worst* of : {&unbalanced[water], &unbalanced[hydrogen], &negative_gas, &supersaturated, &both_open, &not_finite})
    worst = std::max(worst, of->violation);
  return worst;
}

bool FlowFindings::diverged() const { return !(unbalanced[water].violation <= 1 && unbalanced[hydrogen].violation <= 1); }

std::string FlowFindings::objection(double tolerance, bool conditions) const {
  const auto where = [&](const Worst& of) {
    return dimension == 1 ? fmt::format("in cell {} at {:.6g}", of.cell, of.centre[0])
                          : fmt::format("in cell {} at ({:.6g}, {:.6g})", of.cell, of.centre[0], of.centre[1]);
  };
  if (not_finite.violation > 0) return fmt::format("The state is not finite {}.", where(not_finite));
  if (negative_dissolved.violation > tolerance)
    return fmt::format(
        "Dissolved hydrogen would fall below zero {} (chi beta_l/(H P_ref) = {:.2e}): more of it is drawn from there than there is. "
        "Let what draws it (scene/flow) become weaker or end before, or end the run there (time/end).",
        where(negative_dissolved), -negative_dissolved.violation);
  if (negative_pressure.violation > tolerance)
    return fmt::format(
        "The pressure of the gas would fall below zero {} (P_g/P_ref = {:.2e}): more is drawn from there than can flow in. "
        "Let what draws it (scene/flow) become weaker or end before, or end the run there (time/end).",
        where(negative_pressure), -negative_pressure.violation);
  if (all_dissolved.violation > tolerance)
    return fmt::format(
        "The molar fraction of dissolved hydrogen would rise above 1 {}, by {:.2e}: pressures are beyond what the model is for. Let what "
        "enters (scene/flow) become weaker.",
        where(all_dissolved), all_dissolved.violation);
  if (dry.violation > 0)
    return fmt::format(
        "The liquid would fall to its residual saturation S_lr {} (S_e below 0.01), where the laws of the rock end. Draw less water or let "
        "less hydrogen enter (scene/flow), or end the run there (time/end).",
        where(dry));
  if (!conditions) return "";
  if (diverged()) {
    const int c = unbalanced[water].violation > unbalanced[hydrogen].violation ? water : hydrogen;
    return fmt::format(
        "Newton's method diverges: its last state leaves the balance of {} open {}, by {:.2e} times what counts in the step. "
        "Perhaps there is no solution, as where more is drawn than there is or can flow in: let what draws it (scene/flow) become weaker "
        "or end before.",
        names[c], where(unbalanced[c]), unbalanced[c].violation);
  }
  for (int c : {water, hydrogen})
    if (unbalanced[c].violation > tolerance)
      return fmt::format(
          "The {} {} is out of balance by {:.2e} of what counts in the step. Try linear/solver = direct, a smaller stopping/linear "
          "tolerance, or shorter steps (time/step); where a phase flows so easily that its pressure hardly differs from cell to cell, "
          "give it a larger viscosity (scene/flow).",
          names[c], where(unbalanced[c]), unbalanced[c].violation);
  const auto open = [&](const Worst& of, const char* what) {
    return fmt::format("{} {} by {:.2e}. Try a smaller stopping/nonlinear tolerance, or shorter steps (time/step).", what, where(of),
                       of.violation);
  };
  if (negative_gas.violation > tolerance) return open(negative_gas, "The saturation of the gas falls below zero");
  if (supersaturated.violation > tolerance)
    return open(supersaturated, "More hydrogen is dissolved than the pressure of the gas keeps there");
  if (both_open.violation > tolerance) return open(both_open, "Gas and water that could dissolve it are both there");
  return "";
}

}  // namespace thixis::flow
