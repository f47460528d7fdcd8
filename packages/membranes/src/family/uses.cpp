#include "family/uses.hpp"

#include "thixis/membranes/params.hpp"

namespace thixis::membranes {
namespace {

using P = models::RunParams;
using Uses = core::Uses<P>;

bool is(const P& p, const char* name) { return p.scene.model == name; }
bool membranes(const P& p) { return is(p, model::two) || is(p, model::obstacle) || is(p, model::in_time); }
bool two(const P& p) { return is(p, model::two) || is(p, model::in_time); }
bool obstacle(const P& p) { return is(p, model::obstacle); }
bool at_rest(const P& p) { return is(p, model::two) || is(p, model::obstacle); }
bool own_data(const P& p) { return membranes(p) && !p.scene.case_name; }

void of_the_data(Uses& uses) {
  for (const char* name : {"mu1", "mu2", "f1", "f2", "g1", "g2", "u1", "u2", "u1_x", "u1_y", "u2_x", "u2_y"})
    uses.when(std::string("scene/data/") + name, two, "scene/model = membranes or parabolic membranes");
  for (const char* name : {"mu", "f", "g", "psi", "u", "u_x", "u_y"})
    uses.when(std::string("scene/data/") + name, obstacle, "scene/model = obstacle");
  uses.when(
          "scene/data/initial", [](const P& p) { return is(p, model::in_time); }, "scene/model = parabolic membranes")
      .when("scene/data", own_data, "membranes and no scene/case")
      .when("scene/boundary", own_data, "membranes and no scene/case");
}

void of_the_start(Uses& uses) {
  uses.when("newton/initial", at_rest, "scene/model = membranes or obstacle",
            "each step of time starts from the state before; give initial data in the block 'scene'.")
      .when(
          "newton/initial/u", [](const P& p) { return !is(p, model::two); }, "scene/model = obstacle",
          "there are two membranes; write u1 and u2 in its place.");
  for (const char* name : {"newton/initial/u1", "newton/initial/u2"})
    uses.when(
        name, [](const P& p) { return !obstacle(p); }, "scene/model = membranes", "there is one membrane; write u in its place.");
}

}  // namespace

void add_uses(Uses& uses) {
  of_the_data(uses);
  of_the_start(uses);
}

}  // namespace thixis::membranes
