#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "thixis/complementarity/active_set.hpp"
#include "thixis/complementarity/estimate.hpp"
#include "thixis/complementarity/kkt.hpp"
#include "thixis/complementarity/problem.hpp"
#include "thixis/mesh/mesh.hpp"
#include "thixis/output/checkpoint.hpp"
#include "thixis/output/fields.hpp"

namespace thixis::models {

/// Sizes of a discretized scene, over all ranks.
struct Sizes {
  GlobalIndex unknowns_all = 0;     ///< all fields with the multiplier, Dirichlet values not counted
  GlobalIndex unknowns_global = 0;  ///< rows of the Krylov system (reduced: before contact is imposed)
  GlobalIndex nonzeros = 0;         ///< of that system; 0 before it is set up
};

/// The bound of each owned cell of this rank, by component.
struct CellEstimates {
  std::vector<double> discretization, linearization, algebraic;
};

/// The bound of the literature (docs/methods/estimates.md, 7) with all its terms by name.
struct PublishedEstimate {
  complementarity::Estimate parts;
  std::vector<std::pair<std::string, double>> terms;
};

/// What contact does on the whole, over the points that are not held: sum_l (psi_l, 1) over those in contact, s_l lambda_l > K_l, and
/// sum_l <lambda_h, psi_l>, the integral of the contact force. Where fields are held in contact the strip of the first cells, h/2 for
/// degree 1, counts as held.
struct Contact {
  double area = 0, force = 0;
};

/// What the rounding of heights may hide, at worst: forces of this size relative to those that act.
struct Rounding {
  double of_contact = 0;  ///< … to what drives the gap
  double of_forces = 0;   ///< … to the forces on a field, boundary data not among them; 0 where there are none
  double height = 0;      ///< the largest one, counted from where the fields are held
};

/// A point that a run looks at.
struct Probe {
  std::string path;  ///< the entry of the deck that names it
  std::array<double, 2> at;
};

/// What a run is to show of its solution.
struct Wanted {
  std::vector<std::string> fields;  ///< of fields.h5, by name
  std::vector<Probe> expected;      ///< points at which values are judged at the end
  std::vector<Probe> probes;        ///< points that are followed
};

/// A scene on one mesh.
class Discretization {
 public:
  virtual ~Discretization();

  virtual complementarity::Problem& problem() = 0;
  virtual Sizes sizes() const = 0;
  /// Sweeps of nonlinear smoothing that pay after each Newton step of a nested run.
  virtual int sweeps() const { return 0; }

  /// X0 of a cold start: the deck's or the case's initial values, otherwise zero or the height closest to zero that is held.
  virtual Teuchos::RCP<algebra::Vector> cold_start() const = 0;
  /// X0 from the solution on the next coarser mesh of the hierarchy.
  virtual Teuchos::RCP<algebra::Vector> nested_start(const Discretization& coarse, const algebra::Vector& coarse_X) const = 0;

  /// X as named values whose ids do not depend on the number of ranks (method::Space::unknown_ids); Dirichlet values are left out.
  virtual std::vector<output::CheckpointBlock> save(const algebra::Vector& X) const = 0;
  /// The X that was saved, exactly, on any number of ranks. Collective. Throws InputError if it belongs to another model, mesh or method.
  virtual Teuchos::RCP<algebra::Vector> restore(const output::StoredCheckpoint& stored) const = 0;

  /// |||u - u_h|||, if the exact solution is known, and |||u_h|||.
  virtual std::optional<double> energy_error(const algebra::Vector& X) const = 0;
  virtual double energy_norm(const algebra::Vector& X) const = 0;
  /// The bound on the error at any X, an iterate or the solution. What it needs of the mesh is set up at the first call; a run that never
  /// asks pays nothing. Collective; throws InputError where the scene has no bound.
  virtual complementarity::Estimate estimate(const algebra::Vector& X) = 0;
  /// What keeps `estimate` from being guaranteed, a clause each, after its first call.
  virtual std::vector<std::string> doubts() const { return {}; }
  /// Of the last call of `estimate`.
  virtual CellEstimates cell_estimates() const = 0;
  /// What is held for them on this rank; 0 before the first.
  virtual std::size_t bytes_of_estimate() const { return 0; }
  /// Nothing where the literature has no such bound. `friedrichs`: C in |v| <= C |grad v|; not given: that of the box around the domain,
  /// where the whole boundary is held, else nothing. Collective.
  virtual std::optional<PublishedEstimate> published_estimate(const algebra::Vector& X, std::optional<double> friedrichs) = 0;
  /// Everything the verifier needs, recomputed from X cell by cell.
  virtual complementarity::KktData kkt_data(const algebra::Vector& X) const = 0;
  virtual Rounding rounding(const algebra::Vector& X) const = 0;
  virtual Contact contact(const algebra::Vector& X) const = 0;
  /// The fields of Model::point_fields at points, [probe][field], on all ranks. Collective.
  virtual std::vector<double> values_at(const std::vector<Probe>& probes, const algebra::Vector& X) const = 0;
  /// What fields are shown on.
  virtual output::Grid grid() const = 0;
  /// The fields that the model can show, on the points of grid(), by name; `names` empty: all.
  virtual std::vector<output::FieldData> fields(const algebra::Vector& X, const complementarity::ActiveSet& active,
                                                const std::vector<std::string>& names) const = 0;
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
