#pragma once
#include <array>
#include <vector>

#include "thixis/algebra/fwd.hpp"
#include "thixis/method/form.hpp"

namespace thixis::dg {

/// Where nodes are held, no equation tells how much flux passes: what is missing to the balance of a cell K against the functions psi_l of
/// its held nodes,
///
///     e_Kl = (f + s - div sigma, psi_l)_K,      s a further source (contact),
///
/// is let out through the boundary (docs/methods/dg.md, 4). With Theta_l the functions dual to psi_l on a face F,
///
///     nodes inside a held face F:   sigma·n_F grows by e_Kl Theta_l;
///     held vertices a:              the faces F_0 … F_m around a, of which the first and the last lie on the boundary, carry x_i Theta_a
///     from
///                                   one cell K_i to the next, x_{i+1} - x_i = e_{K_i a}, x = 0 on boundary faces that are not held;
///                                   where both are held, the x of the least sum of squares.
class HeldBoundary {
 public:
  /// `dirichlet`: the tags whose faces are held. The space must outlive this. Collective.
  HeldBoundary(const method::Space& space, const std::vector<bool>& dirichlet);
  /// Adds to sigma on the owned cells. Collective.
  void balance(const scene::Field& force, double t, const method::HeldSource& source, const method::View<double**>& sigma) const;

 private:
  /// A patch cell with held nodes.
  struct Cell {
    LocalIndex position;                ///< among the patch cells
    std::vector<bool> held;             ///< [n]
    std::array<bool, 3> boundary_held;  ///< whether its face f lies on the held boundary
  };
  /// The cells around a held vertex, counter-clockwise, by place in cells_, and the number that the vertex has in each.
  struct Fan {
    std::vector<std::size_t> cells;
    std::vector<int> vertex;
    bool first_held = false, last_held = false;  ///< the boundary faces at both ends
  };

  void collect_cells(const std::vector<bool>& dirichlet);
  void collect_fans();
  Fan fan_around(LocalIndex K, int vertex, const std::vector<std::size_t>& place) const;
  void tabulate();
  /// e_Kl of the owned cells, [cell][n]; 0 for functions that are not held. Throws on this rank only.
  std::vector<double> defects(const scene::Field& force, double t, const method::HeldSource& source, const double* sigma) const;
  /// The same of all cells_. Collective.
  std::vector<double> fetched(const std::vector<double>& own) const;
  /// x_0 … x_m of a vertex.
  static std::vector<double> passing(const Fan& fan, const std::vector<double>& e);
  /// The normal flux x Theta_l, outward, through the face f of an owned cell; nothing for others.
  void let_out(double x, const Cell& cell, int f, int l, double* sigma) const;

  bool owned(const Cell& cell) const { return cell.position < space_.mesh().owned_cells; }

  const method::Space& space_;
  mesh::HostMesh host_;
  int functions_, width_;  ///< n; coefficients of a flux
  std::vector<Cell> cells_;
  std::size_t owned_ = 0;  ///< so many of them, the first ones
  std::vector<Fan> fans_;  ///< around held vertices of owned cells
  std::array<int, 3> function_of_vertex_{};
  std::vector<double> divergence_;  ///< (n × width): sigma -> (div sigma, psi_l)_K
  std::vector<double> dual_;        ///< (3 n × width), row f n + l: the field with normal flux Theta_l on face f, for l on f
  Teuchos::RCP<const algebra::Import> import_;
};

}  // namespace thixis::dg
