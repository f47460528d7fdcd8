#include "thixis/flow/family.hpp"

#include "data/cases.hpp"
#include "data/examine.hpp"
#include "thixis/core/error.hpp"
#include "thixis/flow/two_phase.hpp"
#include "thixis/models/catalogue.hpp"

namespace thixis::flow {
namespace {

using models::RunParams;

std::unique_ptr<models::Model> make(const RunParams& params, const method::Method&) {
  const models::TimeParams time = params.time.value_or(models::TimeParams{});
  auto scene = two_phase_scene(params.scene);
  if (scene.time_unit == "year" && time.unit != models::TimeUnit::year)
    throw core::InputError("time/unit: the rates of the case '" + scene.name + "' are per year; write year.");
  if (time.unit == models::TimeUnit::none)
    throw core::InputError("time/unit: viscosities and permeabilities have units, and so has time; write second or year.");
  const double seconds = models::seconds_in(time.unit);
  TwoPhaseBoundParams bound;
  bound.measure = params.stopping.measure;
  bound.adaptive = params.stopping.rule == complementarity::StoppingRule::adaptive;
  if (params.stopping.time_scale) bound.time_scale = *params.stopping.time_scale * seconds;
  return two_phase(std::move(scene), params.linear, seconds, bound);
}

/// The systems are not symmetric, and have one form.
void judge(const RunParams& params, std::vector<std::string>& mistakes) {
  const algebra::LinearParams& linear = params.linear;
  if (linear.solver == algebra::SolverKind::cg)
    mistakes.emplace_back(
        "linear/solver: the systems of two-phase flow are not symmetric, so cg can not solve them; write gmres or direct.");
  if (linear.solver == algebra::SolverKind::direct) return;
  if (linear.preconditioner == algebra::PreconditionerKind::muelu)
    mistakes.emplace_back("linear/preconditioner: muelu fails on the systems of two-phase flow; write ilu.");
  if (linear.preconditioner == algebra::PreconditionerKind::multigrid)
    mistakes.emplace_back("linear/preconditioner: multigrid fails on the systems of two-phase flow; write ilu.");
}

/// Rock of 200 m for the injection of gas, a column of 20 m, or a slab of 200 m x 20 m.
mesh::MeshParams rock(const std::string& case_name) {
  mesh::MeshParams mesh;
  const bool slab = case_name == "gas injection 2d", column = case_name == "closed column";
  mesh.generator = slab ? mesh::Generator::tensor : mesh::Generator::interval;
  mesh.lower = slab ? std::vector<double>{0, 0} : std::vector<double>{0};
  mesh.upper = slab ? std::vector<double>{200, 20} : std::vector<double>{column ? 20. : 200.};
  mesh.cells = slab ? std::vector<int>{50, 8} : std::vector<int>{100};
  return mesh;
}

void begin(RunParams& params) {
  if (!params.scene.case_name) params.scene.case_name = cases().front().name;
  params.mesh = rock(*params.scene.case_name);
  params.time->unit = models::TimeUnit::year;
  params.time->step = 1e4;
  params.time->end = 1e5;
}

models::Entry entry() {
  models::Entry entry;
  entry.name = model_name;
  entry.title = "two-phase flow";
  entry.in_time = true;
  entry.point_fields = {"s_g", "p_l", "p_g", "chi"};
  entry.without_probes = "the cell at the left end";
  entry.cases = cases();
  entry.uses = {"scene/flow",
                "stopping/measure",
                "stopping/time scale",
                "time/unit",
                "expect/water balance at most",
                "expect/hydrogen balance at most",
                "expect/front between"};
  entry.accepts = [](const method::Method& method) { return method.name == "fv"; };
  entry.examine = examine;
  entry.judge = judge;
  entry.make = make;
  entry.begin = begin;
  return entry;
}

}  // namespace

models::Family family() {
  models::Family family;
  family.models = {entry()};
  family.scene = [](core::Schema<models::SceneParams>& block) { block.with(&models::SceneParams::own, SceneParams::schema()); };
  family.expect = [](core::Schema<models::ExpectParams>& block) { block.with(&models::ExpectParams::own, ExpectParams::schema()); };
  family.beginning = {"scene/flow/initial"};
  return family;
}

}  // namespace thixis::flow
