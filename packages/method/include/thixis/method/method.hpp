#pragma once
#include <functional>
#include <string>
#include <vector>

#include "thixis/method/form.hpp"

namespace thixis::method {

/// When the systems of a method are symmetric.
struct Symmetry {
  std::function<bool(const MethodParams&)> holds;  ///< null: always
  std::string condition;                           ///< what to set: "method/variant = sipg"
  std::string without;                             ///< the name of what is not: "nipg"
  std::string remedy;                              ///< "the variant 'sipg'"
};

/// When a method has unknowns that belong to one cell alone, and whether it eliminates them unless told otherwise.
struct Interior {
  std::function<bool(const MethodParams&)> exists;  ///< null: never
  std::string condition;                            ///< what to set: "method/degree = 3 or 4"; empty: always
  bool condensed = false;                           ///< by default
};

/// A method as the program knows it: its name in the deck, the parameters that it uses, what its systems are like, and how its spaces are
/// made. Every package of a method has one, `entry()`.
struct Method {
  std::string name;                                           ///< `method/name` of the deck
  std::string title;                                          ///< in a list: "hybrid high-order"
  std::vector<std::string> uses;                              ///< entries of the deck that not every method uses, by path
  std::function<void(core::Schema<MethodParams>&)> describe;  ///< its own parameters (MethodParams::own); null: none

  SpaceFactory make_space;                                                         ///< null: it has no such spaces
  std::function<FormPtr(const Space&, const scene::FieldPtr& tension)> diffusion;  ///< (mu grad u, grad v) on one of them
  MeshCheck check_mesh;                                                            ///< may be null
  bool triangles = true;                                                           ///< lives on meshes of triangles alone
  Symmetry symmetry;
  Interior interior;
  bool bounded_in_time = false;  ///< the error in time has a bound
  bool published_bound = false;  ///< the literature has a bound on its error
  /// Unknowns of one field for each cell of a fine mesh: a triangle has half a vertex, 3/2 faces, and its inside.
  std::function<double(const MethodParams&)> unknowns_per_cell;

  bool has_interior(const MethodParams& params) const { return interior.exists && interior.exists(params); }
  bool symmetric(const MethodParams& params) const { return !symmetry.holds || symmetry.holds(params); }
  bool condensed(const MethodParams& params) const { return has_interior(params) && params.condensation.value_or(interior.condensed); }
};

/// Block `method` of a deck that may name these methods; the first one is the default.
core::Schema<MethodParams> schema_of(const std::vector<Method>& methods);

}  // namespace thixis::method
