#include <algorithm>
#include <sstream>

#include "schemas.hpp"

namespace thixis::models {
namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

bool of_estimate(const std::string& name) { return std::count(names_of_estimate().begin(), names_of_estimate().end(), name) > 0; }

std::string without_probes(const Catalogue& catalogue) {
  std::string text;
  for (const Entry& model : catalogue.models())
    if (!model.without_probes.empty()) text += "; " + model.title + ": " + model.without_probes;
  return text;
}

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

core::Schema<OutputParams> output_schema(const Catalogue& catalogue) {
  return core::Schema<OutputParams>("output", "What is written, and where.")
      .parameter("directory", &OutputParams::directory, "Folder of the results; if empty, results/<name of the deck>.")
      .parameter("fields", &OutputParams::fields, "Fields for fields.h5: all, none, or names separated by commas.")
      .parameter("history", &OutputParams::history, "Whether history.csv is written.")
      .parameter("checkpoint every", &OutputParams::checkpoint_every, core::at_least(0),
                 "checkpoint.h5 is written after so many Newton steps (scenes in time: time steps), again and again, and at the end; "
                 "0: only where a run ends without convergence or is told to end.")
      .parameter("fields every", &OutputParams::fields_every, core::at_least(1),
                 "Scenes in time: fields are written after so many steps, and at the beginning and the end.")
      .parameter("probes", &OutputParams::probes,
                 "Points, x and y of each one (intervals: x alone), whose values are written: in time to series.csv after every step, the "
                 "fields of the second point with _2 behind their names; of stationary scenes to probes.csv at the end. Not given: none" +
                     without_probes(catalogue) + ".")
      .check([](const OutputParams& params, core::Problems& problems) {
        if (trimmed(params.fields).empty()) problems.add("fields", "must be all, none, or names separated by commas.");
      });
}

}  // namespace thixis::models
