#include "thixis/drive/params.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>

namespace thixis::drive {
namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// A pair of bounds is two numbers in order.
constexpr const char* pair_rule = "must hold the smallest and the largest value allowed, e.g. {1.0, 1.2}.";
bool in_order(const std::vector<double>& pair) { return pair.size() == 2 && pair[0] <= pair[1]; }

void check_pair(const std::optional<std::vector<double>>& pair, const std::string& name, core::Problems& problems) {
  if (pair && !in_order(*pair)) problems.add(name, pair_rule);
}

core::Range above_0_up_to_1() {
  core::Range range = core::between(0, 1);
  range.lower_open = true;
  return range;
}

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

bool of_estimate(const std::string& name) { return std::count(names_of_estimate().begin(), names_of_estimate().end(), name) > 0; }

}  // namespace

const std::vector<std::string>& names_of_estimate() {
  static const std::vector<std::string> names = {"eta_disc", "eta_lin", "eta_alg"};
  return names;
}

std::vector<std::string> OutputParams::estimate_names() const {
  if (fields == "all") return names_of_estimate();
  std::vector<std::string> names;
  for (const auto& name : field_names())
    if (of_estimate(name)) names.push_back(name);
  return names;
}

std::vector<std::string> OutputParams::model_names() const {
  std::vector<std::string> names;
  for (const auto& name : field_names())
    if (!of_estimate(name)) names.push_back(name);
  return names;
}

std::vector<std::string> OutputParams::field_names() const {
  std::vector<std::string> names;
  if (fields == "all" || fields == "none") return names;
  std::istringstream list(fields);
  for (std::string name; std::getline(list, name, ',');) names.push_back(trimmed(name));
  return names;
}

const core::Schema<OutputParams>& OutputParams::schema() {
  static const auto schema =
      core::Schema<OutputParams>("output", "What is written, and where.")
          .parameter("directory", &OutputParams::directory, "Folder of the results; if empty, results/<name of the deck>.")
          .parameter("fields", &OutputParams::fields, "Fields for fields.h5: all, none, or names separated by commas.")
          .parameter("history", &OutputParams::history, "Whether history.csv is written.")
          .parameter("checkpoint every", &OutputParams::checkpoint_every, core::at_least(0),
                     "checkpoint.h5 is written after so many Newton steps (scenes in time: time steps), again and again, and at the end; "
                     "0: only where a run ends without convergence or is told to end.")
          .parameter("fields every", &OutputParams::fields_every, core::at_least(1),
                     "Scenes in time: fields are written after so many steps, and at the beginning and the end.")
          .parameter(
              "probes", &OutputParams::probes,
              "Points, x and y of each one (intervals: x alone), whose values are written: in time to series.csv after every step, the "
              "fields of the second point with _2 behind their names; of stationary scenes to probes.csv at the end. Not given: none; "
              "two-phase flow: the cell at the left end.")
          .check([](const OutputParams& params, core::Problems& problems) {
            if (trimmed(params.fields).empty()) problems.add("fields", "must be all, none, or names separated by commas.");
          });
  return schema;
}

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

const core::Schema<AdaptParams>& AdaptParams::schema() {
  static const auto schema =
      core::Schema<AdaptParams>("adapt",
                                "How the mesh is refined until the bound on the error is at most stopping/target; without a target, "
                                "as far as the limits allow.")
          .choice("marking", &AdaptParams::marking, {{"dorfler", Marking::dorfler}, {"uniform", Marking::uniform}},
                  "The fewest cells with a given share of the squared discretization error, or all cells.")
          .parameter("theta", &AdaptParams::theta, above_0_up_to_1(),
                     "Share of marking = dorfler: the marked cells hold theta² of the squared discretization error.")
          .parameter("max levels", &AdaptParams::max_levels, core::at_least(0), "Meshes that are added to those of the deck at most.")
          .parameter("max unknowns", &AdaptParams::max_unknowns, core::at_least(1),
                     "No mesh with more unknowns is solved, the multiplier counted.");
  return schema;
}

const core::Schema<ExpectAtParams>& ExpectAtParams::schema() {
  static const auto schema =
      core::Schema<ExpectAtParams>("at", "Values of fields at points, at the end: a sublist for each one, with a name of your own.")
          .parameter("place", &ExpectAtParams::place, core::entries(1, 2), "The point: {x,y}, on an interval {x}.")
          .required()
          .parameter("field", &ExpectAtParams::field,
                     "u1, u2, lambda or gap; model obstacle: u, lambda, gap; two-phase: s_g, p_l, p_g, chi. In a cell of the lowest number "
                     "where the point lies on several.")
          .required()
          .parameter("between", &ExpectAtParams::between, core::entries(2), "Smallest and largest value.")
          .required()
          .check([](const ExpectAtParams& params, core::Problems& problems) {
            if (problems.given("between") && !in_order(params.between)) problems.add("between", pair_rule);
          });
  return schema;
}

