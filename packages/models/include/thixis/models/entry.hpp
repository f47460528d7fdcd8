#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "thixis/core/uses.hpp"
#include "thixis/method/method.hpp"
#include "thixis/models/model.hpp"
#include "thixis/models/params.hpp"
#include "thixis/scene/examine.hpp"

namespace thixis::models {

/// A catalogued case of a model.
struct Case {
  std::string name, sentence;
};

/// Reports what can not be meant in the block `scene`, by paths relative to it.
using Examine = std::function<void(const SceneParams&, const scene::Report&)>;
/// Throws InputError with a line "scene/<path>: <sentence>" for everything that `examine` reports.
void require_right(const SceneParams& params, const Examine& examine);

/// A model as the program knows it: its name in the deck, what of the deck it uses, and how a scene is made of one.
struct Entry {
  std::string name;   ///< `scene/model` of the deck
  std::string title;  ///< in sentences
  bool in_time = false;
  double fields = 3;                      ///< unknowns at a point, multipliers among them
  std::vector<std::string> point_fields;  ///< Model::point_fields
  std::string without_probes;             ///< in time: what series.csv shows where output/probes is not given; empty: nothing
  std::vector<Case> cases;
  std::vector<std::string> uses;  ///< entries of the deck that not every model uses, by path

  std::function<bool(const method::Method&)> accepts;  ///< whether it can be solved with a method
  Examine examine;
  std::function<bool(const RunParams&)> lacks_exact;  ///< whether its scene has no exact solution; null: none ever has
  std::function<void(const RunParams&, std::vector<std::string>& mistakes)> judge;  ///< combinations that can not work; may be null
  std::function<std::unique_ptr<Model>(const RunParams&, const method::Method&)> make;
  std::function<void(RunParams&)> begin;  ///< makes a deck to start from, in which scene/model and scene/case are given
};

/// What a package of models brings: they, and the parts of the deck that are theirs (Extras of the blocks). Functions may be null.
struct Family {
  std::vector<Entry> models;
  std::function<void(core::Schema<SceneParams>&)> scene;
  std::function<void(core::Schema<complementarity::NewtonParams>&)> newton;
  std::function<void(core::Schema<ExpectParams>&)> expect;
  std::function<void(core::Uses<RunParams>&)> uses;  ///< conditions beside Entry::uses
  std::vector<std::string> beginning;                ///< blocks that a run looks at when it begins, and a restart does not
};

}  // namespace thixis::models
