#include "deck/cases.hpp"

#include <algorithm>

namespace thixis::membranes {
namespace {

using Cases = std::vector<models::Case>;

/// By model.
const std::map<std::string, Cases>& all() {
  static const std::map<std::string, Cases> cases = {
      {model::two,
       {{"smooth contact",
         "Unit square: the membranes touch in a circle of radius 1/3, gap and multiplier are smooth; exact solution known."},
        {"discontinuous multiplier",
         "Unit square: the upper membrane is pressed on a flat lower one, the multiplier jumps at r = 1/3; exact solution known."},
        {"disk",
         "Unit disk: contact for r < 1/sqrt 2, the lower membrane a cubic of r outside, the multiplier jumps; exact solution known."},
        {"disk b", "Unit disk: as 'disk' with a lower membrane that is quadratic in r outside of the contact; exact solution known."}}},
      {model::obstacle,
       {{"radial obstacle",
         "Unit disk: a membrane over a paraboloid that it leaves at r = 0.6, where the multiplier jumps; exact solution known."},
        {"torsion",
         "Any domain, e.g. the unit square: a membrane held at height 0 and pressed by a constant force on a flat obstacle below."}}},
      {model::in_time,
       {{"rings", "Unit disk, in time: forces that change sign from ring to ring press flat membranes together at several places."},
        {"moving contact",
         "Unit square, in time: the edge of a contact disk moves to and fro, the multiplier jumps there; exact solution known."},
        {"smooth moving contact",
         "Unit square, in time: as 'moving contact' with a gap and a multiplier that are smooth; exact solution known."},
        {"resting contact",
         "Unit square, in time: the contact disk rests, gap and multiplier are smooth and affine in time; exact solution known."},
        {"relaxation",
         "Any domain, e.g. the unit square, in time: flat membranes pressed together by constant forces come to rest in contact."}}},
  };
  return cases;
}

bool among(const Cases& cases, const std::string& name) {
  return std::any_of(cases.begin(), cases.end(), [&](const models::Case& known) { return known.name == name; });
}

}  // namespace

const Cases& cases_of(const std::string& model) { return all().at(model); }

bool on_the_disk(const std::string& name) { return name == "disk" || name == "disk b" || name == "radial obstacle" || name == "rings"; }

CatalogueEntry entry(const std::string& name, const std::vector<double>& centre) {
  CatalogueEntry c;
  c.centre = centre;
  c.scene.name = name;
  for (const auto& [model, cases] : all())
    for (const models::Case& known : cases)
      if (known.name == name) {
        c.scene.sentence = known.sentence;
        c.scene.count = model == model::obstacle ? 1 : 2;
      }
  for (int alpha = 0; alpha < c.scene.count; ++alpha) c.scene.tension[alpha] = scene::constant(1);
  return c;
}

CatalogueEntry catalogue(const std::string& name) {
  return among(cases_of(model::in_time), name) ? case_in_time(name) : case_at_rest(name);
}

}  // namespace thixis::membranes
