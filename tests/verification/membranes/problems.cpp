#include "problems.hpp"

#include <cmath>

#include "thixis/core/deck.hpp"
#include "thixis/membranes/membranes.hpp"

namespace thixis::verification {
namespace {

void solve_directly(drive::RunParams& params) {
  params.newton.start = complementarity::Start::nested;
  params.linear.form = algebra::SystemForm::reduced;
  params.linear.solver = algebra::SolverKind::direct;
}

}  // namespace

Solved solve(const drive::RunParams& params, const core::Comm& comm, const drive::Observer& observer) {
  Solved run;
  run.hierarchy = mesh::build(params.mesh, comm, INPUTS);
  run.model =
      membranes::membranes(membranes::membrane_scene(params.scene), method_of(params.method.name), params.method, params.linear, {});
  run.model->check(run.hierarchy.finest(), {});
  run.outcome = drive::solve_stationary(*run.model, run.hierarchy, params, observer);
  return run;
}

drive::RunParams catalogued(const std::string& name, int level) {
  auto params = catalogue().defaults();
  params.scene.case_name = name;
  params.mesh.generator = name.substr(0, 4) == "disk" ? mesh::Generator::disk : mesh::Generator::criss_cross;
  params.mesh.refinements = level;
  solve_directly(params);
  return params;
}

drive::RunParams from_deck(const std::string& deck, int refinements) {
  auto params = core::Deck::read(std::string(INPUTS) + "/" + deck).parse(catalogue().schema());
  params.mesh.refinements = refinements;
  solve_directly(params);
  return params;
}

drive::RunParams data(const std::map<std::string, std::string>& functions, int level, const std::string& model) {
  auto deck = core::Deck::from_text("<ParameterList name=\"thixis\"/>", "data");
  deck.set("scene/model=" + model);
  for (const auto& [name, expression] : functions) deck.set("scene/data/" + name + "=" + expression);
  auto params = deck.parse(catalogue().schema());
  params.mesh.refinements = level;
  solve_directly(params);
  return params;
}

drive::RunParams pressed(const std::string& mu1, const std::string& mu2, int level) {
  return data({{"mu1", mu1}, {"mu2", mu2}, {"g1", "0.1"}, {"g2", "-0.1"}, {"f1", "-6 + 2*x"}, {"f2", "4 + y"}}, level);
}

method::MethodParams by(const std::string& name, int degree, method::Nodes nodes) {
  method::MethodParams method;
  method.name = name;
  method.degree = degree;
  method.nodes = nodes;
  return method;
}

std::vector<std::pair<std::string, method::MethodParams>> all_methods(int degree) {
  const std::string p = " of degree " + std::to_string(degree);
  std::vector<std::pair<std::string, method::MethodParams>> all;
  for (const auto& [name, method] : {std::pair("fem", by("fem", degree)), std::pair("sipg", by("dg", degree)),
                                     std::pair("nipg", with(by("dg", degree), {{"variant", "nipg"}})), std::pair("hho", by("hho", degree))})
    if (is_built(method.name)) all.emplace_back(name + p, method);
  return all;
}

double order(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace thixis::verification
