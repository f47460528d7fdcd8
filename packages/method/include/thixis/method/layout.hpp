#pragma once
#include <functional>
#include <vector>

#include "thixis/algebra/fwd.hpp"
#include "thixis/method/data.hpp"
#include "thixis/method/numbering.hpp"
#include "thixis/reference/cell_basis.hpp"

namespace thixis::method {

class Space;
struct SpaceOptions;
using mesh::View;

/// (element, i) -> entry.
using ElementEntries = Kokkos::View<const LocalIndex**, Kokkos::LayoutRight>;

/// Where the coefficients of a space lie. **Patch cells** are those of method::patch_cells, by position: owned ones first. Of c components
/// each entry of the scalar space is c entries, c e + i: so are the functions of cells and faces.
struct Structure {
  Entries entries;
  /// (patch cell, i) -> entry. The first c dim P_p are the coefficients of the cell's polynomials in the order of reference::CellBasis;
  /// those of unknowns on faces may follow.
  Kokkos::View<LocalIndex**, Kokkos::LayoutRight> element_entries;
  /// Faces across which a form couples cells, with the entries of both: (face, i) -> entry, -1: none. Empty: no form does.
  View<LocalIndex*> coupled_faces;
  Kokkos::View<LocalIndex**, Kokkos::LayoutRight> coupled_entries;
  LocalIndex cell_entries = 0;          ///< entries that are coefficients of the cells' polynomials, and contact points: the first ones
  GlobalIndex global_cell_entries = 0;  ///< on all ranks, held ones included: their ids are 0 … global_cell_entries - 1
  int interior = 0;                     ///< of each element, for condensation: its first unknowns
};

/// The structure of all components from that of a scalar field, `scalar(options of that component)`.
Structure in_components(const SpaceOptions& options, const std::function<Structure(const SpaceOptions&)>& scalar);

/// What a method says of its functions, beside where their coefficients lie: held data, traces, multipliers, shares of cells. A space owns
/// one and asks it. By default functions are polynomials in the cells and nothing else, without continuity.
class Layout {
 public:
  virtual ~Layout() = default;
  virtual bool conforming() const { return false; }             ///< functions are continuous
  virtual bool nodal_multiplier() const { return false; }       ///< Space::pairing
  virtual int flux_degree(int degree) const { return degree; }  ///< Space::flux_degree

  /// Coefficients that the Dirichlet data fix, 0 elsewhere: those of the nodal interpolant. Collective.
  virtual Coefficients lift(const Space& space, const BoundaryValues& boundary, double t) const;
  /// F(l) += <t, trace of psi_l> over the faces whose tag has a function: the cells' traces. Throws on this rank only.
  virtual void add_traces(const Space& space, const std::vector<scene::FieldPtr>& by_tag, double t, algebra::Vector& F) const;
  /// What an interpolant is at unknowns that are no coefficients of cells. Collective.
  virtual void interpolate_traces(const Space& space, const Function& u, double t, algebra::Vector& values) const;
  /// Space::share: each cell of an unknown gets the same part. Collective.
  virtual void share(const Space& space, const algebra::Vector& R, const View<double**>& moments) const;
  /// Space::multiplier from moments: by the mass matrix of each cell. Collective.
  virtual Coefficients multiplier(const Space& space, const algebra::Vector& X3) const;

  /// An unknown on a face is the mean, over the cells that have it, of functionals of their polynomials: (q, l), flat, for the q-th
  /// function beyond those of the cell; where `backwards`, minus that.
  virtual std::vector<double> trace_functionals() const { return {}; }
  virtual bool backwards(const Space& space, LocalIndex patch_cell, int q) const;

 private:
  mutable View<int*> sharers_;  ///< cells of each unknown of this rank; made when a residual is first shared out
};

/// Tag of the Dirichlet data on each face: its own tag where that is held, -1 elsewhere. For vertices the lowest among their faces on this
/// rank.
std::vector<LocalIndex> held_faces(const mesh::Mesh& mesh, const std::vector<bool>& dirichlet);
std::vector<LocalIndex> held_vertices(const mesh::Mesh& mesh, const std::vector<bool>& dirichlet);

}  // namespace thixis::method
