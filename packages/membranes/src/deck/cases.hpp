#pragma once
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "thixis/membranes/scene.hpp"
#include "thixis/models/entry.hpp"

namespace thixis::membranes {

/// A case with what its `interface` may be written in.
struct CatalogueEntry {
  MembraneScene scene;
  std::vector<double> centre;
  std::map<std::string, double> constants;
};

/// The cases of a model, by its name in the deck.
const std::vector<models::Case>& cases_of(const std::string& model);
/// Whether a case lives on the unit disk.
bool on_the_disk(const std::string& name);

/// The case of this name, which is one of a model of membranes.
CatalogueEntry catalogue(const std::string& name);

// Those at rest and those in time; throws Error for a name that it does not know.
CatalogueEntry case_at_rest(const std::string& name);
CatalogueEntry case_in_time(const std::string& name);

/// What all cases share: name, sentence, unit tensions.
CatalogueEntry entry(const std::string& name, const std::vector<double>& centre);

/// A function of the distance to a centre.
template <class F>
scene::FieldPtr radial(const std::vector<double>& centre, F f, std::optional<scene::Degree> degree = {}) {
  return scene::formula([cx = centre[0], cy = centre[1], f](double x, double y) { return f(std::hypot(x - cx, y - cy)); },
                        "a function of the scene", degree);
}

/// Gradient of the radial function with f'(r) = r * slope(r): slope(r) (x - centre).
template <class F>
std::array<scene::FieldPtr, 2> radial_gradient(const std::vector<double>& centre, F slope) {
  const double cx = centre[0], cy = centre[1];
  return {scene::formula([=](double x, double y) { return slope(std::hypot(x - cx, y - cy)) * (x - cx); }),
          scene::formula([=](double x, double y) { return slope(std::hypot(x - cx, y - cy)) * (y - cy); })};
}

}  // namespace thixis::membranes
