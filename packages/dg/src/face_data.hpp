#pragma once
#include "face_form.hpp"

/// Data at the points of faces.
namespace thixis::dg {

using PointValues = View<double*>;  ///< (face, q), flat

/// Points of the rule on faces: (face, q), flat.
struct FacePoints {
  PointValues x, y;
  FacePoints() = default;
  explicit FacePoints(std::size_t count) : x("thixis::dg::face_x", count), y("thixis::dg::face_y", count) {}
  int size() const { return x.extent_int(0); }
  /// Throws on this rank only.
  PointValues values(const scene::Field& field, double t) const;
};
constexpr int on_face = -1;  ///< a side of `place`
/// points <- those of the rule on the faces first + e, e < count, from the lower to the higher vertex id. side: on_face, or so little
/// inside K+ (0), K- (1), or the one cell of the face, that a function which jumps across F shows its trace from there.
void place(const mesh::Mesh& mesh, const Faces& faces, const Traces& traces, int side, LocalIndex first, LocalIndex count,
           const FacePoints& points);

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
  FacePoints points_;
  PointValues values_;
  Tensions mu_;
};

/// The rule of traces for a tension.
Traces traces_for(const method::Space& space, const scene::Field& tension);

/// The faces with a tag of owned cells, with the values of boundary data and the trace of a tension at the points of the rule on them.
struct BoundaryData {
  Faces faces;
  PointValues data, mu;

  LocalIndex size() const { return faces.face.extent_int(0); }
};
/// `tension`: null for a trace of 1. Throws on this rank only.
BoundaryData boundary_data(const method::Space& space, LocalIndex tag, const Traces& traces, const scene::Field& data, double t,
                           const scene::Field* tension);

/// F_l += what Dirichlet data g on this tag exert, - theta (mu grad(psi_l)·n, g)_F + (eta p²/|F|) (mu g, psi_l)_F.
void add_weakly(const method::Space& space, const Penalty& penalty, const scene::Field& tension, const scene::Field& g, LocalIndex tag,
                double t, algebra::Vector& F);

}  // namespace thixis::dg
