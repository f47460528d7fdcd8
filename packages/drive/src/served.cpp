#include <fmt/format.h>

#include "thixis/core/error.hpp"
#include "thixis/drive/run.hpp"

namespace thixis::drive {
namespace {

using Mistakes = std::vector<std::string>;

/// What is not known stays unjudged: other mistakes of the scene are told by the model.
bool exact_solution_missing(const RunParams& params) {
  if (params.scene.model == scene::Model::two_phase) return true;
  try {
    return !scene::membrane_scene(params.scene).exact;
  } catch (const core::InputError&) {
    return false;
  }
}

void judge_estimate(const RunParams& params, Mistakes& mistakes) {
  using complementarity::StoppingRule;
  const auto& stopping = params.stopping;
  const auto steered = [&](bool given, const char* path, const char* what) {
    if (given && stopping.estimate == false)
      mistakes.push_back(
          fmt::format("{}: {} needs the error estimate, which stopping/estimate = false forbids; write true there, or leave "
                      "it out.",
                      path, what));
  };
  steered(stopping.rule == StoppingRule::adaptive, "stopping/rule", "the rule adaptive");
  steered(stopping.target.has_value(), "stopping/target", "a target");
  steered(params.adapt.has_value(), "adapt", "adaptive refinement");
  steered(params.time && params.time->adaptive, "time/adaptive", "step control");

  const auto& expect = params.expect;
  for (const auto& [name, given] : {std::pair("energy error at most", expect.energy_error_at_most.has_value()),
                                    std::pair("energy error between", expect.energy_error_between.has_value())})
    if (given && exact_solution_missing(params))
      mistakes.push_back(fmt::format("expect/{}: without the exact solution nobody knows the true error; leave this out.", name));
  if (params.estimated()) {
    if (params.expect.effectivity_between && exact_solution_missing(params))
      mistakes.push_back(
          "expect/effectivity between: without the exact solution nobody knows the true error; leave this out, or expect "
          "'bound at most'.");
    return;
  }
  const char* nobody = "nobody estimates the error; write stopping/estimate = true.";
  if (params.expect.effectivity_between) mistakes.push_back(fmt::format("expect/effectivity between: {}", nobody));
  if (params.expect.bound_at_most) mistakes.push_back(fmt::format("expect/bound at most: {}", nobody));
  if (params.expect.promise) mistakes.push_back(fmt::format("expect/promise: {}", nobody));
  if (params.output.fields == "all") return;
  for (const auto& name : params.output.estimate_names())
    mistakes.push_back(fmt::format("output/fields: there is no '{}', for {}", name, nobody));
}

/// The systems of two-phase flow are not symmetric, and have one form.
void judge_flow(const RunParams& params, Mistakes& mistakes) {
  const algebra::LinearParams& linear = params.linear;
  if (linear.solver == algebra::SolverKind::cg)
    mistakes.push_back("linear/solver: the systems of two-phase flow are not symmetric, so cg can not solve them; write gmres or direct.");
  if (linear.solver != algebra::SolverKind::direct && linear.preconditioner == algebra::PreconditionerKind::muelu)
    mistakes.push_back("linear/preconditioner: muelu fails on the systems of two-phase flow; write ilu.");
}

void judge_method(const RunParams& params, Mistakes& mistakes) {
  if (params.scene.model == scene::Model::two_phase) return judge_flow(params, mistakes);
  const method::MethodParams& method = params.method;
  const int order = method.quadrature_order, least = 2 * method.degree;
  if (order > 0 && order < least)
    mistakes.push_back(
        fmt::format("method/quadrature order: forms of degree {} are integrated with {} at least; write that or more, or leave it out.",
                    method.degree, least));

  const bool interior = method.name == method::MethodName::hho || (method.name == method::MethodName::fem && method.degree >= 3);
  const algebra::LinearParams& linear = params.linear;
  const bool cg = linear.solver == algebra::SolverKind::cg;
  const bool muelu = linear.solver != algebra::SolverKind::direct && linear.preconditioner == algebra::PreconditionerKind::muelu;
  const bool full = linear.form == algebra::SystemForm::full && !(method.condensed() && interior);
  const bool nipg = method.name == method::MethodName::dg && method.variant == method::Variant::nipg;
  if (cg && full)
    mistakes.push_back("linear/form: the full system is not symmetric, so cg can not solve it: write 'reduced', or the solver 'gmres'.");
  if (muelu && full) mistakes.push_back("linear/form: muelu fails on the full system: write 'reduced', or the preconditioner 'ilu'.");
  if (cg && nipg)
    mistakes.push_back(
        "linear/solver: conjugate gradients need a symmetric system, and that of nipg is not: write 'gmres', or the variant 'sipg'.");
  if (muelu && nipg)
    mistakes.push_back(
        "linear/preconditioner: muelu needs a symmetric system, and that of nipg is not: write 'ilu', or the variant 'sipg'.");
}

bool in_time(scene::Model model) { return model == scene::Model::parabolic_membranes || model == scene::Model::two_phase; }

void judge_time(const RunParams& params, Mistakes& mistakes) {
  if (!in_time(params.scene.model)) {
    return;
  }
  if (!params.time) mistakes.push_back("time: the scene is one in time; give this block with 'step' and 'end'.");
  if (params.adapt && !params.stopping.target)
    mistakes.push_back("adapt: in time the mesh is refined where the target asks for it; give stopping/target as well.");
  if (params.scene.model == scene::Model::parabolic_membranes && params.method.name == method::MethodName::dg && params.estimated())
    mistakes.push_back(
        "method/name: in time the error of dg is not bounded; write fem or hho, or leave out what needs an estimate (stopping/rule, "
        "estimate, target, time/adaptive).");
}

}  // namespace

void check_served(const RunParams& params) {
  Mistakes mistakes;
  if (const auto found = mesh::not_triangles(params.mesh); found && params.method.name != method::MethodName::fv)
    mistakes.push_back(fmt::format("mesh/{}: {}", found->parameter, found->sentence));
  judge_estimate(params, mistakes);
  judge_method(params, mistakes);
  if (params.linear.solver == algebra::SolverKind::direct && params.stopping.rule == complementarity::StoppingRule::inexact)
    mistakes.push_back(
        "stopping/rule: a direct solver solves every system to the end; write exact or adaptive, or linear/solver = gmres or cg.");
  judge_time(params, mistakes);
  if (!mistakes.empty()) throw core::InputError(fmt::format("{}", fmt::join(mistakes, "\n")));
}

}  // namespace thixis::drive
