#pragma once
#include <Kokkos_Core.hpp>
#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "thixis/algebra/fwd.hpp"
#include "thixis/core/schema.hpp"
#include "thixis/mesh/mesh.hpp"
#include "thixis/scene/field.hpp"

namespace thixis::method {

enum class MethodName { fem, dg, hho, fv };
std::string to_text(MethodName name);  ///< as in the deck
enum class Nodes { gauss_lobatto, equispaced, bernstein };

/// Block `method` of the deck.
struct MethodParams {
  MethodName name = MethodName::fem;
  int degree = 1;
  Nodes nodes = Nodes::gauss_lobatto;
  int quadrature_order = 0;  ///< 0: 2 degree + 4
  static const core::Schema<MethodParams>& schema();
  int order() const { return quadrature_order > 0 ? quadrature_order : 2 * degree + 4; }
};

/// What one scalar field does on the boundary: for each tag of the mesh a value g (Dirichlet) or t = mu du/dn (Neumann); the other is null.
struct BoundaryValues {
  std::vector<scene::FieldPtr> dirichlet, neumann;
};

/// Gradient of a known function.
using Gradient = std::array<scene::FieldPtr, 2>;

/// All coefficients of a discrete function that this rank needs: unknowns, Dirichlet values and ghosts, in a numbering of the space.
using Coefficients = Kokkos::View<double*>;

/// A discrete space for a scalar field u on one mesh, with the form a(u,v) = (mu grad u, grad v) on it and the pairing of
/// the multiplier with the gap. Scenes are built from it; they know no basis function.
///
/// Basis functions psi_l of the unknowns carry the contact points, too: gap and multiplier have one value for each.
class Space {
 public:
  virtual ~Space() = default;

  virtual const mesh::Mesh& mesh() const = 0;
  virtual algebra::MapPtr map() const = 0;  ///< of the unknowns; Dirichlet values are none
  /// The identity of each unknown of this rank, in the order of map(): >= 0, different for different unknowns of the space, and, unlike
  /// the numbers of map(), the same on any number of ranks, so that a checkpoint can name them. From the ids of mesh entities, with
  /// n unknowns per entity: n id + k for the k-th one of it; kinds of entities follow each other (vertices, faces, cells), each range
  /// beginning where that of all entities before ends. k is counted along what does not depend on the ranks either: along a face from
  /// its lower to its higher vertex id, in a cell by its basis. Ids of Dirichlet nodes are not used.
  virtual std::vector<GlobalIndex> unknown_ids() const = 0;
  virtual algebra::GraphPtr graph() const = 0;  ///< couplings of a(.,.): columns sorted, those of this rank first
  virtual Teuchos::RCP<const algebra::MultiVector> coordinates() const = 0;  ///< two columns, of the unknowns' nodes

  /// D_l > 0 with <lambda, psi_l> = D_l X3_l: (psi_l, 1) for nodal multipliers, 1 for moments.
  virtual const algebra::Vector& pairing() const = 0;

  /// S_lm = a(psi_m, psi_l) on the unknowns.
  virtual algebra::MatrixPtr stiffness(const scene::Field& tension) const = 0;

  /// Coefficients of the lift of the Dirichlet data: g at Dirichlet nodes, 0 elsewhere.
  virtual Coefficients lift(const BoundaryValues& boundary, double t) const = 0;
  /// F_l = (f, psi_l) + <t, psi_l> over the Neumann boundary.
  virtual void load(const scene::Field& force, const BoundaryValues& boundary, double t, algebra::Vector& F) const = 0;
  /// y_l = sum over cells of a_K(u, psi_l), evaluated cell by cell without the assembled matrix.
  virtual void forces(const scene::Field& tension, const Coefficients& u, algebra::Vector& y) const = 0;

  /// u + lift: a collective operation (ghost values are fetched).
  virtual Coefficients complete(const algebra::Vector& u, const Coefficients& lift) const = 0;
  /// The inverse: the unknowns' part.
  virtual void restrict_to_unknowns(const Coefficients& u, algebra::Vector& values) const = 0;
  /// Nodal interpolation of a function to the unknowns.
  virtual void interpolate(const scene::Field& u, double t, algebra::Vector& values) const = 0;
  /// Evaluates a function of the next coarser space of the hierarchy at the nodes of this one. Collective.
  virtual void prolongate(const Space& coarse, const Coefficients& coarse_u, algebra::Vector& values) const = 0;

  /// ∫ mu |grad u_h|² and ∫ mu |grad u - grad u_h|² over the whole mesh. Collective.
  virtual double energy(const scene::Field& tension, const Coefficients& u) const = 0;
  virtual double energy_error(const scene::Field& tension, const Coefficients& u, const Gradient& exact, double t) const = 0;

  /// Values at the local vertices, for output; ghosts may be left 0.
  virtual std::vector<double> at_vertices(const Coefficients& u) const = 0;
};

/// Where a space takes Dirichlet data: one flag per tag of the mesh. `level_set` (may be null): curves across which data jump.
struct SpaceOptions {
  std::vector<bool> dirichlet;
  scene::FieldPtr level_set;
  MethodParams params;
};
using SpaceFactory = std::function<std::unique_ptr<Space>(const mesh::Mesh&, const SpaceOptions&)>;

}  // namespace thixis::method
