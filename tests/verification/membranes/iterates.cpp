#include "iterates.hpp"

#include "thixis/membranes/membranes.hpp"

namespace thixis::verification {

using complementarity::StoppingRule;

Laid lay(const drive::RunParams& params, const core::Comm& comm) {
  Laid laid;
  laid.params = params;
  laid.hierarchy = mesh::build(params.mesh, comm, INPUTS);
  laid.model =
      membranes::membranes(membranes::membrane_scene(params.scene), method_of(params.method.name), params.method, params.linear, {});
  laid.model->check(laid.hierarchy.finest(), {});
  laid.discretization = laid.model->discretize(laid.hierarchy, static_cast<int>(laid.hierarchy.levels.size()) - 1);
  return laid;
}

const std::vector<Stop>& all_stops() {
  static const std::vector<Stop> stops = {{"exact", StoppingRule::exact, algebra::SystemForm::full},
                                          {"inexact", StoppingRule::inexact, algebra::SystemForm::full},
                                          {"adaptive", StoppingRule::adaptive, algebra::SystemForm::full},
                                          {"adaptive, reduced", StoppingRule::adaptive, algebra::SystemForm::reduced}};
  return stops;
}

std::vector<Seen> iterates(const Laid& laid, const Stop& stop, complementarity::CFunction function, int check_every, int max_steps) {
  complementarity::NewtonParams newton = laid.params.newton;
  newton.c_function = function;
  newton.max_iterations = max_steps;
  complementarity::StoppingParams stopping = laid.params.stopping;
  stopping.rule = stop.rule;
  stopping.linear_tolerance = 1e-5;
  stopping.nonlinear_tolerance = 1e-7;
  stopping.estimate = true;
  std::vector<Seen> seen;
  const auto X = laid->cold_start();
  seen.push_back(laid.look(*X));
  complementarity::newton(laid->problem(), *X, newton, stopping, check_every, {}, [&](const algebra::Vector& at) {
    seen.push_back(laid.look(at));
    return seen.back().eta;
  });
  return seen;
}

const std::vector<std::string>& known_cases() {
  static const std::vector<std::string> names = {"smooth contact", "discontinuous multiplier", "disk b", "disk", "radial obstacle"};
  return names;
}

drive::RunParams known_case(const std::string& name, int level, const method::MethodParams& method) {
  auto params = catalogued(name, level);
  params.method = method;
  if (name == "radial obstacle") {
    params.scene.model = "obstacle";
    params.mesh.generator = mesh::Generator::disk;
  }
  return params;
}

std::vector<std::pair<std::string, method::MethodParams>> all_variants(int degree) {
  std::vector<std::pair<std::string, method::MethodParams>> variants;
  const std::string p = " P" + std::to_string(degree);
  variants.emplace_back("fem" + p, by("fem", degree));
  if (degree > 1) variants.emplace_back("fem, Bernstein" + p, by("fem", degree, method::Nodes::bernstein));
  for (const char* variant : {"sipg", "nipg"})
    for (const char* boundary : {"weak", "strong"})
      if (is_built("dg"))
        variants.emplace_back(std::string(variant) + ", " + boundary + p,
                              with(by("dg", degree), {{"variant", variant}, {"boundary", boundary}}));
  for (const char* length : {"face", "cell"})
    if (is_built("hho"))
      variants.emplace_back(std::string("hho, ") + length + p, with(by("hho", degree), {{"stabilization length", length}}));
  return variants;
}

}  // namespace thixis::verification
