#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "thixis/complementarity/active_set.hpp"
#include "thixis/complementarity/estimate.hpp"
#include "thixis/complementarity/kkt.hpp"
#include "thixis/complementarity/problem.hpp"
#include "thixis/mesh/mesh.hpp"
#include "thixis/models/params.hpp"
#include "thixis/output/checkpoint.hpp"
#include "thixis/output/fields.hpp"
#include "thixis/output/summary.hpp"

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
/// The same from where bounds keep it.
CellEstimates cell_estimates(const mesh::View<const double*>& discretization, const mesh::View<const double*>& linearization,
                             const mesh::View<const double*>& algebraic);

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

/// A number that a run ends with, and the bounds that the deck expects it within. In words: "front 3 is not between 0 and 1".
struct Expectation {
  std::string what;
  std::optional<double> value;  ///< none: it is not known
  std::optional<double> least, most;
};

/// What goes on from X needs: everything beside the deck.
struct State {
  std::vector<output::CheckpointBlock> blocks;  ///< by ids that do not depend on the number of ranks (method::Space::unknown_ids)
  std::map<std::string, double> attributes;     ///< sums over the steps so far
};

/// A scene on a mesh, at rest (Discretization) or in time (Evolution): its algebraic problem, and what is read of an X. In time X stands at
/// the end of a step, or is X^0. All members are collective.
class SceneOnMesh {
 public:
  virtual ~SceneOnMesh();

  virtual const core::Comm& comm() const = 0;
  virtual GlobalIndex cells() const = 0;
  virtual Sizes sizes() const = 0;
  virtual complementarity::Problem& problem() = 0;  ///< in time: of the step begun

  /// The bound on the error at any X, an iterate or the solution; in time the share of the step begun in the bound over all time, sqrt of
  /// an integral over the step. What it needs of the mesh is set up at the first call; a run that never asks pays nothing. Throws
  /// InputError where the scene has no bound.
  virtual complementarity::Estimate estimate(const algebra::Vector& X) = 0;
  virtual CellEstimates cell_estimates() const = 0;               ///< of the last call of `estimate`
  virtual std::vector<std::string> doubts() const { return {}; }  ///< what keeps it from being guaranteed, a clause each
  /// What `estimate` bounds, if the exact solution is known: |||u - u_h|||, in time the share of the step if it ended with X.
  virtual std::optional<double> energy_error(const algebra::Vector&) const { return {}; }

  virtual double energy_norm(const algebra::Vector&) const { return 0; }  ///< |||u_h|||
  /// Everything the verifier needs, recomputed from X cell by cell.
  virtual complementarity::KktData kkt_data(const algebra::Vector& X) const = 0;
  virtual std::optional<Contact> contact(const algebra::Vector&) const { return {}; }
  /// The fields of Model::point_fields at points, [probe][field], on all ranks.
  virtual std::vector<double> values_at(const std::vector<Probe>&, const algebra::Vector&) const { return {}; }
  virtual output::Grid grid() const = 0;  ///< what fields are shown on
  /// The fields that the model can show, on the points of grid(), by name; `names` empty: all.
  virtual std::vector<output::FieldData> fields(const algebra::Vector& X, const complementarity::ActiveSet& active,
                                                const std::vector<std::string>& names) const = 0;
  /// What the deck expects of this model alone (ExpectParams::own), with what was found.
  virtual std::vector<Expectation> expectations(const ExpectParams&, const algebra::Vector&) const { return {}; }
  /// What the summary says of this model alone.
  virtual std::vector<output::SummaryEntry> summary(const algebra::Vector&) const { return {}; }

  virtual State save(const algebra::Vector& X) const = 0;
  /// The X that was saved, exactly, on any number of ranks, and the sums that go with it. Throws InputError if it belongs to another model,
  /// mesh or method.
  virtual Teuchos::RCP<algebra::Vector> restore(const output::StoredCheckpoint& stored) = 0;
};

}  // namespace thixis::models
