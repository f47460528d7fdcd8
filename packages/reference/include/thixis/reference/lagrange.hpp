#pragma once
#include <vector>

namespace thixis::reference {

/// Where the nodes of a Lagrange basis lie.
enum class Nodes {
  equispaced,    ///< the lattice of multiples of 1/p
  gauss_lobatto  ///< Gauss–Lobatto points on the faces; the interior nodes of p = 4 at barycentric (c, c, 1-2c), c = 0.2169
};

/// The part of the cell on which a node lies.
enum class Entity { vertex, face, interior };

struct NodeEntity {
  Entity kind;
  int index;  ///< local vertex or face (face i opposite vertex i); 0 inside
};

/// Values and reference gradients of all basis functions at some points.
struct Tabulation {
  int points = 0, functions = 0;
  std::vector<double> value;     ///< flat [point][function]
  std::vector<double> gradient;  ///< flat [point][function][2], derivatives in xi and eta
};

/// Lagrange basis psi_l of P_p, p = 1…4, on the triangle with vertices 0 (0,0), 1 (1,0), 2 (0,1): psi_l(node m) = delta_lm.
///
/// The nodes are numbered by entity: vertices 0, 1, 2; then the p-1 nodes of faces 0, 1, 2, those of face i from vertex i+1 to vertex
/// i+2 (mod 3); then those inside. The nodes of two cells on a common face coincide; seen from both they run in opposite directions.
/// gauss_lobatto gives bases without negative means (docs/methods/fem.md).
class LagrangeBasis {
 public:
  /// Throws InputError unless 1 <= degree <= 4.
  LagrangeBasis(int degree, Nodes nodes);

  int degree() const { return degree_; }
  int size() const { return static_cast<int>(entities_.size()); }        ///< (p+1)(p+2)/2
  const std::vector<double>& points() const { return points_; }          ///< flat [node][2]
  const std::vector<NodeEntity>& entities() const { return entities_; }  ///< of every node
  const std::vector<double>& integrals() const { return integrals_; }    ///< (psi_l, 1) on the reference triangle; they sum to 1/2

  /// At `count` points, flat [count][2].
  Tabulation tabulate(int count, const double* points) const;

 private:
  int degree_;
  std::vector<double> points_;
  std::vector<NodeEntity> entities_;
  std::vector<double> coefficients_;  ///< flat [orthonormal][node]: inverse of the Vandermonde matrix phi_k(node m)
  std::vector<double> integrals_;
};

}  // namespace thixis::reference
