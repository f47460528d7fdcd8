#pragma once
#include <memory>
#include <vector>

#include "thixis/mesh/host.hpp"
#include "thixis/method/numbering.hpp"
#include "thixis/method/quadrature.hpp"
#include "thixis/method/space.hpp"
#include "thixis/reference/cell_basis.hpp"

namespace thixis::method {

/// How a method lays out its coefficients. **Patch cells** are those of method::patch_cells, by position: owned ones first.
struct Structure {
  Entries entries;
  /// (patch cell, i) -> entry. The first dim P_p are the coefficients of the cell's polynomial in the order of reference::CellBasis; those
  /// of unknowns on faces may follow.
  Kokkos::View<LocalIndex**, Kokkos::LayoutRight> element_entries;
  /// (element, i) -> entry: couplings of a(.,.) where they are more than those of the cells; empty: element_entries. -1: none.
  Kokkos::View<LocalIndex**, Kokkos::LayoutRight> coupled_entries;
  LocalIndex cell_entries = 0;          ///< entries that are coefficients of the cells' polynomials, and contact points: the first ones
  GlobalIndex global_cell_entries = 0;  ///< on all ranks, held ones included: their ids are 0 … global_cell_entries - 1
  int interior = 0;                     ///< of each element, for condensation: its first unknowns
};

/// Moments of a source against functions that are held, where no equation gives them: factor · moments(patch cell, l). Of length 0: none.
struct HeldSource {
  Kokkos::View<const double**, Kokkos::LayoutRight> moments;
  double factor = 1;
};

/// What methods share: functions that are polynomials of degree p in every cell. A method adds its numbering, its forms and what it does on
/// the boundary.
class PolynomialSpace : public Space {
 public:
  const mesh::Mesh& mesh() const final { return mesh_; }
  algebra::MapPtr map() const final { return numbering_.rows; }
  algebra::MapPtr points() const final { return points_; }
  std::vector<GlobalIndex> unknown_ids() const final;
  algebra::GraphPtr graph() const final { return graph_; }
  Teuchos::RCP<const algebra::MultiVector> coordinates() const final;
  const algebra::Vector& pairing() const override { return *pairing_; }
  bool nodal_multiplier() const override { return false; }

  /// The scattered cell form; methods with forms on faces add them.
  algebra::MatrixPtr stiffness(const scene::Field& tension) const override;
  const ElementUnknowns& elements() const final { return elements_; }
  int interior() const final { return structure_.interior; }
  algebra::MatrixPtr mass() const final;
  std::shared_ptr<const CellForm> with_mass(const std::shared_ptr<const CellForm>& form, double factor, double weight) const final;
  void apply_mass(const Coefficients& w, algebra::Vector& y) const final;
  void move_interface(double t) final;

  /// Nodal interpolation at the held entries.
  Coefficients lift(const BoundaryValues& boundary, double t) const override;
  /// The cells' part, (f, psi_l), and Neumann data on the cells' traces.
  void load(const scene::Field& tension, const scene::Field& force, const BoundaryValues& boundary, double t,
            algebra::Vector& F) const override;
  /// The cell form's part.
  void forces(const scene::Field& tension, const Coefficients& u, algebra::Vector& y) const override;

  Coefficients complete(const algebra::Vector& u, const Coefficients& lift) const final;
  void restrict_to_unknowns(const Coefficients& u, algebra::Vector& values) const final;
  /// The cells' part; entries of faces are left 0.
  void interpolate(const scene::Field& u, double t, algebra::Vector& values) const override;
  void interpolate_obstacle(const scene::Field& psi, algebra::Vector& values) const final;
  void prolongate(const Space& coarse, const Coefficients& coarse_u, algebra::Vector& values) const override;

  /// By the mass matrix of each cell: for functions without continuity.
  Coefficients multiplier(const algebra::Vector& X3) const override;
  void interpolate_multiplier(const scene::Field& lambda, double t, algebra::Vector& X3) const override;
  void prolongate_multiplier(const Space& coarse, const algebra::Vector& coarse_X3, algebra::Vector& X3) const override;

  double energy(const scene::Field& tension, const Coefficients& u) const final;
  double energy_error(const scene::Field& tension, const Coefficients& u, const Gradient& exact, double t) const final;
  double l2_error(const Coefficients& u, const scene::Field& exact, double t) const final;
  double penetration(const Coefficients& u, const scene::Field* obstacle, double t) const final;

