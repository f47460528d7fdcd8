#include "thixis/hho/space.hpp"

#include "faces.hpp"
#include "flux.hpp"
#include "layout.hpp"
#include "reference_cell.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/mesh/to_view.hpp"

namespace thixis::hho {
namespace {

using algebra::Vector;
using Range = Kokkos::RangePolicy<Vector::execution_space>;
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
    const auto& held = space.numbering().held;
    const int c = space.components();
    space.mesh().comm.together([&] {
      for (std::size_t at = 0; at < boundary.dirichlet.size(); ++at) {
        if (!boundary.dirichlet[at]) continue;
        const int component = static_cast<int>(at) % c;
        const auto wanted =
            select(faces(space), [&](const Face& F) { return held[c * F.entry + component] == static_cast<LocalIndex>(at) / c; });
        const Projected on = project(space, faces(space), wanted, *boundary.dirichlet[at], t);
        Kokkos::parallel_for(
            "thixis::hho::lift", Kokkos::RangePolicy<>(0, on.size()), KOKKOS_LAMBDA(int e) {
              for (int k = 0; k < on.coefficient.extent_int(1); ++k) values(c * (on.entry(e) + k) + component) = on.coefficient(e, k);
            });
      }
    });
    return values;
  }

  /// <t, v_F>.
  void add_traces(const Space& space, const std::vector<scene::FieldPtr>& by_tag, double t, Vector& F) const override {
    const mesh::HostMesh& mesh = space.host();
    const int c = space.components();
    for (std::size_t at = 0; at < by_tag.size(); ++at) {
      if (!by_tag[at]) continue;
      const LocalIndex tag = static_cast<LocalIndex>(at) / c;
      const int component = static_cast<int>(at) % c;
      const Unknowns unknown(space, component);
      const auto wanted = select(faces(space), [&](const Face& face) { return mesh.face_tag(face.face) == tag && unknown(face); });
      const Projected on = project(space, faces(space), wanted, *by_tag[at], t);
      const Rows row(space, component);
      const auto out = F.getLocalViewDevice(Tpetra::Access::ReadWrite);
      Kokkos::parallel_for(
          "thixis::hho::add_traces", Range(0, on.size()), KOKKOS_LAMBDA(int e) {
            for (int k = 0; k < on.coefficient.extent_int(1); ++k)
              if (const LocalIndex l = row(on.entry(e), k); l >= 0) out(l, 0) += on.length(e) * on.coefficient(e, k);
          });
    }
  }

  /// On faces the projection of u.
  void interpolate_traces(const Space& space, const method::Function& u, double t, Vector& values) const override {
    space.mesh().comm.together([&] {
      for (int component = 0; component < space.components(); ++component) {
        const auto wanted = select(faces(space), Unknowns(space, component));
        const Projected on = project(space, faces(space), wanted, u[component], t);
        const Rows row(space, component);
        const auto out = values.getLocalViewDevice(Tpetra::Access::ReadWrite);
        Kokkos::parallel_for(
            "thixis::hho::interpolate_traces", Range(0, on.size()), KOKKOS_LAMBDA(int e) {
              for (int k = 0; k < on.coefficient.extent_int(1); ++k)
                if (const LocalIndex l = row(on.entry(e), k); l >= 0) out(l, 0) = on.coefficient(e, k);
            });
      }
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
  /// The row of a component of a function of a face, -1 where it is held or of another rank.
  class Rows {
   public:
    Rows(const Space& space, int component)
        : components_(space.components()),
          component_(component),
          rows_(algebra::local_size(*space.map())),
          column_(space.numbering().column_of_entry) {}
    KOKKOS_FUNCTION LocalIndex operator()(LocalIndex entry, int j) const {
      const LocalIndex column = column_(components_ * (entry + j) + component_);
      return column < rows_ ? column : -1;
    }

   private:
    int components_, component_;
    LocalIndex rows_;
    View<const LocalIndex*> column_;
  };

  /// Whether there are such rows.
  class Unknowns {
   public:
    Unknowns(const Space& space, int component)
        : components_(space.components()),
          component_(component),
          rows_(algebra::local_size(*space.map())),
          column_(Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.numbering().column_of_entry)) {}
    bool operator()(const Face& F) const {
      const LocalIndex column = column_(components_ * F.entry + component_);
      return column >= 0 && column < rows_;
    }

   private:
    int components_, component_;
    LocalIndex rows_;
    mesh::ConstHostView<const LocalIndex*> column_;
  };

  const std::vector<Face>& faces(const Space& space) const {
    if (faces_.empty()) faces_ = faces_of(space);
    return faces_;
  }

  ReferenceCell reference_;
  mutable std::vector<Face> faces_;  ///< of the patch cells; these two are made when first asked for
  mutable mesh::ConstHostView<const LocalIndex*> cells_;
};

}  // namespace

std::unique_ptr<Space> make_space(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  const reference::CellBasis basis(options.params.degree, method::family(options.params.nodes));
  auto structure = method::in_components(options, [&](const method::SpaceOptions& scalar) { return layout(mesh, scalar); });
  return std::make_unique<Space>(mesh, options, std::move(structure), std::make_unique<HybridLayout>(basis));
}

}  // namespace thixis::hho
