#include <optional>

#include "cell_form.hpp"
#include "faces.hpp"
#include "flux.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/hho/space.hpp"
#include "thixis/method/gradient_form.hpp"

namespace thixis::hho {
namespace {

using method::BoundaryValues;
using method::Coefficients;

class Diffusion final : public method::Form {
 public:
  Diffusion(const method::Space& space, scene::FieldPtr tension)
      : Form(space), tension_(std::move(tension)), reference_(reference_cell(space.basis())) {}

  std::shared_ptr<const method::ElementForm> cells() const override {
    return cell_form(space().mesh(), space().quadrature(), reference_, space().options().params, *tension_);
  }

  double energy(const method::QuadratureBlock& block, LocalIndex cells, const Coefficients& uh, const std::vector<method::Known>& u,
                double t) const override {
    return method::gradient_energy(space(), *tension_, block, cells, uh, u, t);
  }

  void native_flux(const scene::Field&, const Coefficients& u, const BoundaryValues& boundary, double t, const method::HeldSource&,
                   const View<double**>& sigma) const override {
    if (!tables_) tables_.emplace(space(), reference_);
    const mesh::Mesh& mesh = space().mesh();
    const auto density = method::flux_density(mesh, space().quadrature(), space().basis().degree() - 1, *tension_);
    hho::native_flux(mesh, reference_, tables_->flux, space().options().params, density,
                     {tables_->row, tables_->neighbour, tractions(boundary.neumann, t)}, space().coefficients().element_entries, u,
                     mesh.owned_cells, sigma);
  }

 private:
  /// What the flux needs of the mesh.
  struct Tables {
    FluxTables flux;
    std::vector<Face> faces;
    View<const LocalIndex*[3]> row, neighbour;  ///< FaceData of the patch cells; rows are positions in faces

    Tables(const method::Space& space, const ReferenceCell& reference) : flux(flux_tables(reference)), faces(faces_of(space)) {
      const mesh::HostMesh& mesh = space.host();
      const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.coefficients().element_entries);
      const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.cells());
      const View<LocalIndex*[3]> rows("thixis::hho::face_rows", cells.extent(0)), across("thixis::hho::neighbours", cells.extent(0));
      const auto row_host = Kokkos::create_mirror_view(rows), across_host = Kokkos::create_mirror_view(across);
      const int n = space.basis().size(), p = space.basis().degree();
      for (int k = 0; k < cells.extent_int(0); ++k)
        for (int f = 0; f < 3; ++f) {
          const LocalIndex F = mesh.cell_faces(cells(k), f), entry = entries(k, n + f * p);
          const LocalIndex other = mesh::neighbour(mesh.face_cells, F, cells(k));
          row_host(k, f) = mesh.face_tag(F) < 0                 ? face_inside
                           : space.numbering().held[entry] >= 0 ? face_held
                                                                : (entry - space.coefficients().cell_entries) / p;
          across_host(k, f) = other < 0 ? -1 : space.position(other);
        }
      Kokkos::deep_copy(rows, row_host);
      Kokkos::deep_copy(across, across_host);
      row = rows;
      neighbour = across;
    }
  };

  Moments tractions(const std::vector<scene::FieldPtr>& by_tag, double t) const {
    const std::vector<Face>& faces = tables_->faces;
    const Moments traction("thixis::hho::traction", faces.size(), space().basis().degree());
    space().mesh().comm.together([&] {
      for (std::size_t tag = 0; tag < by_tag.size(); ++tag) {
        if (!by_tag[tag]) continue;
        const auto wanted = select(faces, [&](const Face& F) { return space().host().face_tag(F.face) == static_cast<LocalIndex>(tag); });
        const Projected on = project(space(), faces, wanted, *by_tag[tag], t);
        Kokkos::parallel_for(
            "thixis::hho::tractions", Kokkos::RangePolicy<>(0, on.size()), KOKKOS_LAMBDA(int e) {
              for (int k = 0; k < on.coefficient.extent_int(1); ++k) traction(on.number(e), k) = on.coefficient(e, k);
            });
      }
    });
    return traction;
  }

  scene::FieldPtr tension_;
  ReferenceCell reference_;
  mutable std::optional<Tables> tables_;  ///< made when a flux is first asked for
};

}  // namespace

method::FormPtr diffusion(const method::Space& space, const scene::FieldPtr& tension) {
  THIXIS_ASSERT_EQ(space.components(), 1, "diffusion is of scalar fields");
  return std::make_shared<Diffusion>(space, tension);
}

}  // namespace thixis::hho
