#pragma once
#include "thixis/bound/guaranteed_bound.hpp"

namespace thixis::bound {

/// The bound of the literature for continuous finite elements (docs/methods/estimates.md, 6; Dabaghi, Martin, Vohralik, J. Sci. Comput. 84,
/// 2020, doi:10.1007/s10915-020-01264-3), whose multiplier is that of the discrete solution and whose remainders carry global constants.
struct PublishedBound {
  complementarity::Estimate parts;
  double flux = 0, residual = 0;        ///< (sum_K sum_alpha eta_F²)^{1/2}, with eta_R likewise
  double contact = 0;                   ///< |2 (lambda^pos, u_1 - u_2)|^{1/2}
  double nonconformity[3] = {0, 0, 0};  ///< |||s - u_h|||, C |lambda^neg|, 2 C |lambda^pos| |||s - u_h|||
};

/// `gap`: u_1 - u_2 (u - psi_h) as a function of the space; `friedrichs`: h_Omega C_PF, |v| <= h_Omega C_PF |grad v| for v that vanish
/// where the membranes are held. Conforming spaces only. Collective.
PublishedBound published_bound(const method::Space& space, const ContactProblem& problem, const mesh::Hierarchy& hierarchy, int level,
                               const Iterate& iterate, const method::Coefficients& gap, double friedrichs);

/// 1/(pi (a^{-2} + b^{-2})^{1/2}) for the box a × b around the mesh: a Friedrichs constant where the whole boundary is held. Collective.
double friedrichs_of_box(const mesh::Mesh& mesh);

}  // namespace thixis::bound
