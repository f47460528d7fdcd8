#include "thixis/hho/space.hpp"

#include <optional>

#include "cell_form.hpp"
#include "flux.hpp"
#include "layout.hpp"
#include "reference_cell.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/method/polynomial_space.hpp"
#include "thixis/reference/modal.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::hho {
namespace {

using algebra::Vector;
using method::BoundaryValues;
using method::Coefficients;

class HybridSpace final : public method::PolynomialSpace {
 public:
  HybridSpace(const mesh::Mesh& mesh, const method::SpaceOptions& options)
      : PolynomialSpace(mesh, options, layout(mesh, options)), reference_(reference_cell(basis_)) {
    const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), structure_.element_entries);
    const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), cells_);
    const auto column = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), numbering_.column_of_entry);
    const LocalIndex rows = algebra::local_size(*numbering_.rows);
    faces_.resize((structure_.entries.size() - structure_.cell_entries) / degree());
    for (int k = 0; k < cells.extent_int(0); ++k)
      for (int f = 0; f < 3; ++f) {
        const LocalIndex entry = entries(k, basis_.size() + f * degree());
        faces_[(entry - structure_.cell_entries) / degree()] = {host_.cell_faces(cells(k), f), entry,
                                                                column(entry) < rows ? column(entry) : -1};
      }
    collect_flux_faces(entries, cells);
  }

  std::shared_ptr<const method::CellForm> cell_form(const scene::Field& tension) const override {
    return hho::cell_form(mesh_, quadrature_, reference_, params_, tension);
  }

  Coefficients lift(const BoundaryValues& boundary, double t) const override {
    const Coefficients values("thixis::hho::lift", structure_.entries.size());
    const auto host = Kokkos::create_mirror_view(values);
    mesh_.comm.together([&] {
      for (std::size_t tag = 0; tag < boundary.dirichlet.size(); ++tag) {
        if (!boundary.dirichlet[tag]) continue;
        project(
            *boundary.dirichlet[tag], t, [&](const Face& F) { return numbering_.held[F.entry] == static_cast<LocalIndex>(tag); },
            [&](const Face& F, int j, double coefficient) { host(F.entry + j) = coefficient; });
      }
    });
    Kokkos::deep_copy(values, host);
    return values;
  }

  /// (f, v_K) and, on Neumann faces, <t, v_F>.
  void load(const scene::Field&, const scene::Field& force, const BoundaryValues& boundary, double t, Vector& F) const override {
    F.putScalar(0);
    mesh_.comm.together([&] {
      add_moments(force, t, F);
      const auto out = algebra::host_view(F);
      for (std::size_t tag = 0; tag < boundary.neumann.size(); ++tag) {
        if (!boundary.neumann[tag]) continue;
        project(
            *boundary.neumann[tag], t,
            [&](const Face& face) { return face.row >= 0 && host_.face_tag(face.face) == static_cast<LocalIndex>(tag); },
            [&](const Face& face, int j, double coefficient) {
              out(face.row + j) += mesh::face_geometry(host_.coordinates, host_.face_vertices, face.face).length * coefficient;
            });
      }
    });
  }

  /// On faces the projection of u.
  void interpolate(const scene::Field& u, double t, Vector& values) const override {
    PolynomialSpace::interpolate(u, t, values);
    mesh_.comm.together([&] {
      const auto out = algebra::host_view(values);
      project(
          u, t, [&](const Face& F) { return F.row >= 0; }, [&](const Face& F, int j, double coefficient) { out(F.row + j) = coefficient; });
    });
  }

  /// On faces the projection of the mean of both cells' polynomials.
  void prolongate(const Space& coarse, const Coefficients& coarse_u, Vector& values) const override {
    const auto fine =
        Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), from_coarse(dynamic_cast<const PolynomialSpace&>(coarse), coarse_u));
    const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), structure_.element_entries);
    const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), cells_);
    const Coefficients u("thixis::hho::prolonged", structure_.entries.size());
    const auto host = Kokkos::create_mirror_view(u);
    const int n = basis_.size(), p = degree();
    for (int k = 0; k < cells.extent_int(0); ++k) {
      const LocalIndex K = cells(k);
      for (int i = 0; i < n; ++i) host(entries(k, i)) = fine(k, i);
      for (int f = 0; f < 3; ++f) {
        const LocalIndex F = host_.cell_faces(K, f);
        const bool along = host_.face_vertices(F, 0) == host_.cell_vertices(K, (f + 1) % 3);
        const double share = mesh::neighbour(host_.face_cells, F, K) < 0 ? 1 : 0.5;
        for (int j = 0; j < p; ++j)
          for (int i = 0; i < n; ++i)
            host(entries(k, n + f * p + j)) +=
                (along || j % 2 == 0 ? share : -share) * reference_.R[f][j * reference_.unknowns + i] * fine(k, i);
      }
    }
    Kokkos::deep_copy(u, host);
    restrict_to_unknowns(u, values);
  }

  void share(const Vector& R, const View<double**>& moments) const override {
    const Coefficients nothing("thixis::hho::nothing", structure_.entries.size());
    hho::share(mesh_, reference_, params_, cells_, structure_.element_entries, complete(R, nothing), moments);
  }

  int flux_degree() const override { return degree() - 1; }

  void native_flux(const scene::Field& tension, const scene::Field&, const Coefficients& u, const BoundaryValues& boundary, double t,
                   const method::HeldSource&, const View<double**>& sigma) const override {
    if (!flux_tables_) flux_tables_ = flux_tables(reference_);
    const auto density = method::flux_density(mesh_, quadrature_, degree() - 1, tension);
    const Moments traction("thixis::hho::traction", faces_.size(), degree());
    const auto host = Kokkos::create_mirror_view(traction);
    mesh_.comm.together([&] {
      for (std::size_t tag = 0; tag < boundary.neumann.size(); ++tag)
        if (boundary.neumann[tag])
          project(
              *boundary.neumann[tag], t, [&](const Face& F) { return host_.face_tag(F.face) == static_cast<LocalIndex>(tag); },
              [&](const Face& F, int j, double coefficient) { host(&F - faces_.data(), j) = coefficient; });
    });
    Kokkos::deep_copy(traction, host);
    hho::native_flux(mesh_, reference_, *flux_tables_, params_, density, {face_row_, neighbour_, traction}, structure_.element_entries, u,
                     mesh_.owned_cells, sigma);
  }

 private:
  struct Face {
    LocalIndex face = -1;   ///< of the mesh
    LocalIndex entry = -1;  ///< the first of p
    LocalIndex row = -1;    ///< the first of p; -1 where it is held or of another rank
  };

  template <class Entries, class Cells>
  void collect_flux_faces(const Entries& entries, const Cells& cells) {
    View<LocalIndex*[3]> row("thixis::hho::face_rows", cells.extent(0)), neighbour("thixis::hho::neighbours", cells.extent(0));
    const auto row_host = Kokkos::create_mirror_view(row), neighbour_host = Kokkos::create_mirror_view(neighbour);
    for (int k = 0; k < cells.extent_int(0); ++k)
      for (int f = 0; f < 3; ++f) {
        const LocalIndex F = host_.cell_faces(cells(k), f), entry = entries(k, basis_.size() + f * degree());
        const LocalIndex other = mesh::neighbour(host_.face_cells, F, cells(k));
        row_host(k, f) = host_.face_tag(F) < 0         ? face_inside
                         : numbering_.held[entry] >= 0 ? face_held
                                                       : (entry - structure_.cell_entries) / degree();
        neighbour_host(k, f) = other < 0 ? -1 : position(other);
      }
    Kokkos::deep_copy(row, row_host);
    Kokkos::deep_copy(neighbour, neighbour_host);
    face_row_ = row;
    neighbour_ = neighbour;
  }

  int degree() const { return basis_.degree(); }

  /// set(F, j, integral of g L_j over [0,1] along F) for the faces that are wanted. Throws on this rank only.
  template <class Wanted, class Set>
  void project(const scene::Field& g, double t, Wanted wanted, Set set) const {
    const auto rule = reference::line_quadrature(params_.order());
    std::vector<const Face*> faces;
    std::vector<double> x, y;
    for (const Face& F : faces_) {
      if (!wanted(F)) continue;
      faces.push_back(&F);
      const LocalIndex a = host_.face_vertices(F.face, 0), b = host_.face_vertices(F.face, 1);
      for (const double s : rule.point) {
        x.push_back((1 - s) * host_.coordinates(a, 0) + s * host_.coordinates(b, 0));
        y.push_back((1 - s) * host_.coordinates(a, 1) + s * host_.coordinates(b, 1));
      }
    }
    std::vector<double> values(x.size()), weighted(rule.size() * degree());
    g.evaluate({x.size(), x.data(), y.data()}, t, values.data());
    for (int q = 0; q < rule.size(); ++q) {
      const auto L = reference::legendre(degree(), rule.point[q]);
      for (int j = 0; j < degree(); ++j) weighted[q * degree() + j] = rule.weight[q] * L[j];
    }
    for (std::size_t k = 0; k < faces.size(); ++k)
      for (int j = 0; j < degree(); ++j) {
        double integral = 0;
        for (int q = 0; q < rule.size(); ++q) integral += weighted[q * degree() + j] * values[k * rule.size() + q];
        set(*faces[k], j, integral);
      }
  }

  ReferenceCell reference_;
  std::vector<Face> faces_;                          ///< of the patch cells
  View<const LocalIndex*[3]> face_row_, neighbour_;  ///< FaceData of the patch cells; rows are positions in faces_
  mutable std::optional<FluxTables> flux_tables_;    ///< made when a flux is first asked for
};

}  // namespace

std::unique_ptr<method::Space> make_space(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  return std::make_unique<HybridSpace>(mesh, options);
}

}  // namespace thixis::hho
