#include <optional>

#include "face_data.hpp"
#include "flux.hpp"
#include "held_boundary.hpp"
#include "layout.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/dg/params.hpp"
#include "thixis/dg/space.hpp"
#include "thixis/method/gradient_form.hpp"

namespace thixis::dg {
namespace {

using method::BoundaryValues;
using method::Coefficients;

class FaceForm final : public method::ElementForm {
 public:
  FaceForm(const method::Space& space, const View<const LocalIndex*>& face, const Penalty& penalty, scene::FieldPtr tension)
      : mesh_(space.mesh()),
        penalty_(penalty),
        tension_(std::move(tension)),
        faces_(faces_of(mesh_, face)),
        traces_(traces_for(space, *tension_)),
        mu_(space, faces_, traces_, *tension_) {}
  void matrices(LocalIndex first, const Matrices& A) const override {
    face_matrices(mesh_, faces_, traces_, penalty_, first, mu_.at(first, A.extent_int(0)), A);
  }

 private:
  const mesh::Mesh& mesh_;
  Penalty penalty_;
  scene::FieldPtr tension_;
  Faces faces_;
  Traces traces_;
  mutable FaceTension mu_;
};

class Diffusion final : public method::Form {
 public:
  Diffusion(const method::Space& space, scene::FieldPtr tension) : Form(space), tension_(std::move(tension)) {
    const auto& params = space.options().params;
    const Params& own = params.own.get<Params>();
    penalty_ = {own.variant == Variant::sipg ? 1.0 : -1.0, own.penalty * params.degree * params.degree};
    const auto faces = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.coefficients().coupled_faces);
    const auto count = [&](LocalIndex from, FaceRole wanted) {
      LocalIndex k = from;
      while (k < faces.extent_int(0) && role(space.host().face_tag(faces(k)), space.options()) == wanted) ++k;
      return k;
    };
    end_of_form_ = count(0, FaceRole::form);
    end_of_held_ = count(end_of_form_, FaceRole::held);
  }

  bool symmetric() const override { return penalty_.theta > 0; }

  std::shared_ptr<const method::ElementForm> cells() const override {
    return method::gradient_form(space().mesh(), space().quadrature(), space().basis(), *tension_);
  }

  method::ElementSum faces() const override {
    const std::pair range(0, end_of_form_);
    return {std::make_shared<FaceForm>(space(), faces_in(range), penalty_, tension_), entries_in(range),
            Kokkos::subview(space().coupled(), range, Kokkos::ALL)};
  }

  void add_weak_data(const BoundaryValues& boundary, double t, algebra::Vector& F) const override {
    if (strong(space().options())) return;
    for (std::size_t tag = 0; tag < boundary.dirichlet.size(); ++tag)
      if (boundary.dirichlet[tag]) add_weakly(space(), penalty_, *tension_, *boundary.dirichlet[tag], static_cast<LocalIndex>(tag), t, F);
  }

  double energy(const method::QuadratureBlock& block, LocalIndex cells, const Coefficients& uh, const std::vector<method::Known>& u,
                double t) const override {
    return method::gradient_energy(space(), *tension_, block, cells, uh, u, t);
  }

  void native_flux(const scene::Field& force, const Coefficients& u, const BoundaryValues& boundary, double t,
                   const method::HeldSource& at_held, const View<double**>& sigma) const override {
    const mesh::Mesh& mesh = space().mesh();
    if (!flux_tables_) flux_tables_ = flux_tables(space().basis());
    const auto density = method::flux_density(mesh, space().quadrature(), space().basis().degree() - 1, *tension_);
    const FaceMoments moments = face_moments(mesh, space().basis().degree());
    mesh.comm.together([&] {
      add_fluxes({0, end_of_form_}, false, u, moments);
      add_fluxes({end_of_form_, end_of_held_}, true, u, moments);
      add_boundary_data(boundary, t, moments);
    });
    dg::native_flux(mesh, *flux_tables_, penalty_.theta, density, space().coefficients().element_entries, u, moments, mesh.owned_cells,
                    sigma);
    if (!strong(space().options())) return;
    if (!held_boundary_) held_boundary_.emplace(space(), space().options().dirichlet);
    held_boundary_->balance(force, t, at_held, sigma);
  }

 private:
  using Places = std::pair<LocalIndex, LocalIndex>;
  View<const LocalIndex*> faces_in(const Places& range) const { return Kokkos::subview(space().coefficients().coupled_faces, range); }
  method::ElementEntries entries_in(const Places& range) const {
    return Kokkos::subview(space().coefficients().coupled_entries, range, Kokkos::ALL);
  }

  void add_fluxes(const Places& range, bool held, const Coefficients& u, const FaceMoments& moments) const {
    const LocalIndex count = range.second - range.first, most = std::min(method::cells_per_block(2 * space().basis().size()), count);
    const Faces faces = faces_of(space().mesh(), faces_in(range));
    const Traces at = traces_for(space(), *tension_);
    FaceTension mu(space(), faces, at, *tension_);
    for (LocalIndex first = 0; first < count; first += most) {
      const LocalIndex length = std::min(most, count - first);
      add_face_fluxes(space().mesh(), faces, at, penalty_, held, first, length, mu.at(first, length), entries_in(range), u, moments);
    }
  }

  /// What the boundary data give. Throws on this rank only.
  void add_boundary_data(const BoundaryValues& boundary, double t, const FaceMoments& moments) const {
    const auto& dirichlet = space().options().dirichlet;
    const Traces at = traces(space().basis(), space().options().params.order());
    for (std::size_t tag = 0; tag < dirichlet.size(); ++tag) {
      if (dirichlet[tag] && strong(space().options())) continue;
      const auto& data = dirichlet[tag] ? boundary.dirichlet[tag] : boundary.neumann[tag];
      if (!data) continue;
      const auto on = boundary_data(space(), static_cast<LocalIndex>(tag), at, *data, t, dirichlet[tag] ? tension_.get() : nullptr);
      add_boundary_fluxes(space().mesh(), on, at, dirichlet[tag] ? &penalty_ : nullptr, moments);
    }
  }

  scene::FieldPtr tension_;
  Penalty penalty_{};
  LocalIndex end_of_form_ = 0, end_of_held_ = 0;   ///< among the coupled faces
  mutable std::optional<FluxTables> flux_tables_;  ///< these two are made when a flux is first asked for
  mutable std::optional<HeldBoundary> held_boundary_;
};

}  // namespace

method::FormPtr diffusion(const method::Space& space, const scene::FieldPtr& tension) {
  THIXIS_ASSERT_EQ(space.components(), 1, "diffusion is of scalar fields");
  return std::make_shared<Diffusion>(space, tension);
}

}  // namespace thixis::dg
