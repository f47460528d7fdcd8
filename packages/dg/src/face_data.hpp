#pragma once
#include <vector>

#include "face_form.hpp"

/// Data at the points of faces.
namespace thixis::dg {

/// The traces of a tension on faces.
class FaceTension {
 public:
  /// All must outlive it.
  FaceTension(const method::Space& space, const Faces& faces, const Traces& traces, const scene::Field& tension);
  /// mu(e, q, s), e < count, on the faces first + e; overwritten by the next call. Throws on this rank only.
  const Tensions& at(LocalIndex first, LocalIndex count);

 private:
  void evaluate(LocalIndex first, LocalIndex count);

  const method::Space& space_;
  const Faces& faces_;
  const Traces& traces_;
  const scene::Field& tension_;
  Tensions mu_;
};

/// The rule of traces for a tension.
Traces traces_for(const method::Space& space, const scene::Field& tension);

/// Points of the rule on the faces with a tag of owned cells, and the same a little inside.
struct BoundaryPoints {
  std::vector<LocalIndex> faces;
  std::vector<double> x, y, inside_x, inside_y;  ///< (face, q)

  BoundaryPoints(const method::Space& space, LocalIndex tag, const Traces& traces);
  std::vector<double> values(const scene::Field& field, double t) const;
  std::vector<double> values_inside(const scene::Field& field) const;
};

/// F_l += what Dirichlet data g on this tag exert, - theta (mu grad(psi_l)·n, g)_F + (eta p²/|F|) (mu g, psi_l)_F.
void add_weakly(const method::Space& space, const Penalty& penalty, const scene::Field& tension, const scene::Field& g, LocalIndex tag,
                double t, algebra::Vector& F);

}  // namespace thixis::dg
