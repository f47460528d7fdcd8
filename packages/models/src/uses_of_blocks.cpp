#include "uses_of_blocks.hpp"

namespace thixis::models {
namespace {

using algebra::PreconditionerKind;
using algebra::SolverKind;
using complementarity::StoppingRule;
using mesh::Generator;
using P = RunParams;
using Uses = core::Uses<P>;

bool in_time(const P& p) { return p.catalogue->model(p).in_time; }
bool at_rest(const P& p) { return !in_time(p); }

/// "scene/model = a, b or c" of those at rest, or in time; empty: there are none.
std::string condition(const Catalogue& catalogue, bool in_time) {
  const auto names = names_of(catalogue.models(), [&](const Entry& model) { return model.in_time == in_time; });
  return names.empty() ? "" : "scene/model = " + either(names);
}

/// "method/name = hho, or fem and method/degree = 3 or 4"
std::string where_condensed(const Catalogue& catalogue) {
  std::string always, sometimes;
  for (const method::Method& method : catalogue.methods()) {
    if (!method.interior.exists) continue;
    if (method.interior.condition.empty()) always += (always.empty() ? "" : " or ") + method.name;
    else sometimes += (sometimes.empty() ? "" : ", or ") + method.name + " and " + method.interior.condition;
  }
  return "method/name = " + always + (always.empty() || sometimes.empty() ? "" : ", or ") + sometimes;
}

}  // namespace

bool says_nothing(const RunParams& p, const std::string& path) {
  if (path == "newton/sweeps") return p.newton.sweeps == 0;
  return path.rfind("time/", 0) == 0 && at_rest(p);
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

void of_the_method(Uses& uses, const Catalogue& catalogue) {
  // false says what is done anyhow
  const auto used = [](const P& p) { return p.catalogue->method(p).has_interior(p.method) || p.method.condensation == false; };
  uses.when("method/condensation", used, where_condensed(catalogue));
}

void of_newton(Uses& uses, const Catalogue& catalogue) {
  uses.when("newton/start", at_rest, condition(catalogue, false), "each step of time starts from the state before; leave it out.");
  // none at all says what is done anyhow
  const auto none = [](const P& p) { return p.newton.sweeps == 0; };
  std::string symmetric;
  for (const method::Method& method : catalogue.methods())
    if (method.symmetry.holds) symmetric += (symmetric.empty() ? "" : " or ") + method.symmetry.condition;
  uses.when(
          "newton/sweeps", [=](const P& p) { return p.catalogue->method(p).symmetric(p.method) || none(p); }, symmetric)
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
          "linear/overlap", [=](const P& p) { return with(PreconditionerKind::ilu)(p) || with(PreconditionerKind::ilut)(p); },
          "linear/preconditioner = ilu or ilut")
      .when("linear/ilut fill", with(PreconditionerKind::ilut), "linear/preconditioner = ilut")
      .when(
          "linear/restart", [](const P& p) { return p.linear.solver == SolverKind::gmres; }, "linear/solver = gmres")
      // reduced says what is done anyhow
      .when(
          "linear/form", [](const P& p) { return !p.condensed() || p.linear.form == algebra::SystemForm::reduced; },
          "method/condensation = false")
      .when(
          "linear/check every", [](const P& p) { return p.stopping.rule != StoppingRule::exact || p.stopping.estimate.value_or(false); },
          "stopping/rule = inexact or adaptive, or stopping/estimate = true")
      .when("stopping/inexact factor", krylov, for_krylov);
}

void of_stopping(Uses& uses, const Catalogue& catalogue) {
  const auto rule = [](StoppingRule wanted) { return [wanted](const P& p) { return p.stopping.rule == wanted; }; };
  const auto estimated = [](const P& p) { return p.estimated(); };
  constexpr const char* for_estimate = "stopping/rule = adaptive or stopping/estimate = true";
  for (const char* name : {"gamma algebraic", "gamma linearization", "local"})
    uses.when(std::string("stopping/") + name, rule(StoppingRule::adaptive), "stopping/rule = adaptive");
  uses.when("stopping/inexact factor", rule(StoppingRule::inexact), "stopping/rule = inexact")
      .when(
          "stopping/kkt tolerance", [](const P& p) { return p.stopping.rule != StoppingRule::adaptive; },
          "stopping/rule = exact or inexact")
      .when("stopping/measure", estimated, for_estimate)
      .when("stopping/time scale", estimated, for_estimate);
  // at rest by the bound of the literature, in time by the bound itself
  const auto published = names_of(catalogue.methods(), [](const method::Method& method) { return method.published_bound; });
  uses.when(
          "stopping/friedrichs constant", [](const P& p) { return p.stopping.estimate.value_or(false) || (in_time(p) && p.estimated()); },
          "stopping/estimate = true")
      .when(
          "stopping/friedrichs constant", [](const P& p) { return in_time(p) || p.catalogue->method(p).published_bound; },
          "method/name = " + either(published))
      .when(
          "adapt/theta", [](const P& p) { return !p.adapt || p.adapt->marking == Marking::dorfler || p.adapt->theta == 1; },
          "adapt/marking = dorfler");
}

void of_time(Uses& uses, const Catalogue& catalogue) {
  const std::string moving = condition(catalogue, true), resting = condition(catalogue, false);
  uses.when("time", in_time, moving, "the scene is stationary; drop this block, or write " + moving + ".")
      .when(
          "time/largest", [](const P& p) { return !p.time || p.time->adaptive; }, "time/adaptive = true")
      .when("output/fields every", in_time, moving)
      .when(
          "output/fields every", [](const P& p) { return !p.output.no_fields(); }, "output/fields = all or a list");
  for (const char* name : {"steps at most", "retries at most"}) uses.when(std::string("expect/") + name, in_time, moving);
  uses.when("expect/energy norm between", at_rest, resting);
}

}  // namespace thixis::models
