#include "thixis/drive/params.hpp"

namespace thixis::drive {
namespace {

using algebra::PreconditionerKind;
using algebra::SolverKind;
using complementarity::StoppingRule;
using mesh::Generator;
using method::MethodName;
using P = RunParams;
using Uses = core::Uses<P>;

bool flow(const P& p) { return p.scene.model == scene::Model::two_phase; }
bool obstacle(const P& p) { return p.scene.model == scene::Model::obstacle; }
bool parabolic(const P& p) { return p.scene.model == scene::Model::parabolic_membranes; }
bool membranes(const P& p) { return !flow(p); }
bool in_time(const P& p) { return flow(p) || parabolic(p); }
bool stationary(const P& p) { return !in_time(p); }
bool own_data(const P& p) { return membranes(p) && !p.scene.case_name; }

constexpr const char* for_flow = "scene/model = two-phase";
constexpr const char* for_membranes = "scene/model = membranes, obstacle or parabolic membranes";
constexpr const char* at_rest = "scene/model = membranes or obstacle";
constexpr const char* moving = "scene/model = parabolic membranes or two-phase";

void of_the_scene(Uses& uses) {
  const auto two = [](const P& p) { return membranes(p) && !obstacle(p); };
  for (const char* name : {"mu1", "mu2", "f1", "f2", "g1", "g2", "u1", "u2", "u1_x", "u1_y", "u2_x", "u2_y"})
    uses.when(std::string("scene/data/") + name, two, "scene/model = membranes or parabolic membranes");
  for (const char* name : {"mu", "f", "g", "psi", "u", "u_x", "u_y"})
    uses.when(std::string("scene/data/") + name, obstacle, "scene/model = obstacle");
  uses.when("scene/data/initial", parabolic, "scene/model = parabolic membranes")
      .when("scene/data", own_data, "membranes and no scene/case")
      .when("scene/boundary", own_data, "membranes and no scene/case")
      .when("scene/interface", membranes, for_membranes)
      .when("scene/flow", flow, for_flow);
}

void of_the_mesh(Uses& uses) {
  const auto lattice = [](const P& p) { return mesh::not_triangles(p.mesh).has_value(); };
  const auto squares = [](const P& p) { return p.mesh.generator == Generator::criss_cross || p.mesh.generator == Generator::rectangle; };
  const auto corners = [=](const P& p) { return squares(p) || lattice(p); };
  uses.when("mesh/cells per side", squares, "mesh/generator = criss-cross or rectangle")
      .when("mesh/lower", corners, "mesh/generator = criss-cross, rectangle, tensor or interval")
      .when("mesh/upper", corners, "mesh/generator = criss-cross, rectangle, tensor or interval")
      .when("mesh/cells", lattice, "mesh/generator = interval or tensor")
      .when(
          "mesh/rings", [](const P& p) { return p.mesh.generator == Generator::disk; }, "mesh/generator = disk")
      .when(
          "mesh/file", [](const P& p) { return p.mesh.generator == Generator::file; }, "mesh/generator = file")
      .when(
          "mesh/cells per rank", [=](const P& p) { return !lattice(p); }, "mesh/generator = criss-cross, rectangle, disk or file");
}

bool of_method(const P& p, MethodName name) { return p.method.name == name; }
/// There are unknowns that belong to one cell alone.
bool has_interior(const P& p) { return of_method(p, MethodName::hho) || (of_method(p, MethodName::fem) && p.method.degree >= 3); }
bool condensed(const P& p) { return has_interior(p) && p.method.condensed(); }

void of_the_method(Uses& uses) {
  const auto polynomials = [](const P& p) { return !of_method(p, MethodName::fv); };
  const auto dg = [](const P& p) { return of_method(p, MethodName::dg); };
  const auto hho = [](const P& p) { return of_method(p, MethodName::hho); };
  for (const char* name : {"degree", "nodes", "quadrature order"})
    uses.when(std::string("method/") + name, polynomials, "method/name = fem, dg or hho");
  for (const char* name : {"variant", "penalty", "boundary"}) uses.when(std::string("method/") + name, dg, "method/name = dg");
  for (const char* name : {"stabilization", "stabilization length"}) uses.when(std::string("method/") + name, hho, "method/name = hho");
  // false says what is done anyhow
  uses.when(
      "method/condensation", [](const P& p) { return has_interior(p) || p.method.condensation == false; },
      "method/name = hho, or fem and method/degree = 3 or 4");
}

void of_newton(Uses& uses) {
  uses.when("newton/start", stationary, at_rest, "each step of time starts from the state before; leave it out.")
      .when("newton/initial", stationary, at_rest,
            "each step of time starts from the state before; give initial data in the block 'scene'.")
      .when(
          "newton/initial/u", [](const P& p) { return p.scene.model != scene::Model::membranes; }, "scene/model = obstacle",
          "there are two membranes; write u1 and u2 in its place.");
  for (const char* name : {"newton/initial/u1", "newton/initial/u2"})
    uses.when(
        name, [](const P& p) { return !obstacle(p); }, "scene/model = membranes", "there is one membrane; write u in its place.");
  // none at all says what is done anyhow
  const auto none = [](const P& p) { return p.newton.sweeps == 0; };
  uses.when(
          "newton/sweeps", [=](const P& p) { return membranes(p) || none(p); }, for_membranes)
      .when(
          "newton/sweeps", [=](const P& p) { return p.method.symmetric() || none(p); }, "method/variant = sipg")
      .when(
          "newton/sweeps", [=](const P& p) { return p.newton.c_function == complementarity::CFunction::min || none(p); },
          "newton/c-function = min");
}

void of_the_linear_solver(Uses& uses) {
  const auto krylov = [](const P& p) { return p.linear.solver != SolverKind::direct; };
  const auto with = [](PreconditionerKind kind) { return [kind](const P& p) { return p.linear.preconditioner == kind; }; };
  constexpr const char* for_krylov = "linear/solver = gmres or cg";
  for (const char* name : {"preconditioner", "ilu level", "overlap", "ilut fill", "max iterations", "check every"})
    uses.when(std::string("linear/") + name, krylov, for_krylov);
  uses.when("linear/ilu level", with(PreconditionerKind::ilu), "linear/preconditioner = ilu")
      .when(
          "linear/overlap",
          [](const P& p) {
            return p.linear.preconditioner == PreconditionerKind::ilu || p.linear.preconditioner == PreconditionerKind::ilut;
          },
          "linear/preconditioner = ilu or ilut")
      .when("linear/ilut fill", with(PreconditionerKind::ilut), "linear/preconditioner = ilut")
      .when(
          "linear/restart", [](const P& p) { return p.linear.solver == SolverKind::gmres; }, "linear/solver = gmres")
      .when("linear/form", membranes, for_membranes)
      // reduced says what is done anyhow
      .when(
          "linear/form", [](const P& p) { return !condensed(p) || p.linear.form == algebra::SystemForm::reduced; },
          "method/condensation = false")
      .when(
          "linear/check every", [](const P& p) { return p.stopping.rule != StoppingRule::exact || p.stopping.estimate.value_or(false); },
          "stopping/rule = inexact or adaptive, or stopping/estimate = true")
      .when("stopping/inexact factor", krylov, for_krylov);
}

void of_stopping(Uses& uses) {
  const auto rule = [](StoppingRule wanted) { return [wanted](const P& p) { return p.stopping.rule == wanted; }; };
  for (const char* name : {"gamma algebraic", "gamma linearization", "local"})
    uses.when(std::string("stopping/") + name, rule(StoppingRule::adaptive), "stopping/rule = adaptive");
  uses.when("stopping/inexact factor", rule(StoppingRule::inexact), "stopping/rule = inexact")
      .when(
          "stopping/kkt tolerance", [](const P& p) { return p.stopping.rule != StoppingRule::adaptive; },
          "stopping/rule = exact or inexact")
      .when("stopping/target", membranes, for_membranes)
      .when("stopping/measure", flow, for_flow)
      .when(
          "stopping/measure", [](const P& p) { return p.estimated(); }, "stopping/rule = adaptive or stopping/estimate = true")
      .when("stopping/time scale", flow, for_flow)
      .when(
          "stopping/time scale", [](const P& p) { return p.estimated(); }, "stopping/rule = adaptive or stopping/estimate = true")
      .when("stopping/friedrichs constant", membranes, for_membranes)
      // at rest by the bound of the literature, in time by the bound itself
      .when(
          "stopping/friedrichs constant", [](const P& p) { return p.stopping.estimate.value_or(false) || (parabolic(p) && p.estimated()); },
          "stopping/estimate = true")
      .when(
          "stopping/friedrichs constant", [](const P& p) { return parabolic(p) || of_method(p, MethodName::fem); }, "method/name = fem")
      .when("adapt", membranes, for_membranes)
      .when(
          "adapt/theta", [](const P& p) { return !p.adapt || p.adapt->marking == Marking::dorfler || p.adapt->theta == 1; },
          "adapt/marking = dorfler");
}

void of_time(Uses& uses) {
  uses.when("time", in_time, moving, "the scene is stationary; drop this block, or write scene/model = parabolic membranes or two-phase.")
      .when(
          "time/unit", [](const P& p) { return !parabolic(p); }, for_flow)
      .when(
          "time/largest", [](const P& p) { return !p.time || p.time->adaptive; }, "time/adaptive = true");
}

void of_the_results(Uses& uses) {
  uses.when("output/fields every", in_time, moving)
      .when(
          "output/fields every", [](const P& p) { return !p.output.no_fields(); }, "output/fields = all or a list");
  for (const char* name : {"steps at most", "retries at most"}) uses.when(std::string("expect/") + name, in_time, moving);
  for (const char* name : {"water balance at most", "hydrogen balance at most", "front between"})
    uses.when(std::string("expect/") + name, flow, for_flow);
  for (const char* name : {"contact area between", "force between"}) uses.when(std::string("expect/") + name, membranes, for_membranes);
  uses.when("expect/energy norm between", stationary, at_rest);
}

}  // namespace

const core::Uses<RunParams>& RunParams::uses() {
  static const Uses all = [] {
    Uses uses;
    of_the_scene(uses);
    of_the_mesh(uses);
    of_the_method(uses);
    of_newton(uses);
    of_the_linear_solver(uses);
    of_stopping(uses);
    of_time(uses);
    of_the_results(uses);
    return uses;
  }();
  return all;
}

std::string RunParams::as_deck() const { return core::to_xml(schema(), *this, uses()); }

}  // namespace thixis::drive
