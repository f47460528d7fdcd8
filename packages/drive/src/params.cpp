#include "thixis/drive/params.hpp"

#include <sstream>

namespace thixis::drive {
namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// A pair of bounds is two numbers in order.
void check_pair(const std::optional<std::vector<double>>& pair, const std::string& name, core::Problems& problems) {
  if (pair && (pair->size() != 2 || (*pair)[0] > (*pair)[1]))
    problems.add(name, "must hold the smallest and the largest value allowed, e.g. {1.0, 1.2}.");
}

}  // namespace

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
                     "checkpoint.h5 is written after so many Newton steps, again and again, and at the end; 0: only where a run ends "
                     "without convergence.");
  return schema;
}

const core::Schema<ExpectParams>& ExpectParams::schema() {
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
          .parameter("unknowns", &ExpectParams::unknowns, core::at_least(0), "Number of unknowns, the multiplier included.")
          .parameter("cells", &ExpectParams::cells, core::at_least(0), "Number of cells.")
          .check([](const ExpectParams& params, core::Problems& problems) {
            check_pair(params.energy_error_between, "energy error between", problems);
            check_pair(params.effectivity_between, "effectivity between", problems);
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
                                 .block("output", &RunParams::output, OutputParams::schema())
                                 .block("expect", &RunParams::expect, ExpectParams::schema());
  return schema;
}

}  // namespace thixis::drive
