#include "problems.hpp"

#include <cmath>

#include "thixis/core/deck.hpp"
#include "thixis/dg/space.hpp"
#include "thixis/fem/lagrange_space.hpp"
#include "thixis/hho/space.hpp"
#include "thixis/membranes/membranes.hpp"

namespace thixis::verification {
namespace {

void solve_directly(drive::RunParams& params) {
  params.newton.start = complementarity::Start::nested;
  params.linear.form = algebra::SystemForm::reduced;
  params.linear.solver = algebra::SolverKind::direct;
}

}  // namespace

method::SpaceFactory factory(method::MethodName name) {
  switch (name) {
    case method::MethodName::dg:
      return dg::make_space;
    case method::MethodName::hho:
      return hho::make_space;
    default:
      return fem::make_lagrange_space;
  }
}

Solved solve(const drive::RunParams& params, const core::Comm& comm, const drive::Observer& observer) {
  Solved run;
  run.hierarchy = mesh::build(params.mesh, comm, INPUTS);
  run.model = membranes::membranes(scene::membrane_scene(params.scene), factory(params.method.name), params.method, params.linear, {});
  run.model->check(run.hierarchy.finest(), {});
  run.outcome = drive::solve_stationary(*run.model, run.hierarchy, params, observer);
  return run;
}

drive::RunParams catalogued(const std::string& name, int level) {
  drive::RunParams params;
  params.scene.case_name = name;
  params.mesh.generator = name.substr(0, 4) == "disk" ? mesh::Generator::disk : mesh::Generator::criss_cross;
  params.mesh.refinements = level;
  solve_directly(params);
  return params;
}

drive::RunParams from_deck(const std::string& deck, int refinements) {
  auto params = core::Deck::read(std::string(INPUTS) + "/" + deck).parse(drive::RunParams::schema());
  params.mesh.refinements = refinements;
  solve_directly(params);
  return params;
}

drive::RunParams data(const std::map<std::string, std::string>& functions, int level, const std::string& model) {
  auto deck = core::Deck::from_text("<ParameterList name=\"thixis\"/>", "data");
  deck.set("scene/model=" + model);
  for (const auto& [name, expression] : functions) deck.set("scene/data/" + name + "=" + expression);
  auto params = deck.parse(drive::RunParams::schema());
  params.mesh.refinements = level;
  solve_directly(params);
  return params;
}

drive::RunParams pressed(const std::string& mu1, const std::string& mu2, int level) {
  return data({{"mu1", mu1}, {"mu2", mu2}, {"g1", "0.1"}, {"g2", "-0.1"}, {"f1", "-6 + 2*x"}, {"f2", "4 + y"}}, level);
}

method::MethodParams by(method::MethodName name, int degree, method::Nodes nodes) {
  method::MethodParams method;
  method.name = name;
  method.degree = degree;
  method.nodes = nodes;
  return method;
}

std::vector<std::pair<std::string, method::MethodParams>> all_methods(int degree) {
  const std::string p = " of degree " + std::to_string(degree);
  auto nipg = by(method::MethodName::dg, degree);
  nipg.variant = method::Variant::nipg;
  return {{"fem" + p, by(method::MethodName::fem, degree)},
          {"sipg" + p, by(method::MethodName::dg, degree)},
          {"nipg" + p, nipg},
          {"hho" + p, by(method::MethodName::hho, degree)}};
}

double order(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace thixis::verification
