#include "checks/wanted.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "thixis/core/error.hpp"
#include "thixis/core/text.hpp"

namespace thixis::drive {
namespace {

/// Coordinates of a point of the deck: one on an interval, whose points then have y = 0.
std::size_t dimension(const RunParams& params) { return params.mesh.generator == mesh::Generator::interval ? 1 : 2; }

models::Probe probe(const std::string& path, const double* coordinates, std::size_t dimension) {
  return {path, {coordinates[0], dimension == 1 ? 0 : coordinates[1]}};
}

}  // namespace

models::Wanted wanted(const RunParams& params) {
  models::Wanted wanted;
  wanted.fields = params.output.model_names();
  const std::size_t d = dimension(params);
  for (const auto& [name, value] : params.expect.at)
    wanted.expected.push_back(probe("expect/at/" + name + "/place", value.place.data(), d));
  const auto& probes = params.output.probes;
  for (std::size_t i = 0; i + d <= probes.size(); i += d) wanted.probes.push_back(probe("output/probes", &probes[i], d));
  return wanted;
}

std::map<std::string, double> values_by_name(const ExpectParams& expect, const std::vector<std::string>& fields,
                                             const std::vector<double>& values) {
  std::map<std::string, double> by_name;
  std::size_t row = 0;
  for (const auto& [name, at] : expect.at) {
    const auto column = std::find(fields.begin(), fields.end(), at.field) - fields.begin();
    if (row + fields.size() <= values.size()) by_name[name] = values[row + static_cast<std::size_t>(column)];
    row += fields.size();
  }
  return by_name;
}

void check_wanted(const RunParams& params, const models::Model& model) {
  std::vector<std::string> mistakes;
  const std::size_t d = dimension(params);
  const auto fields = model.point_fields();
  for (const auto& [name, value] : params.expect.at) {
    const std::string path = "expect/at/" + name;
    if (value.place.size() != d)
      mistakes.push_back(fmt::format("{}/place: points have {} here; write {}.", path, d == 1 ? "one coordinate" : "two coordinates",
                                     d == 1 ? "{x}" : "{x,y}"));
    if (std::find(fields.begin(), fields.end(), value.field) == fields.end())
      mistakes.push_back(fmt::format("{}/field: the model has no field '{}'. {}", path, value.field,
                                     core::did_you_mean(value.field, fields, "Write one of")));
  }
  if (params.output.probes.size() % d != 0) mistakes.push_back("output/probes: each point has two coordinates; write {x1,y1,x2,y2,...}.");
  if (!mistakes.empty()) throw core::InputError(fmt::format("{}", fmt::join(mistakes, "\n")));
}

}  // namespace thixis::drive
