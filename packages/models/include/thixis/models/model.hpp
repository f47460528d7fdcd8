#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "thixis/models/scene_on_mesh.hpp"

namespace thixis::models {

/// A stationary scene on one mesh.
class Discretization : public SceneOnMesh {
 public:
  /// Sweeps of nonlinear smoothing that pay after each Newton step of a nested run.
  virtual int sweeps() const { return 0; }
  /// X0 of a cold start: the deck's or the case's initial values, otherwise zero or the height closest to zero that is held.
  virtual Teuchos::RCP<algebra::Vector> cold_start() const = 0;
  /// X0 from the solution on the next coarser mesh of the hierarchy.
  virtual Teuchos::RCP<algebra::Vector> nested_start(const Discretization& coarse, const algebra::Vector& coarse_X) const = 0;
  /// What is held for estimates on this rank; 0 before the first.
  virtual std::size_t bytes_of_estimate() const { return 0; }
  /// Nothing where the literature has no such bound. `friedrichs`: C in |v| <= C |grad v|; not given: that of the box around the domain,
  /// where the whole boundary is held, else nothing.
  virtual std::optional<PublishedEstimate> published_estimate(const algebra::Vector& X, std::optional<double> friedrichs) = 0;
  virtual Rounding rounding(const algebra::Vector& X) const = 0;
};

/// A scene before it meets a mesh: a StationaryModel or an UnsteadyModel (evolution.hpp).
class Model {
 public:
  virtual ~Model();
  virtual std::string name() const = 0;
  virtual std::string case_name() const = 0;                  ///< empty for data of the user
  virtual std::vector<std::string> point_fields() const = 0;  ///< the names of the fields whose values at points are known
};

class StationaryModel : public Model {
 public:
  /// Throws InputError for what only a mesh shows: unknown boundary tags, boundary data that contradict each other, tensions that are not
  /// positive and data that are not finite somewhere, unknown field names, points outside of the mesh.
  /// Collective; to be asked before anything is computed or written.
  virtual void check(const mesh::Mesh& mesh, const Wanted& wanted) const = 0;
  /// On a level of the hierarchy, which must outlive the result. Collective.
  virtual std::unique_ptr<Discretization> discretize(const mesh::Hierarchy& hierarchy, int level) const = 0;
};

}  // namespace thixis::models
