#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "thixis/method/space.hpp"

namespace thixis::method {

/// Local matrices: (element, i, j).
using LocalMatrices = Kokkos::View<double***, Kokkos::LayoutRight>;

/// A sum over elements, cells or faces: a(u, v) = sum_e a_e(u, v).
class ElementForm {
 public:
  virtual ~ElementForm() = default;
  /// A(k, i, j) = a_e(psi_j, psi_i) for the element e = first + k and its unknowns in their order; overwrites A. Throws on this rank only.
  virtual void matrices(LocalIndex first, const LocalMatrices& A) const = 0;
};

/// Elements with their form.
struct ElementSum {
  std::shared_ptr<const ElementForm> form;  ///< null: there are none
  ElementEntries entries;                   ///< (element, i)
  ElementUnknowns columns;                  ///< of these
};

/// Moments of a source against functions that are held, where no equation gives them: factor · moments(patch cell, l). Of length 0: none.
struct HeldSource {
  Kokkos::View<const double**, Kokkos::LayoutRight> moments;
  double factor = 1;
};

/// A known function, or one component of it. What is null counts as 0; forms ask for what their energy is made of.
struct Known {
  Gradient gradient;
  scene::FieldPtr value = nullptr;
};

/// The bilinear form a(u, v) of one equation on a space, as a local object: what it is on a cell, on a face, at the points of a cell. The
/// loops over the mesh are below. The space must outlive it.
class Form {
 public:
  explicit Form(const Space& space) : space_(space) {}
  virtual ~Form() = default;
  const Space& space() const { return space_; }

  virtual bool symmetric() const { return true; }  ///< a(u, v) = a(v, u)
  /// The part that is a sum over the patch cells, of Space::elements(): all of it where unknowns are interior to cells. Made for the
  /// quadrature that the space has now. Collective; throws InputError where coefficients of the form are not what they should be.
  virtual std::shared_ptr<const ElementForm> cells() const = 0;
  /// The part that is a sum over faces. Collective.
  virtual ElementSum faces() const { return {}; }
  /// F_l += what Dirichlet data exert that are imposed by the form. Throws on this rank only.
  virtual void add_weak_data(const BoundaryValues& boundary, double t, algebra::Vector& F) const;

  /// Sum over the first `cells` cells of the block of the energy ∫_K W(u - u_h), W that of the equation; `u` empty: of u_h. Throws on this
  /// rank only.
  virtual double energy(const QuadratureBlock& block, LocalIndex cells, const Coefficients& uh, const std::vector<Known>& u,
                        double t) const = 0;

  /// The flux -mu grad u as the method itself has it, in RT_q, q = Space::flux_degree(), in modal coefficients (reference::Modal, [2][dim
  /// P_{q+1}]) on the owned cells: with R = F - (-1)^alpha D lambda - a(u, ·) shared out as r,
  ///
  ///     (div sigma, v)_K = (f - (-1)^alpha lambda_h - r, v)_K      for all v in P_q(K),
  ///
  /// whatever u is; r has no moments against functions that are held, lambda_h those of `at_held`. sigma·n = -Π_q t on the Neumann
  /// boundary. `force` and `boundary`: the data that u_h belongs to. For forms on spaces that are not conforming. Collective.
  virtual void native_flux(const scene::Field& force, const Coefficients& u, const BoundaryValues& boundary, double t,
                           const HeldSource& at_held, const View<double**>& sigma) const;

 private:
  const Space& space_;
};
using FormPtr = std::shared_ptr<const Form>;

// -- the loops over the mesh, all of them collective ------------------------------------------------------------------------------------

/// A_lm = sum_e a_e(psi_m, psi_l) over the elements, l and m unknowns of theirs.
algebra::MatrixPtr assemble(const core::Comm& comm, const algebra::GraphPtr& graph, const ElementUnknowns& elements,
                            const ElementForm& form);
/// S_lm = a(psi_m, psi_l) on the unknowns.
algebra::MatrixPtr assemble(const Form& form);
/// y_l = a(u, psi_l), cell by cell without the assembled matrix.
void apply(const Form& form, const Coefficients& u, algebra::Vector& y);
/// F_l = (f, psi_l) + <t, psi_l> over the Neumann boundary + what weakly imposed Dirichlet data give.
void load(const Form& form, const Function& force, const BoundaryValues& boundary, double t, algebra::Vector& F);
/// The energy of u_h and of u - u_h, cell by cell: ∫ mu |grad u_h|² for diffusion.
double energy(const Form& form, const Coefficients& uh);
double energy_error(const Form& form, const Coefficients& uh, const std::vector<Known>& u, double t);

// -- forms that all methods have --------------------------------------------------------------------------------------------------------

/// The L² product of the functions in the cells, exactly: the mass of unknowns on faces is 0. Its energy is ∫ u².
FormPtr mass(const Space& space);
/// factor a_K(u, v) + weight (u, v)_K, cell by cell.
std::shared_ptr<const ElementForm> with_mass(const Space& space, const std::shared_ptr<const ElementForm>& form, double factor,
                                             double weight);

}  // namespace thixis::method
