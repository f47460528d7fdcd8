#include <algorithm>

#include "schemas.hpp"
#include "thixis/core/text.hpp"

namespace thixis::models {
namespace {

/// A pair of bounds is two numbers in order.
constexpr const char* pair_rule = "must hold the smallest and the largest value allowed, e.g. {1.0, 1.2}.";
bool in_order(const std::vector<double>& pair) { return pair.size() == 2 && pair[0] <= pair[1]; }

/// "membranes, parabolic membranes: u1, u2, lambda, gap; obstacle: u, lambda, gap".
std::string point_fields(const Catalogue& catalogue) {
  std::vector<std::pair<std::string, std::string>> models;  // by their fields
  for (const Entry& model : catalogue.models()) {
    const std::string fields = core::join(model.point_fields);
    const auto same = std::find_if(models.begin(), models.end(), [&](const auto& known) { return known.first == fields; });
    if (same == models.end()) models.emplace_back(fields, model.name);
    else same->second += ", " + model.name;
  }
  std::string text;
  for (const auto& [fields, names] : models) text += (text.empty() ? "" : "; ") + names + ": " + fields;
  return text;
}

core::Schema<ExpectAtParams> at_schema(const Catalogue& catalogue) {
  return core::Schema<ExpectAtParams>("at", "Values of fields at points, at the end: a sublist for each one, with a name of your own.")
      .parameter("place", &ExpectAtParams::place, core::entries(1, 2), "The point: {x,y}, on an interval {x}.")
      .required()
      .parameter("field", &ExpectAtParams::field,
                 "Of " + point_fields(catalogue) + ". In a cell of the lowest number where the point lies on several.")
      .required()
      .parameter("between", &ExpectAtParams::between, core::entries(2), "Smallest and largest value.")
      .required()
      .check([](const ExpectAtParams& params, core::Problems& problems) {
        if (problems.given("between") && !in_order(params.between)) problems.add("between", pair_rule);
      });
}

}  // namespace

void check_pair(const std::optional<std::vector<double>>& pair, const std::string& name, core::Problems& problems) {
  if (pair && !in_order(*pair)) problems.add(name, pair_rule);
}

core::Schema<ExpectParams> expect_schema(const Catalogue& catalogue) {
  using complementarity::Promise;
  auto schema =
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
          .parameter("energy norm between", &ExpectParams::energy_norm_between, "Smallest and largest energy norm of the solution.")
          .parameter(
              "contact area between", &ExpectParams::contact_area_between,
              "Smallest and largest area of the contact zone, at the end: the integrals of the basis functions of the points in contact "
              "that are not held.")
          .parameter(
              "force between", &ExpectParams::force_between,
              "Smallest and largest integral of the contact force, at the end; what held points carry counts as force of the boundary.")
          .blocks("at", &ExpectParams::at, at_schema(catalogue))
          .check([](const ExpectParams& params, core::Problems& problems) {
            check_pair(params.energy_error_between, "energy error between", problems);
            check_pair(params.effectivity_between, "effectivity between", problems);
            check_pair(params.energy_norm_between, "energy norm between", problems);
            check_pair(params.contact_area_between, "contact area between", problems);
            check_pair(params.force_between, "force between", problems);
          });
  for (const Family& family : catalogue.families())
    if (family.expect) family.expect(schema);
  return schema;
}

}  // namespace thixis::models
