#include "schemas.hpp"

namespace thixis::models {
namespace {

/// The case must be one of the model; which of another one is said here, and all else by the model.
void examine(const Catalogue& catalogue, const SceneParams& params, core::Problems& problems) {
  if (!params.case_name && problems.given("case")) return;  // a case that does not exist is reported already
  for (const Entry& entry : catalogue.models())
    for (const Case& known : entry.cases)
      if (known.name == params.case_name && entry.name != params.model)
        return problems.add("case",
                            "'" + known.name + "' is a case of another model; write model = '" + entry.name + "' or take one of its own.");
  for (const Entry& entry : catalogue.models())
    if (entry.name == params.model)
      entry.examine(params, [&](const std::string& path, const std::string& sentence) { problems.add(path, sentence); });
}

}  // namespace

core::Schema<SceneParams> scene_schema(const Catalogue& catalogue) {
  std::vector<std::pair<std::string, std::string>> names;
  core::Range cases;
  for (const Entry& entry : catalogue.models()) {
    names.emplace_back(entry.name, entry.name);
    for (const Case& known : entry.cases) cases.names.push_back(known.name);
  }
  auto schema =
      core::Schema<SceneParams>("scene", "Which problem is solved: a catalogued case, or data of your own.", catalogue.defaults().scene)
          .choice("model", &SceneParams::model, names, "The equations and what is constrained.")
          .required()
          .parameter("case", &SceneParams::case_name, cases, "A catalogued case (`thixis cases`); without it give your own data.")
          .exemplary();
  for (const Family& family : catalogue.families())
    if (family.scene) family.scene(schema);
  schema.check([&catalogue](const SceneParams& params, core::Problems& problems) { examine(catalogue, params, problems); });
  return schema;
}

core::Schema<complementarity::NewtonParams> newton_schema(const Catalogue& catalogue) {
  auto schema = complementarity::NewtonParams::schema();
  for (const Family& family : catalogue.families())
    if (family.newton) family.newton(schema);
  return schema;
}

core::Schema<RunParams> deck_schema(const Catalogue& catalogue) {
  return core::Schema<RunParams>("thixis", "A deck: one question per block.", catalogue.defaults())
      .block("scene", &RunParams::scene, scene_schema(catalogue))
      .required()
      .block("mesh", &RunParams::mesh, mesh::MeshParams::schema())
      .block("method", &RunParams::method, method::schema_of(catalogue.methods()))
      .block("newton", &RunParams::newton, newton_schema(catalogue))
      .block("linear", &RunParams::linear, algebra::LinearParams::schema())
      .block("stopping", &RunParams::stopping, complementarity::StoppingParams::schema())
      .block("adapt", &RunParams::adapt, AdaptParams::schema())
      .block("time", &RunParams::time, TimeParams::schema())
      .block("output", &RunParams::output, output_schema(catalogue))
      .block("expect", &RunParams::expect, expect_schema(catalogue));
}

bool RunParams::estimated() const {
  return stopping.estimate.value_or(false) || stopping.rule == complementarity::StoppingRule::adaptive || adaptive() ||
         (time && time->adaptive);
}

bool RunParams::condensed() const { return catalogue->method(*this).condensed(method); }

std::string RunParams::as_deck() const { return core::to_xml(catalogue->schema(), *this, catalogue->uses()); }

}  // namespace thixis::models