const core::Schema<ExpectParams>& ExpectParams::schema() {
  using complementarity::Promise;
  static const auto schema =
      core::Schema<ExpectParams>("expect", "What must hold of the result; if it does not, the run ends with exit code 4.")
          .parameter("energy error at most", &ExpectParams::energy_error_at_most, core::above(0), "Bound on the true energy error.")
          .parameter("energy error between", &ExpectParams::energy_error_between, "Smallest and largest true energy error.")
          .parameter("newton iterations at most", &ExpectParams::newton_iterations_at_most, core::at_least(0),
                     "Newton steps on all levels.")
          .parameter("newton finest at most", &ExpectParams::newton_finest_at_most, core::at_least(0), "Newton steps on the finest level.")
          .parameter("linear iterations at most", &ExpectParams::linear_iterations_at_most, core::at_least(0), "Krylov iterations in all.")
          .parameter("kkt at most", &ExpectParams::kkt_at_most, core::above(0), "Largest violation of the contact conditions, relative.")
          .parameter("effectivity between", &ExpectParams::effectivity_between, "Smallest and largest ratio of bound and true error.")
          .parameter("bound at most", &ExpectParams::bound_at_most, core::above(0),
                     "Largest bound on the energy error, whatever it promises.")
          .choice("promise", &ExpectParams::promise,
                  {{to_text(Promise::guaranteed), Promise::guaranteed},
                   {to_text(Promise::up_to_quadrature), Promise::up_to_quadrature},
                   {to_text(Promise::indicator), Promise::indicator}},
                  "What the estimate must promise at least.")
          .parameter("unknowns", &ExpectParams::unknowns, core::at_least(0), "Number of unknowns, the multiplier included.")
          .parameter("cells", &ExpectParams::cells, core::at_least(0), "Number of cells.")
          .parameter("steps at most", &ExpectParams::steps_at_most, core::at_least(1), "Time steps.")
          .parameter("retries at most", &ExpectParams::retries_at_most, core::at_least(0), "Attempts at time steps that were given up.")
          .parameter("water balance at most", &ExpectParams::water_balance_at_most, core::above(0),
                     "Largest defect of a step in the mass of water, relative to the water in place.")
          .parameter("hydrogen balance at most", &ExpectParams::hydrogen_balance_at_most, core::above(0),
                     "Largest defect of a step in the mass of hydrogen, relative to what was injected.")
          .parameter("front between", &ExpectParams::front_between, "Smallest and largest position of the gas front at the end.")
          .parameter("energy norm between", &ExpectParams::energy_norm_between, "Smallest and largest energy norm of the solution.")
          .parameter(
              "contact area between", &ExpectParams::contact_area_between,
              "Smallest and largest area of the contact zone, at the end: the integrals of the basis functions of the points in contact "
              "that are not held.")
          .parameter(
              "force between", &ExpectParams::force_between,
              "Smallest and largest integral of the contact force, at the end; what held points carry counts as force of the boundary.")
          .blocks("at", &ExpectParams::at, ExpectAtParams::schema())
          .check([](const ExpectParams& params, core::Problems& problems) {
            check_pair(params.energy_error_between, "energy error between", problems);
            check_pair(params.effectivity_between, "effectivity between", problems);
            check_pair(params.front_between, "front between", problems);
            check_pair(params.energy_norm_between, "energy norm between", problems);
            check_pair(params.contact_area_between, "contact area between", problems);
            check_pair(params.force_between, "force between", problems);
          });
  return schema;
}

const core::Schema<RunParams>& RunParams::schema() {
  static const auto schema = core::Schema<RunParams>("thixis", "A deck: one question per block.")
                                 .block("scene", &RunParams::scene, scene::SceneParams::schema())
                                 .required()
                                 .block("mesh", &RunParams::mesh, mesh::MeshParams::schema())
                                 .block("method", &RunParams::method, method::MethodParams::schema())
                                 .block("newton", &RunParams::newton, complementarity::NewtonParams::schema())
                                 .block("linear", &RunParams::linear, algebra::LinearParams::schema())
                                 .block("stopping", &RunParams::stopping, complementarity::StoppingParams::schema())
                                 .block("adapt", &RunParams::adapt, AdaptParams::schema())
                                 .block("time", &RunParams::time, TimeParams::schema())
                                 .block("output", &RunParams::output, OutputParams::schema())
                                 .block("expect", &RunParams::expect, ExpectParams::schema());
  return schema;
}

bool RunParams::estimated() const {
  return stopping.estimate.value_or(false) || stopping.rule == complementarity::StoppingRule::adaptive || adaptive() ||
         (time && time->adaptive);
}

}  // namespace thixis::drive
