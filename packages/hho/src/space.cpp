#include "thixis/hho/space.hpp"

#include "faces.hpp"
#include "flux.hpp"
#include "layout.hpp"
#include "reference_cell.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/mesh/geometry.hpp"

namespace thixis::hho {
namespace {

using algebra::Vector;
using method::BoundaryValues;
using method::Coefficients;
using method::Space;

/// Unknowns on faces besides those in the cells.
class HybridLayout final : public method::Layout {
 public:
  explicit HybridLayout(const reference::CellBasis& basis) : reference_(reference_cell(basis)) {}

  int flux_degree(int degree) const override { return degree - 1; }

  Coefficients lift(const Space& space, const BoundaryValues& boundary, double t) const override {
    const Coefficients values("thixis::hho::lift", space.coefficients().entries.size());
    const auto host = Kokkos::create_mirror_view(values);
    const auto& held = space.numbering().held;
    const int c = space.components();
    space.mesh().comm.together([&] {
      for (std::size_t at = 0; at < boundary.dirichlet.size(); ++at) {
        if (!boundary.dirichlet[at]) continue;
        const int component = static_cast<int>(at) % c;
        project(
            space, faces(space), *boundary.dirichlet[at], t,
            [&](const Face& F) { return held[c * F.entry + component] == static_cast<LocalIndex>(at) / c; },
            [&](const Face& F, int j, double coefficient) { host(c * (F.entry + j) + component) = coefficient; });
      }
    });
    Kokkos::deep_copy(values, host);
    return values;
  }

  /// <t, v_F>.
  void add_traces(const Space& space, const std::vector<scene::FieldPtr>& by_tag, double t, Vector& F) const override {
    const mesh::HostMesh& mesh = space.host();
    const auto out = algebra::host_view(F);
    const Rows row(space);
    const int c = space.components();
    for (std::size_t at = 0; at < by_tag.size(); ++at) {
      if (!by_tag[at]) continue;
      const int component = static_cast<int>(at) % c;
      project(
          space, faces(space), *by_tag[at], t,
          [&](const Face& face) { return mesh.face_tag(face.face) == static_cast<LocalIndex>(at) / c && row(face, 0, component) >= 0; },
          [&](const Face& face, int j, double coefficient) {
            out(row(face, j, component)) += mesh::face_geometry(mesh.coordinates, mesh.face_vertices, face.face).length * coefficient;
          });
    }
  }

  /// On faces the projection of u.
  void interpolate_traces(const Space& space, const method::Function& u, double t, Vector& values) const override {
    space.mesh().comm.together([&] {
      const auto out = algebra::host_view(values);
      const Rows row(space);
      for (int component = 0; component < space.components(); ++component)
        project(
            space, faces(space), u[component], t, [&](const Face& F) { return row(F, 0, component) >= 0; },
            [&](const Face& F, int j, double coefficient) { out(row(F, j, component)) = coefficient; });
    });
  }

  void share(const Space& space, const Vector& R, const View<double**>& moments) const override {
    const Coefficients nothing("thixis::hho::nothing", space.coefficients().entries.size());
    hho::share(space.mesh(), reference_, space.options().params, space.cells(), space.coefficients().element_entries,
               space.complete(R, nothing), moments);
  }

  std::vector<double> trace_functionals() const override {
    std::vector<double> functionals;
    for (const auto& R : reference_.R)
      for (int j = 0; j < reference_.degree; ++j)
        functionals.insert(functionals.end(), &R[j * reference_.unknowns], &R[j * reference_.unknowns] + reference_.functions);
    return functionals;
  }

  /// Functions of odd degree, where the face runs from vertex f+2 to f+1.
  bool backwards(const Space& space, LocalIndex k, int q) const override {
    const mesh::HostMesh& mesh = space.host();
    if (cells_.extent(0) == 0) cells_ = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.cells());
    const LocalIndex K = cells_(k), f = q / reference_.degree;
    return q % reference_.degree % 2 == 1 && mesh.face_vertices(mesh.cell_faces(K, f), 0) != mesh.cell_vertices(K, (f + 1) % 3);
  }

 private:
  /// The row of a function of a face, -1 where it is held or of another rank.
  class Rows {
   public:
    explicit Rows(const Space& space)
        : components_(space.components()),
          rows_(algebra::local_size(*space.map())),
          column_(Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.numbering().column_of_entry)) {}
    LocalIndex operator()(const Face& F, int j, int component) const {
      const LocalIndex column = column_(components_ * (F.entry + j) + component);
      return column < rows_ ? column : -1;
    }

   private:
    int components_;
    LocalIndex rows_;
    View<LocalIndex*>::HostMirror column_;
  };

  const std::vector<Face>& faces(const Space& space) const {
    if (faces_.empty()) faces_ = faces_of(space);
    return faces_;
  }

  ReferenceCell reference_;
  mutable std::vector<Face> faces_;  ///< of the patch cells; these two are made when first asked for
  mutable Kokkos::View<const LocalIndex*, Kokkos::LayoutRight, Kokkos::HostSpace> cells_;
};

}  // namespace

std::unique_ptr<Space> make_space(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  const reference::CellBasis basis(options.params.degree, method::family(options.params.nodes));
  auto structure = method::in_components(options, [&](const method::SpaceOptions& scalar) { return layout(mesh, scalar); });
  return std::make_unique<Space>(mesh, options, std::move(structure), std::make_unique<HybridLayout>(basis));
}

}  // namespace thixis::hho
