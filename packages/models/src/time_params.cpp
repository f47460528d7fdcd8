#include <fmt/core.h>

#include "thixis/models/params.hpp"

namespace thixis::models {
namespace {

/// A run has an end that it can reach, and steps that move the time.
void check_steps(const TimeParams& params, core::Problems& problems) {
  const double least = params.adaptive ? params.largest.value_or(params.end) : params.step;
  if (params.end / least > TimeParams::most_steps)
    problems.add(params.adaptive ? "largest" : "step",
                 fmt::format("makes {:.3g} steps until the end at {:g}, and a run may have {:g}; write at least {:.3g}.",
                             params.end / least, params.end, TimeParams::most_steps, params.end / TimeParams::most_steps));
  const double resolved = TimeParams::resolution * params.end;
  const auto require_resolved = [&](const char* name, double length) {
    if (length < resolved)
      problems.add(name,
                   fmt::format("is lost among the digits of the time at the end, {:g}; write at least {:.3g}.", params.end, resolved));
  };
  require_resolved("step", params.step);
  if (params.smallest) require_resolved("smallest", *params.smallest);
}

}  // namespace

double seconds_in(TimeUnit unit) { return unit == TimeUnit::year ? 365.25 * 86400 : 1; }

const core::Schema<TimeParams>& TimeParams::schema() {
  static const auto schema =
      core::Schema<TimeParams>("time", "Scenes in time: backward Euler from 0 to the end.")
          .choice("unit", &TimeParams::unit, {{"none", TimeUnit::none}, {"second", TimeUnit::second}, {"year", TimeUnit::year}},
                  "Unit of all times of the deck, of t in expressions, and of rates; a year has 365.25 days.")
          .parameter("step", &TimeParams::step, core::above(0), "Length of the steps; with adaptive = true that of the first one.")
          .required()
          .parameter("end", &TimeParams::end, core::above(0), "Where the run ends.")
          .required()
          .parameter("adaptive", &TimeParams::adaptive, "Whether the time part of the error estimate controls the length of the steps.")
          .parameter("also", &TimeParams::also, "Further times at which a step ends, e.g. where data jump.")
          .parameter("smallest", &TimeParams::smallest, core::above(0),
                     "A step that fails is cut; one below this length ends the run. Not given: 'step' / 2^20, or 1e-13 of the end if that "
                     "is more.")
          .parameter("largest", &TimeParams::largest, core::above(0), "Longest step; not given: the whole time.")
          .parameter("growth", &TimeParams::growth, core::above(1), "The next step is at most so many times longer.")
          .check([](const TimeParams& params, core::Problems& problems) {
            check_steps(params, problems);
            if (params.smallest && *params.smallest > params.step) problems.add("smallest", "must not be above 'step'.");
            if (params.smallest && params.largest && *params.smallest > *params.largest)
              problems.add("largest", "must not be below 'smallest'.");
            for (const double t : params.also)
              if (!(t > 0 && t < params.end)) problems.add("also", "must hold times between 0 and the end.");
          });
  return schema;
}

}  // namespace thixis::models
