#pragma once
#include <Kokkos_Core.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "thixis/mesh/host.hpp"
#include "thixis/method/graph.hpp"
#include "thixis/method/layout.hpp"
#include "thixis/method/params.hpp"
#include "thixis/method/quadrature.hpp"
#include "thixis/output/fields.hpp"

namespace thixis::method {

/// The family of nodes that the deck asks for.
reference::Family family(Nodes nodes);

/// Where a space takes Dirichlet data: one flag per tag of the mesh and component, c tag + i. `level_set` (may be null): curves across
/// which data jump.
struct SpaceOptions {
  std::vector<bool> dirichlet;
  scene::FieldPtr level_set;
  MethodParams params;
  int components = 1;
};

/// Functions on one mesh that are polynomials of degree p in every cell, of one or more components: lays out their unknowns, and the
/// pairing of a multiplier with the gap. Equations are Forms on it (thixis/method/form.hpp); scenes know no basis function.
///
/// **Contact points** are the first unknowns of each rank (all of them, but for methods that have unknowns on faces besides): gap and
/// multiplier have one value for each of their basis functions psi_l.
class Space {
 public:
  /// `structure`: of all components. The mesh must outlive the space. Collective.
  Space(const mesh::Mesh& mesh, const SpaceOptions& options, Structure structure, std::unique_ptr<const Layout> layout);
  ~Space();
  Space(const Space&) = delete;
  Space& operator=(const Space&) = delete;

  const mesh::Mesh& mesh() const { return mesh_; }
  const mesh::HostMesh& host() const { return host_; }  ///< the mesh where the host can read it
  const SpaceOptions& options() const { return options_; }
  int components() const { return options_.components; }
  algebra::MapPtr map() const { return numbering_.rows; }  ///< of the unknowns; Dirichlet values are none
  algebra::MapPtr points() const { return points_; }       ///< of the contact points; map() itself where all unknowns are such
  /// The identity of each unknown of this rank, in the order of map(): >= 0, different for different unknowns of the space, and, unlike
  /// the numbers of map(), the same on any number of ranks, so that a checkpoint can name them. From the ids of mesh entities, with
  /// n unknowns per entity: n id + k for the k-th one of it; kinds of entities follow each other (vertices, faces, cells), each range
  /// beginning where that of all entities before ends. k is counted along what does not depend on the ranks either: along a face from
  /// its lower to its higher vertex id, in a cell by its basis. Ids of Dirichlet nodes are not used.
  std::vector<GlobalIndex> unknown_ids() const;
  const algebra::GraphPtr& graph() const { return graph_; }      ///< couplings of forms: columns sorted, those of this rank first
  Teuchos::RCP<const algebra::MultiVector> coordinates() const;  ///< two columns, of the unknowns' places
  /// For condensation: columns of graph() of the unknowns of each patch cell, -1 for Dirichlet values; the first interior() of them belong
  /// to this cell alone.
  const ElementUnknowns& elements() const { return elements_; }
  int interior() const { return structure_.interior; }
  const ElementUnknowns& coupled() const { return coupled_; }  ///< columns of Structure::coupled_entries

  /// From now on integrals of data follow the curves across which these jump at time t: loads, moments of multipliers, errors. Collective;
  /// throws InputError as make_quadrature does.
  void move_interface(double t);

  // -- functions --------------------------------------------------------------------------------------------------------------------
  bool conforming() const { return layout_->conforming(); }  ///< whether they are continuous
  /// q: fluxes of forms lie in RT_q, as functions test against P_q in the cells and on the faces.
  int flux_degree() const { return layout_->flux_degree(basis_.degree()); }
  /// Coefficients of the lift of the Dirichlet data: what they fix, 0 elsewhere. Collective.
  Coefficients lift(const BoundaryValues& boundary, double t) const { return layout_->lift(*this, boundary, t); }
  /// u + lift: a collective operation (ghost values are fetched).
  Coefficients complete(const algebra::Vector& u, const Coefficients& lift) const;
  algebra::Vector with_ghosts(const algebra::Vector& u) const;  ///< on the columns of graph(). Collective.
  /// The inverse: the unknowns' part.
  void restrict_to_unknowns(const Coefficients& u, algebra::Vector& values) const;
  /// The interpolant of a function: nodal in the cells, projected on faces. Collective.
  void interpolate(const Function& u, double t, algebra::Vector& values) const;
  /// The coefficients of an obstacle: of its interpolant, and where it jumps inside a cell of what thixis/method/jumps.hpp makes of that.
  void interpolate_obstacle(const scene::Field& psi, algebra::Vector& values) const;

