#include "thixis/method/measures.hpp"

#include "kernels/polynomial_kernels.hpp"
#include "thixis/method/form.hpp"

namespace thixis::method {
namespace {

/// The points with barycentric coordinates i/sides, flat, [point][3].
std::vector<double> lattice(int sides) {
  std::vector<double> points;
  for (int i = 0; i <= sides; ++i)
    for (int j = 0; i + j <= sides; ++j)
      for (const int k : {i, j, sides - i - j}) points.push_back(static_cast<double>(k) / sides);
  return points;
}

/// Values of the obstacle at these points of some cells.
class Obstacle {
 public:
  Obstacle(const Space& space, const scene::Field* obstacle, double t, const std::vector<double>& lattice, LocalIndex most)
      : space_(space), obstacle_(obstacle), t_(t), lattice_(lattice), points_(static_cast<int>(lattice.size()) / 3) {
    if (!obstacle) return;
    psi_ = Block2("thixis::method::obstacle", most, points_);
    x_.resize(psi_.size());
    y_.resize(psi_.size());
  }
  const Block2& at(LocalIndex first, LocalIndex count) {
    if (!obstacle_) return psi_;
    const mesh::HostMesh& mesh = space_.host();
    for (LocalIndex e = 0; e < count; ++e)
      for (int q = 0; q < points_; ++q)
        for (int d = 0; d < 2; ++d) {
          double& coordinate = (d == 0 ? x_ : y_)[e * points_ + q];
          coordinate = 0;
          for (int a = 0; a < 3; ++a) coordinate += lattice_[3 * q + a] * mesh.coordinates(mesh.cell_vertices(first + e, a), d);
        }
    const auto host = Kokkos::create_mirror_view(psi_);
    obstacle_->evaluate({static_cast<std::size_t>(count) * points_, x_.data(), y_.data()}, t_, host.data());
    Kokkos::deep_copy(psi_, host);
    return psi_;
  }

 private:
  const Space& space_;
  const scene::Field* obstacle_;
  double t_;
  const std::vector<double>& lattice_;
  int points_;
  std::vector<double> x_, y_;
  Block2 psi_;
};

}  // namespace

double l2_error(const Space& space, const Coefficients& uh, const scene::FieldPtr& u, double t) {
  return energy_error(*mass(space), uh, {Known{{}, u}}, t);
}

double penetration(const Space& space, const Coefficients& uh, const scene::Field* obstacle, double t) {
  constexpr LocalIndex most = 256;
  const mesh::Mesh& mesh = space.mesh();
  const auto points = lattice(8 * space.basis().degree());
  const auto lambda = matrix_view("thixis::method::lattice", static_cast<int>(points.size()) / 3, 3, points);
  const CellFunctions basis = cell_functions(space.basis());
  const double depth = mesh.comm.together([&] {
    double here = 0;
    Obstacle psi(space, obstacle, t, points, most);
    for (LocalIndex first = 0; first < mesh.owned_cells; first += most) {
      const LocalIndex count = std::min(most, mesh.owned_cells - first);
      here = std::max(here, deepest(basis, first, count, lambda, psi.at(first, count), space.coefficients().element_entries, uh));
    }
    return here;
  });
  return mesh.comm.max(depth);
}

std::vector<double> values_at(const Space& space, const std::vector<mesh::Place>& places, const Coefficients& u) {
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.coefficients().element_entries);
  const auto u_host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), u);
  std::vector<double> values(places.size(), 0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const mesh::Place& place = places[i];
    if (place.cell < 0) continue;
    const double at[2] = {place.xi, place.eta};
    const auto table = space.basis().tabulate(1, at);
    for (int l = 0; l < space.basis().size(); ++l) values[i] += table.value[l] * u_host(entries(place.cell, l));
  }
  space.mesh().comm.sum(values);
  return values;
}

}  // namespace thixis::method
