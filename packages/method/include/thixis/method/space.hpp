#pragma once
#include <Kokkos_Core.hpp>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "thixis/algebra/fwd.hpp"
#include "thixis/mesh/mesh.hpp"
#include "thixis/method/graph.hpp"
#include "thixis/method/params.hpp"
#include "thixis/output/fields.hpp"
#include "thixis/scene/field.hpp"

namespace thixis::method {

/// What one scalar field does on the boundary: for each tag of the mesh a value g (Dirichlet) or t = mu du/dn (Neumann); the other is null.
struct BoundaryValues {
  std::vector<scene::FieldPtr> dirichlet, neumann;
};

/// Gradient of a known function.
using Gradient = std::array<scene::FieldPtr, 2>;

/// All coefficients of a discrete function that this rank needs: unknowns, Dirichlet values and ghosts, in a numbering of the space.
using Coefficients = Kokkos::View<double*>;

/// Local matrices: (cell, i, j).
using LocalMatrices = Kokkos::View<double***, Kokkos::LayoutRight>;

/// A form as a sum over cells, a(u, v) = sum_K a_K(u, v).
class CellForm {
 public:
  virtual ~CellForm() = default;
  /// A(e, i, j) = a_K(psi_j, psi_i) for the patch cell first + e and its unknowns in the order of Space::elements(); overwrites A.
  virtual void matrices(LocalIndex first, const LocalMatrices& A) const = 0;
};

/// A discrete space for a scalar field u on one mesh, with the form a(u,v) that stands for (mu grad u, grad v) on it and the pairing of
/// the multiplier with the gap. Scenes are built from it; they know no basis function.
///
/// **Contact points** are the first unknowns of each rank (all of them, but for methods that have unknowns on faces besides): gap and
/// multiplier have one value for each of their basis functions psi_l.
class Space {
 public:
  virtual ~Space() = default;

  virtual const mesh::Mesh& mesh() const = 0;
  virtual algebra::MapPtr map() const = 0;     ///< of the unknowns; Dirichlet values are none
  virtual algebra::MapPtr points() const = 0;  ///< of the contact points; map() itself where all unknowns are such
  /// The identity of each unknown of this rank, in the order of map(): >= 0, different for different unknowns of the space, and, unlike
  /// the numbers of map(), the same on any number of ranks, so that a checkpoint can name them. From the ids of mesh entities, with
  /// n unknowns per entity: n id + k for the k-th one of it; kinds of entities follow each other (vertices, faces, cells), each range
  /// beginning where that of all entities before ends. k is counted along what does not depend on the ranks either: along a face from
  /// its lower to its higher vertex id, in a cell by its basis. Ids of Dirichlet nodes are not used.
  virtual std::vector<GlobalIndex> unknown_ids() const = 0;
  virtual algebra::GraphPtr graph() const = 0;  ///< couplings of a(.,.): columns sorted, those of this rank first
  virtual Teuchos::RCP<const algebra::MultiVector> coordinates() const = 0;  ///< two columns, of the unknowns' places

  /// D_l > 0 with <lambda, psi_l> = D_l X3_l, on points(): (psi_l, 1) for nodal multipliers, 1 for moments.
  virtual const algebra::Vector& pairing() const = 0;
  virtual bool nodal_multiplier() const = 0;
  virtual bool symmetric() const { return true; }  ///< a(u, v) = a(v, u)

  /// S_lm = a(psi_m, psi_l) on the unknowns.
  virtual algebra::MatrixPtr stiffness(const scene::Field& tension) const = 0;

  /// For condensation: columns of graph() of the unknowns of each patch cell, -1 for Dirichlet values; the first interior() of them belong
  /// to this cell alone.
  virtual const ElementUnknowns& elements() const = 0;
  virtual int interior() const = 0;
  /// The part of a(.,.) that is a sum over cells: all of it where interior() > 0.
  virtual std::shared_ptr<const CellForm> cell_form(const scene::Field& tension) const = 0;

  // The L² product of the functions in the cells, exactly: the mass of unknowns on faces is 0.
  /// M_lm = (psi_m, psi_l), on graph() like the stiffness.
  virtual algebra::MatrixPtr mass() const = 0;
  /// factor a_K(u, v) + weight (u, v)_K, cell by cell; `form` null: the mass alone.
  virtual std::shared_ptr<const CellForm> with_mass(const std::shared_ptr<const CellForm>& form, double factor, double weight) const = 0;
  /// y_l = (w, psi_l).
  virtual void apply_mass(const Coefficients& w, algebra::Vector& y) const = 0;