  // -- functionals ------------------------------------------------------------------------------------------------------------------
  /// F(l) += (f, psi_l) for the cells' basis functions; F is on map() or points(). Throws on this rank only.
  void add_moments(const Function& f, double t, algebra::Vector& F) const;
  /// F(l) += <t, trace of psi_l> over the faces whose tag has a function. Throws on this rank only.
  void add_traces(const std::vector<scene::FieldPtr>& by_tag, double t, algebra::Vector& F) const {
    layout_->add_traces(*this, by_tag, t, F);
  }
  /// Shares a functional R out to the cells: moments(k, l) = (r, psi_l)_K on patch cell k, so that the sum over the cells of each unknown
  /// is R_l; an unknown that cells share gives each of them the same part, one on a face by its test function there. Collective.
  void share(const algebra::Vector& R, const View<double**>& moments) const { layout_->share(*this, R, moments); }

  // -- the multiplier, X3 on points(), of scalar spaces -----------------------------------------------------------------------------
  /// D_l > 0 with <lambda, psi_l> = D_l X3_l, on points(): (psi_l, 1) for nodal multipliers, 1 for moments.
  const algebra::Vector& pairing() const { return *pairing_; }
  bool nodal_multiplier() const { return layout_->nodal_multiplier(); }
  /// lambda_h as a function: the nodal values, or sum_l X3_l Theta_l in the dual basis, moments at fixed nodes being 0. Collective.
  Coefficients multiplier(const algebra::Vector& X3) const;
  /// X3 of a known function: its nodal values or moments. Collective.
  void interpolate_multiplier(const scene::Field& lambda, double t, algebra::Vector& X3) const;

  // -- what forms and error estimates read ------------------------------------------------------------------------------------------
  const reference::CellBasis& basis() const { return basis_; }
  const View<const LocalIndex*>& cells() const { return cells_; }         ///< patch cells, the owned ones first
  LocalIndex position(LocalIndex cell) const { return position_[cell]; }  ///< among them, -1 for others
  const CellQuadrature& quadrature() const { return quadrature_; }        ///< on them
  const Structure& coefficients() const { return structure_; }
  const Numbering& numbering() const { return numbering_; }
  const Layout& layout() const { return *layout_; }
  /// Values at the places of these entries. Throws on this rank only.
  std::vector<double> at_entries(const scene::Field& field, const std::vector<LocalIndex>& entries, double t) const;

  // -- for output -------------------------------------------------------------------------------------------------------------------
  /// Triangles with one point per coefficient of the polynomials, of one component, in the cells.
  output::Grid display() const;
  /// u_h at the points of the display, and the coefficient that belongs to each point. Ghosts may be 0.
  std::vector<double> shown(const Coefficients& u, int component = 0) const;
  std::vector<double> coefficients_shown(const Coefficients& u, int component = 0) const;

 private:
  const mesh::Mesh& mesh_;
  mesh::HostMesh host_;
  SpaceOptions options_;
  std::unique_ptr<const Layout> layout_;
  reference::CellBasis basis_;
  Structure structure_;
  Numbering numbering_;
  View<const LocalIndex*> cells_;
  std::vector<LocalIndex> position_;
  CellQuadrature quadrature_;
  ElementUnknowns elements_, coupled_;
  algebra::GraphPtr graph_;
  algebra::MapPtr points_;
  Teuchos::RCP<const algebra::Vector> pairing_;
};

using SpaceFactory = std::function<std::unique_ptr<Space>(const mesh::Mesh&, const SpaceOptions&)>;
/// Throws InputError, on all ranks, for a mesh on which the method can not be trusted. Collective. May be empty.
using MeshCheck = std::function<void(const mesh::Mesh&, const SpaceOptions&)>;

}  // namespace thixis::method
