#include "cut_oscillation.hpp"

#include <algorithm>
#include <cmath>

#include "cut.hpp"
#include "thixis/equilibration/cell_fields.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::equilibration {
namespace {

constexpr int levels = 3, children = 64;  ///< 4^levels

/// The children of some cells, one after the other, each with vertices of its own.
mesh::Mesh refined(const mesh::Mesh& mesh, const std::vector<LocalIndex>& cells) {
  const auto host = mesh::on_host(mesh);
  mesh::Mesh fine;
  fine.comm = mesh.comm;
  fine.cells = fine.owned_cells = static_cast<LocalIndex>(cells.size()) * children;
  fine.vertices = 3 * fine.cells;
  fine.coordinates = View<double* [2]>("thixis::equilibration::child_coordinates", fine.vertices);
  fine.cell_vertices = View<LocalIndex* [3]>("thixis::equilibration::child_vertices", fine.cells);
  const auto x = Kokkos::create_mirror_view(fine.coordinates);
  const auto vertices = Kokkos::create_mirror_view(fine.cell_vertices);
  for (std::size_t k = 0; k < cells.size(); ++k)
    for (int c = 0; c < children; ++c) {
      mesh::Corners corners = mesh::child_shapes()[0];
      for (int level = levels - 1; level >= 0; --level) {
        const auto& part = mesh::child_shapes()[1 + (c >> (2 * level)) % 4];
        mesh::Corners inner{};
        for (int i = 0; i < 3; ++i)
          for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) inner[i][b] += part[i][a] * corners[a][b];
        corners = inner;
      }
      const auto child = static_cast<LocalIndex>(k * children + c);
      for (int i = 0; i < 3; ++i) {
        vertices(child, i) = 3 * child + i;
        for (int d = 0; d < 2; ++d)
          for (int a = 0; a < 3; ++a) x(3 * child + i, d) += corners[i][a] * host.coordinates(host.cell_vertices(cells[k], a), d);
      }
    }
  Kokkos::deep_copy(fine.coordinates, x);
  Kokkos::deep_copy(fine.cell_vertices, vertices);
  return fine;
}

std::vector<double> product(const std::vector<double>& A, const double* x, int columns) {
  std::vector<double> y(A.size() / columns, 0.0);
  for (std::size_t i = 0; i < y.size(); ++i)
    for (int k = 0; k < columns; ++k) y[i] += A[i * columns + k] * x[k];
  return y;
}

/// The smallest flux, level by level, whose divergence is what the densities of the children are beyond a polynomial of the cell.
class Flux {
 public:
  explicit Flux(int q) : n_(reference::dimension(q)), flux_(2 * reference::dimension(q + 1)), cut_(cut({1, 2, 3, 4}, q)) {}

  /// densities [children][n] -> fluxes [children][flux]
  std::vector<double> operator()(const std::vector<double>& densities) const {
    std::vector<std::vector<double>> of_level(levels + 1);
    of_level[levels] = densities;
    for (int j = levels; j > 0; --j)
      for (std::size_t parent = 0; parent < of_level[j].size() / (4 * n_); ++parent) {
        const auto sum = product(cut_.sum, &of_level[j][4 * n_ * parent], 4 * n_);
        of_level[j - 1].insert(of_level[j - 1].end(), sum.begin(), sum.end());
      }
    std::vector<double> sigma(flux_, 0.0);
    for (int j = 0; j < levels; ++j) {
      std::vector<double> finer;
      for (std::size_t parent = 0; parent < sigma.size() / flux_; ++parent) {
        const auto share = product(cut_.share, &of_level[j][n_ * parent], n_);
        std::vector<double> rest(&of_level[j + 1][4 * n_ * parent], &of_level[j + 1][4 * n_ * parent] + 4 * n_);
        for (int i = 0; i < 4 * n_; ++i) rest[i] -= share[i];
        auto of_children = product(cut_.restrict, &sigma[flux_ * parent], flux_);
        const auto lifted = product(cut_.lift, rest.data(), 4 * n_);
        for (std::size_t i = 0; i < lifted.size(); ++i) of_children[i] += lifted[i];
        finer.insert(finer.end(), of_children.begin(), of_children.end());
      }
      sigma = std::move(finer);
    }
    return sigma;
  }

 private:
  int n_, flux_;
  Cut cut_;
};

}  // namespace

void sharpen_in_cut_cells(const method::PolynomialSpace& space, int q, const scene::Field& force, const scene::FieldPtr& interface,
                          std::vector<double>& bound) {
  const mesh::Mesh& mesh = space.mesh();
  const auto own = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.quadrature().own_rule);
  std::vector<LocalIndex> cells;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    if (own(K) >= 0 && bound[K] > 0) cells.push_back(K);
  if (!mesh.comm.any(!cells.empty())) return;

  const mesh::Mesh fine = refined(mesh, cells);
  const auto all = method::owned_cells(fine);
  const auto quadrature = method::make_quadrature(fine, all, space.quadrature().order, interface);
  const auto metric = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), metrics(fine, all));
  const reference::Modal modal(q);
  const int n = modal.size(), flux = 2 * reference::dimension(q + 1);
  std::vector<double> density(static_cast<std::size_t>(fine.cells) * n, 0.0), remainder(fine.cells, 0.0);
  const View<double*> values("thixis::equilibration::force_in_children", quadrature.largest_block);
  mesh.comm.together([&] {
    method::for_each_block(quadrature, [&](const method::QuadratureBlock& block) {
      method::evaluate(force, 0, block, values);
      for (LocalIndex c = 0; c < block.cells; ++c) {
        const int first = block.offset(c), count = block.offset(c + 1) - first;
        const auto phi = modal.values(count, &block.xi(first, 0));
        double* const coefficient = &density[static_cast<std::size_t>(block.first + c) * n];
        for (int i = 0; i < count; ++i)
          for (int m = 0; m < n; ++m) coefficient[m] += block.weight(first + i) * values(first + i) * phi[i * n + m];
        for (int i = 0; i < count; ++i) {
          double rest = values(first + i);
          for (int m = 0; m < n; ++m) rest -= coefficient[m] * phi[i * n + m] / metric(block.first + c).det;
          remainder[block.first + c] += block.weight(first + i) * rest * rest;
        }
      }
    });
  });

  const Flux smallest(q);
  const auto coordinates = mesh::on_host(fine).coordinates;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const auto first = static_cast<std::size_t>(children) * k;
    const auto sigma = smallest({&density[first * n], &density[first * n] + children * n});
    double square = 0, rest = 0;
    for (int c = 0; c < children; ++c) {
      square += metric(first + c).square(&sigma[c * flux], &sigma[c * flux + flux / 2], flux / 2);
      double h = 0;
      for (int i = 0; i < 3; ++i) {
        const std::size_t a = 3 * (first + c) + i, b = 3 * (first + c) + (i + 1) % 3;
        h = std::max(h, std::hypot(coordinates(a, 0) - coordinates(b, 0), coordinates(a, 1) - coordinates(b, 1)));
      }
      rest += h * h * poincare * poincare * remainder[first + c];
    }
    bound[cells[k]] = std::min(bound[cells[k]], std::sqrt(std::max(square, 0.0)) + std::sqrt(rest));
  }
}

}  // namespace thixis::equilibration
