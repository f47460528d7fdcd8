#include <fmt/format.h>

#include <algorithm>

#include "thixis/core/error.hpp"
#include "thixis/drive/run.hpp"

namespace thixis::drive {
namespace {

using complementarity::StoppingRule;
using Mistakes = std::vector<std::string>;

/// What steers by the estimate needs it.
void judge_what_steers(const RunParams& params, Mistakes& mistakes) {
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
}

/// What is expected of the true error needs the exact solution.
void judge_true_error(const RunParams& params, Mistakes& mistakes) {
  const ExpectParams& expect = params.expect;
  const models::Entry& model = params.catalogue->model(params);
  if (model.lacks_exact && !model.lacks_exact(params)) return;
  for (const auto& [name, given] : {std::pair("energy error at most", expect.energy_error_at_most.has_value()),
                                    std::pair("energy error between", expect.energy_error_between.has_value())})
    if (given) mistakes.push_back(fmt::format("expect/{}: without the exact solution nobody knows the true error; leave this out.", name));
  if (params.estimated() && expect.effectivity_between)
    mistakes.push_back(
        "expect/effectivity between: without the exact solution nobody knows the true error; leave this out, or expect "
        "'bound at most'.");
}

/// What is expected of the estimate, or shown of it, needs one.
void judge_estimate(const RunParams& params, Mistakes& mistakes) {
  if (params.estimated()) return;
  const char* nobody = "nobody estimates the error; write stopping/estimate = true.";
  const auto unknown = [&](bool given, const char* name) {
    if (given) mistakes.push_back(fmt::format("expect/{}: {}", name, nobody));
  };
  unknown(params.expect.effectivity_between.has_value(), "effectivity between");
  unknown(params.expect.bound_at_most.has_value(), "bound at most");
  unknown(params.expect.promise.has_value(), "promise");
  if (params.output.fields == "all") return;
  for (const auto& name : params.output.estimate_names())
    mistakes.push_back(fmt::format("output/fields: there is no '{}', for {}", name, nobody));
}

/// Integrals that the method can not do with.
void judge_quadrature(const RunParams& params, Mistakes& mistakes) {
  const int order = params.method.quadrature_order, least = 2 * params.method.degree;
  if (order > 0 && order < least)
    mistakes.push_back(
        fmt::format("method/quadrature order: forms of degree {} are integrated with {} at least; write that or more, or leave it out.",
                    params.method.degree, least));
}

/// Solvers that want symmetric systems, in models that have them in a full and a reduced form.
void judge_symmetry(const RunParams& params, Mistakes& mistakes) {
  const method::Method& method = params.catalogue->method(params);
  const algebra::LinearParams& linear = params.linear;
  const bool cg = linear.solver == algebra::SolverKind::cg;
  const bool grids = linear.solver != algebra::SolverKind::direct && (linear.preconditioner == algebra::PreconditionerKind::muelu ||
                                                                      linear.preconditioner == algebra::PreconditionerKind::multigrid);
  const char* const name = linear.preconditioner == algebra::PreconditionerKind::muelu ? "muelu" : "multigrid";
  const bool full = linear.form == algebra::SystemForm::full && !params.condensed();
  if (cg && full)
    mistakes.push_back("linear/form: the full system is not symmetric, so cg can not solve it: write 'reduced', or the solver 'gmres'.");
  if (grids && full)
    mistakes.push_back(fmt::format("linear/form: {} fails on the full system: write 'reduced', or the preconditioner 'ilu'.", name));
  if (method.symmetric(params.method)) return;
  const auto& [holds, condition, without, remedy] = method.symmetry;
  if (cg)
    mistakes.push_back(fmt::format(
        "linear/solver: conjugate gradients need a symmetric system, and that of {} is not: write 'gmres', or {}.", without, remedy));
  if (grids)
    mistakes.push_back(fmt::format("linear/preconditioner: {} needs a symmetric system, and that of {} is not: write 'ilu', or {}.", name,
                                   without, remedy));
}

void judge_time(const RunParams& params, Mistakes& mistakes) {
  if (!params.catalogue->model(params).in_time) return;
  if (!params.time) mistakes.push_back("time: the scene is one in time; give this block with 'step' and 'end'.");
  if (params.adapt && !params.stopping.target)
    mistakes.push_back("adapt: in time the mesh is refined where the target asks for it; give stopping/target as well.");
}

}  // namespace

void check_served(const RunParams& params) {
  Mistakes mistakes;
  const models::Entry& model = params.catalogue->model(params);
  const method::Method& method = params.catalogue->method(params);
  if (const auto found = mesh::not_triangles(params.mesh); found && method.triangles)
    mistakes.push_back(fmt::format("mesh/{}: {}", found->parameter, found->sentence));
  judge_what_steers(params, mistakes);
  judge_true_error(params, mistakes);
  judge_estimate(params, mistakes);
  if (method.make_space && model.accepts(method)) {
    judge_quadrature(params, mistakes);
    judge_symmetry(params, mistakes);
  }
  if (params.linear.solver == algebra::SolverKind::direct && params.stopping.rule == StoppingRule::inexact)
    mistakes.push_back(
        "stopping/rule: a direct solver solves every system to the end; write exact or adaptive, or linear/solver = gmres or cg.");
  judge_time(params, mistakes);
  if (model.judge) model.judge(params, mistakes);
  if (!mistakes.empty()) throw core::InputError(fmt::format("{}", fmt::join(mistakes, "\n")));
}

}  // namespace thixis::drive
