#pragma once
#include <memory>
#include <string>
#include <vector>

#include "problem/membrane_problem.hpp"
#include "scene/boundary.hpp"
#include "scene/point_list.hpp"
#include "thixis/bound/guaranteed_bound.hpp"
#include "thixis/complementarity/active_set.hpp"
#include "thixis/method/levels.hpp"
#include "thixis/models/model.hpp"
#include "thixis/output/checkpoint.hpp"
#include "thixis/output/fields.hpp"

namespace thixis::membranes {

/// The name of a displacement: of a field, and in checkpoints.
inline std::string displacement(int count, int alpha) { return count == 1 ? "u" : alpha == 0 ? "u1" : "u2"; }

/// The spaces of a scene on the levels of a hierarchy. Scene and hierarchy must outlive them.
std::shared_ptr<method::Levels> levels_of(const MembraneScene& scene, const method::Method& by, const method::MethodParams& method,
                                          const mesh::Hierarchy& hierarchy);

/// Whether forces take those on the boundary in.
enum class Tractions { without, with };

/// Membranes on one mesh: the space, the data at one time, the algebraic problem, and what is read of its X.
class MembraneLevel {
 public:
  /// At time 0. Takes space and forms from `levels`. The scene, whose heights are counted from `origin`, must outlive it. Collective.
  MembraneLevel(const MembraneScene& scene, double origin, const std::shared_ptr<method::Levels>& levels, int level,
                const algebra::LinearParams& linear);

  method::Levels& levels() const { return *levels_; }
  int level() const { return level_; }
  const MembraneScene& scene() const { return scene_; }
  int count() const { return scene_.count; }
  const method::Space& space() const { return *space_; }
  const std::array<method::FormPtr, 2>& forms() const { return form_; }  ///< (mu_alpha grad u, grad v)
  const Boundary& boundary() const { return boundary_; }
  MembraneProblem& problem() { return *problem_; }
  const MembraneProblem& problem() const { return *problem_; }

  /// The data at time t: lifts and loads, interface. Those that are known to be steady are kept. Matrices and loads of the problem stay
  /// what they were. Throws InputError where g_1 < g_2. Collective.
  void move_to(double t);
  double time() const { return time_; }
  const method::Coefficients& lift(int alpha) const { return lift_[alpha]; }
  const Teuchos::RCP<algebra::Vector>* body() const { return body_; }  ///< loads, before the lifts are moved to the right
  /// (f_alpha, psi_l), and <t_alpha, psi_l> with tractions; no boundary values among them. Collective.
  algebra::Vector force_alone(int alpha, Tractions tractions) const;
  const method::Coefficients& nothing() const { return nothing_; }    ///< no boundary values
  const method::Coefficients& obstacle() const { return obstacle_; }  ///< the interpolant of psi, for count = 1

  Teuchos::RCP<algebra::Vector> zero() const { return Teuchos::rcp(new algebra::Vector(problem_->map())); }
  Fields fields(algebra::Vector& X) const { return Fields(problem_->membranes(), X); }
  Fields fields(const algebra::Vector& X) const { return Fields(problem_->membranes(), X); }
  /// u_alpha with the boundary values of the time.
  method::Coefficients membrane(const Fields& x, int alpha) const { return space_->complete(*x.u.getVector(alpha), lift_[alpha]); }

  /// X from the solution on the level before. Collective.
  Teuchos::RCP<algebra::Vector> from_coarse(const MembraneLevel& coarse, const algebra::Vector& coarse_X) const;

  /// Measures residuals by what acts on the membranes from u°, beside the forces on them. Collective.
  void measure_from(const algebra::MultiVector& u);
  /// Newton begins at u, unknowns: its height counts among those whose rounding is no force. Collective.
  void start_from(const algebra::MultiVector& u);

  /// X as named values whose ids do not depend on the number of ranks; Dirichlet values are left out. `suffix`: behind the names.
  std::vector<output::CheckpointBlock> save(const algebra::Vector& X, const std::string& suffix = "") const;
  Teuchos::RCP<algebra::Vector> restore(const output::StoredCheckpoint& stored, const std::string& suffix = "") const;
  std::vector<output::FieldData> shown(const algebra::Vector& X, const complementarity::ActiveSet& active,
                                       const std::vector<std::string>& names) const;

  /// u_alpha, lambda, gap: what values_at gives for each point.
  static std::vector<std::string> point_fields(const MembraneScene& scene);
  std::vector<double> values_at(const std::vector<models::Probe>& probes, const algebra::Vector& X) const;
  models::Contact contact(const algebra::Vector& X) const;
  models::Rounding rounding(const algebra::Vector& X) const;
  double largest_gap(const algebra::Vector& X) const;  ///< at the contact points

  /// The scene as its bound sees it.
  bound::ContactProblem contact_problem() const;

 private:
  void require_stiffness() const;
  void measure_from_rest();
  double reach(double low) const;
  void set_lifts();
  void set_loads();
  method::Coefficients lift_of_obstacle() const;
  PointList grid_points() const;
  algebra::Vector gaps(const Fields& x) const;
  const algebra::Vector& areas() const;

  const MembraneScene& scene_;
  double origin_;  ///< of heights
  std::shared_ptr<method::Levels> levels_;
  int level_;
  std::shared_ptr<method::Space> space_;
  std::array<method::FormPtr, 2> form_;
  Boundary boundary_;
  std::array<double, 2> rest_ = {0, 0};                   ///< heights at which the membranes rest at the beginning
  std::array<double, 2> size_ = {0, 0}, start_ = {0, 0};  ///< the largest heights of each membrane: in the data, at the start
  double time_ = 0;
  bool steady_boundary_ = true, steady_loads_ = true, steady_interface_ = true;
  method::Coefficients nothing_, lift_[2], obstacle_;
  Teuchos::RCP<algebra::Vector> body_[2];
  std::unique_ptr<MembraneProblem> problem_;
  mutable Teuchos::RCP<algebra::Vector> areas_;  ///< (psi_l, 1)
};

/// X with what the bounds read of it.
struct MembraneIterate {
  algebra::Vector minus_R;
  Fields x, r;
  algebra::Vector gap_l;
  Teuchos::RCP<const algebra::Vector> residual[2];
  bound::Iterate iterate;

  MembraneIterate(const MembraneLevel& of, const algebra::Vector& X);
  MembraneIterate(const MembraneIterate&) = delete;
  MembraneIterate& operator=(const MembraneIterate&) = delete;
};

}  // namespace thixis::membranes