  // -- what error estimates read ----------------------------------------------------------------------------------------------------
  const reference::CellBasis& basis() const { return basis_; }
  const View<const LocalIndex*>& cells() const { return cells_; }  ///< patch cells, the owned ones first
  const CellQuadrature& quadrature() const { return quadrature_; }
  const Structure& coefficients() const { return structure_; }
  const Numbering& numbering() const { return numbering_; }
  /// Patch position of a local cell, -1 if it is none.
  LocalIndex position(LocalIndex cell) const { return position_[cell]; }
  /// Whether functions of the space are continuous.
  virtual bool conforming() const { return false; }
  /// Shares a residual R out to the cells: moments(k, l) = (r, psi_l)_K on patch cell k, so that the sum over the cells of each unknown is
  /// R_l; an unknown that cells share gives each of them the same part, one on a face by its test function there. Collective.
  virtual void share(const algebra::Vector& R, const View<double**>& moments) const;
  /// q: the flux of the method lies in RT_q.
  virtual int flux_degree() const { return basis_.degree(); }
  /// The flux -mu grad u as the method itself has it, H(div)-conforming, in modal coefficients (reference::Modal, [2][dim P_{q+1}]) on the
  /// owned cells: with R = F - (-1)^alpha D lambda - a(u, ·) shared out as r,
  ///
  ///     (div sigma, v)_K = (f - (-1)^alpha lambda_h - r, v)_K      for all v in P_q(K),
  ///
  /// whatever u is; r has no moments against functions that are held, lambda_h those of `at_held`. sigma·n = -Π_q t on the Neumann
  /// boundary. `force` and `boundary`: the data that u_h belongs to. For spaces that are not conforming. Collective.
  virtual void native_flux(const scene::Field& tension, const scene::Field& force, const Coefficients& u, const BoundaryValues& boundary,
                           double t, const HeldSource& at_held, const View<double**>& sigma) const;

  output::Grid display() const final;
  std::vector<double> shown(const Coefficients& u) const final;
  std::vector<double> coefficients_shown(const Coefficients& u) const final;

 protected:
  /// Collective. The mesh must outlive the space.
  PolynomialSpace(const mesh::Mesh& mesh, const SpaceOptions& options, Structure structure);

  /// f(first, count) for blocks of patch cells, of at most `block_cells`.
  template <class F>
  void over_blocks(LocalIndex block_cells, F f) const {
    const LocalIndex cells = cells_.extent_int(0);
    for (LocalIndex first = 0; first < cells; first += block_cells) f(first, std::min(block_cells, cells - first));
  }
  /// F(l) += (f, psi_l) for the cells' basis functions; F is on map() or points(). Throws on this rank only.
  void add_moments(const scene::Field& f, double t, algebra::Vector& F) const;
  /// F(l) += <t, trace of psi_l> on the faces whose tag has a function. Throws on this rank only.
  void add_traces(const std::vector<scene::FieldPtr>& by_tag, double t, algebra::Vector& F) const;
  /// Coefficients of the polynomial in each patch cell that a function of the coarse space is there; (patch cell, l). Collective.
  View<double**> from_coarse(const PolynomialSpace& coarse, const Coefficients& coarse_u) const;
  /// Values at the places of these entries. Throws on this rank only.
  std::vector<double> at_entries(const scene::Field& field, const std::vector<LocalIndex>& entries, double t) const;
  /// The same number D for every contact point.
  void set_pairing(Teuchos::RCP<const algebra::Vector> pairing) { pairing_ = std::move(pairing); }

  const mesh::Mesh& mesh_;
  mesh::HostMesh host_;
  MethodParams params_;
  reference::CellBasis basis_;
  Structure structure_;
  Numbering numbering_;
  View<const LocalIndex*> cells_;  ///< patch cells
  CellQuadrature quadrature_;      ///< on them
  ElementUnknowns elements_;       ///< (patch cell, i) -> column

 private:
  using CellCoefficients = Kokkos::View<double**, Kokkos::LayoutRight>;

  int functions() const { return basis_.size(); }
  /// (k, l): coefficients of the polynomial in the cell ids[k], whichever rank owns it. Collective.
  CellCoefficients of_cells(const std::vector<GlobalIndex>& ids, const Coefficients& u) const;
  /// The same of all owned cells; not collective.
  CellCoefficients of_own_cells(const Coefficients& u) const;
  double error(const scene::Field& tension, const Coefficients& u, const Gradient* exact, double t) const;
  algebra::MatrixPtr assemble(const CellForm& form) const;
  void apply_form(const CellForm& form, const Coefficients& u, algebra::Vector& y) const;

  scene::FieldPtr level_set_;
  std::vector<LocalIndex> position_;
  mutable std::vector<int> sharers_;  ///< cells of each unknown of this rank; made when a residual is first shared out
  algebra::MapPtr points_;
  algebra::GraphPtr graph_;
  Teuchos::RCP<const algebra::Vector> pairing_;
};

/// The family of nodes that the deck asks for.
reference::Family family(Nodes nodes);

/// Tag of the Dirichlet data on each face: its own tag where that is held, -1 elsewhere. For vertices the lowest among their faces on this
/// rank.
std::vector<LocalIndex> held_faces(const mesh::Mesh& mesh, const std::vector<bool>& dirichlet);
std::vector<LocalIndex> held_vertices(const mesh::Mesh& mesh, const std::vector<bool>& dirichlet);

}  // namespace thixis::method
