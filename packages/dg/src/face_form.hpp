#pragma once
#include <vector>

#include "thixis/mesh/geometry.hpp"
#include "thixis/method/form.hpp"
#include "thixis/reference/cell_basis.hpp"

namespace thixis::dg {

using mesh::View;
using Matrices = method::LocalMatrices;

/// Traces of the basis on the faces of the reference cell at the points of a line rule. Side 2 f: along the face f from vertex f+1 to f+2;
/// side 2 f + 1: backwards.
struct Traces {
  View<const double*> t, weight;                                      ///< rule on [0, 1]
  Kokkos::View<const double***, Kokkos::LayoutRight> value;           ///< (side, q, i): psi_i
  Kokkos::View<const double*** [3], Kokkos::LayoutRight> derivative;  ///< (side, q, i, a): ∂psi_i/∂lambda_a
  Kokkos::View<const int**, Kokkos::LayoutRight> on_face;             ///< (f, 0 … p): the functions that do not vanish on f

  int points() const { return t.extent_int(0); }
};
Traces traces(const reference::CellBasis& basis, int order);

/// Faces that carry a form, with the cells K+ (whose outward normal is the face normal) and K-, as local cells; -1: none.
struct Faces {
  View<const LocalIndex*> face;
  View<const LocalIndex*[2]> cell, side;  ///< side: index into Traces, seen from the lower vertex id to the higher one
};

Faces faces_of(const mesh::Mesh& mesh, const View<const LocalIndex*>& face);

/// (e, q, s): trace of the tension from K+ and K- at the points of the faces; on the boundary both are that of the one cell.
using Tensions = Kokkos::View<double** [2], Kokkos::LayoutRight>;

struct Penalty {
  double theta;  ///< 1 SIPG, -1 NIPG
  double eta;    ///< eta p²: the factor of mu_F/|F|
};

/// A(e, i, j), i, j < 2n, on the faces first + e: the functions of K+ come first,
///
///     - ({mu grad psi_j}·n, [psi_i])_F - theta ({mu grad psi_i}·n, [psi_j])_F + (eta p²/|F|) (mu_F [psi_j], [psi_i])_F,
///
/// mean and jump being the trace itself on the boundary, mu_F the larger one of the two traces of the tension mu.
void face_matrices(const mesh::Mesh& mesh, const Faces& faces, const Traces& traces, const Penalty& penalty, LocalIndex first,
                   const Tensions& mu, const Matrices& A);

}  // namespace thixis::dg