  /// From now on integrals of data follow the curves across which these jump at time t: loads, moments of multipliers, errors. Forms with
  /// varying tensions made before keep their quadrature. Collective; throws InputError as make_quadrature does.
  virtual void move_interface(double t) = 0;

  /// Coefficients of the lift of the Dirichlet data: what they fix, 0 elsewhere.
  virtual Coefficients lift(const BoundaryValues& boundary, double t) const = 0;
  /// F_l = (f, psi_l) + <t, psi_l> over the Neumann boundary + what weakly imposed Dirichlet data give.
  virtual void load(const scene::Field& tension, const scene::Field& force, const BoundaryValues& boundary, double t,
                    algebra::Vector& F) const = 0;
  /// y_l = a(u, psi_l), evaluated cell by cell without the assembled matrix.
  virtual void forces(const scene::Field& tension, const Coefficients& u, algebra::Vector& y) const = 0;

  /// u + lift: a collective operation (ghost values are fetched).
  virtual Coefficients complete(const algebra::Vector& u, const Coefficients& lift) const = 0;
  /// The inverse: the unknowns' part.
  virtual void restrict_to_unknowns(const Coefficients& u, algebra::Vector& values) const = 0;
  /// The interpolant of a function: nodal in the cells, projected on faces.
  virtual void interpolate(const scene::Field& u, double t, algebra::Vector& values) const = 0;
  /// The coefficients of an obstacle: of its interpolant, and where it jumps inside a cell of what thixis/method/jumps.hpp makes of that.
  virtual void interpolate_obstacle(const scene::Field& psi, algebra::Vector& values) const = 0;
  /// Evaluates a function of the next coarser space of the hierarchy in this one. Collective.
  virtual void prolongate(const Space& coarse, const Coefficients& coarse_u, algebra::Vector& values) const = 0;

  // The multiplier, X3 on points().
  /// lambda_h as a function: the nodal values, or sum_l X3_l Theta_l in the dual basis, moments at fixed nodes being 0. Collective.
  virtual Coefficients multiplier(const algebra::Vector& X3) const = 0;
  /// X3 of a known function: its nodal values or moments.
  virtual void interpolate_multiplier(const scene::Field& lambda, double t, algebra::Vector& X3) const = 0;
  /// X3 of the function lambda_h of the next coarser space. Collective.
  virtual void prolongate_multiplier(const Space& coarse, const algebra::Vector& coarse_X3, algebra::Vector& X3) const = 0;

  /// ∫ mu |grad u_h|² and ∫ mu |grad u - grad u_h|² over the whole mesh, cell by cell. Collective.
  virtual double energy(const scene::Field& tension, const Coefficients& u) const = 0;
  virtual double energy_error(const scene::Field& tension, const Coefficients& u, const Gradient& exact, double t) const = 0;
  /// ∫ (u - u_h)² over the whole mesh. Collective.
  virtual double l2_error(const Coefficients& u, const scene::Field& exact, double t) const = 0;
  /// max(max(obstacle - u_h, 0)) over all points of all cells, to a few per cent (a lattice of 8p points a side). `obstacle` null: zero.
  virtual double penetration(const Coefficients& u, const scene::Field* obstacle, double t) const = 0;

  /// For output. `shown`: u_h at the points of the display; `coefficients_shown`: the coefficient that belongs to each point. Ghosts may be
  /// 0.
  virtual output::Grid display() const = 0;  ///< triangles with one point per coefficient of the cells' polynomials
  virtual std::vector<double> shown(const Coefficients& u) const = 0;
  virtual std::vector<double> coefficients_shown(const Coefficients& u) const = 0;
};

/// Where a space takes Dirichlet data: one flag per tag of the mesh. `level_set` (may be null): curves across which data jump.
struct SpaceOptions {
  std::vector<bool> dirichlet;
  scene::FieldPtr level_set;
  MethodParams params;
};
using SpaceFactory = std::function<std::unique_ptr<Space>(const mesh::Mesh&, const SpaceOptions&)>;
/// Throws InputError, on all ranks, for a mesh on which the method can not be trusted. Collective. May be empty.
using MeshCheck = std::function<void(const mesh::Mesh&, const SpaceOptions&)>;

}  // namespace thixis::method
