#include "data/cut_oscillation.hpp"

#include <algorithm>
#include <cmath>

#include "data/on_host.hpp"
#include "data/sources.hpp"
#include "thixis/equilibration/cut.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::bound {
namespace {

constexpr int levels = 3, children = 64;  ///< 4^levels

/// The children of some cells, one after the other, each with vertices of its own.
mesh::Mesh refined(const mesh::Mesh& mesh, const std::vector<LocalIndex>& cells) {
  const auto host = mesh::on_host(mesh);
  mesh::Mesh fine;
  fine.comm = mesh.comm;
  fine.cells = fine.owned_cells = static_cast<LocalIndex>(cells.size()) * children;
  fine.vertices = 3 * fine.cells;
  fine.coordinates = View<double* [2]>("thixis::bound::child_coordinates", fine.vertices);
  fine.cell_vertices = View<LocalIndex* [3]>("thixis::bound::child_vertices", fine.cells);
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

/// y += A x.
void add_product(const std::vector<double>& A, const double* x, int columns, double* y) {
  const int rows = static_cast<int>(A.size()) / columns;
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < columns; ++k) y[i] += A[i * columns + k] * x[k];
}

/// The smallest flux, level by level, whose divergence is what the densities of the children are beyond a polynomial of the cell.
class Flux {
 public:
  explicit Flux(int q) : n_(reference::dimension(q)), flux_(2 * reference::dimension(q + 1)), cut_(equilibration::cut({1, 2, 3, 4}, q)) {
    for (int j = 0; j <= levels; ++j) {
      density_[j].resize((n_ << 2 * j));
      sigma_[j].resize((flux_ << 2 * j));
    }
  }

  /// densities [children][n] -> fluxes [children][flux], there until the next call
  const std::vector<double>& operator()(const double* densities) {
    std::copy_n(densities, children * n_, density_[levels].data());
    for (int j = levels; j-- > 0;) {
      std::fill(density_[j].begin(), density_[j].end(), 0.0);
      for (int parent = 0; parent < 1 << 2 * j; ++parent)
        add_product(cut_.sum, &density_[j + 1][4 * n_ * parent], 4 * n_, &density_[j][n_ * parent]);
    }
    std::fill(sigma_[0].begin(), sigma_[0].end(), 0.0);
    for (int j = 0; j < levels; ++j) {
      std::fill(sigma_[j + 1].begin(), sigma_[j + 1].end(), 0.0);
      for (int parent = 0; parent < 1 << 2 * j; ++parent) {
        double *const rest = &density_[j + 1][4 * n_ * parent], *const of_children = &sigma_[j + 1][4 * flux_ * parent];
        minus_.assign(&density_[j][n_ * parent], &density_[j][n_ * parent] + n_);
        for (double& value : minus_) value = -value;
        add_product(cut_.restrict, &sigma_[j][flux_ * parent], flux_, of_children);
        rest_.assign(rest, rest + 4 * n_);
        add_product(cut_.share, minus_.data(), n_, rest_.data());
        add_product(cut_.lift, rest_.data(), 4 * n_, of_children);
      }
    }
    return sigma_[levels];
  }

 private:
  int n_, flux_;
  const equilibration::Cut& cut_;
  std::vector<double> density_[levels + 1], sigma_[levels + 1], minus_, rest_;
};

}  // namespace

CutOscillation::CutOscillation(const method::Space& space, int q, const scene::FieldPtr& interface, double time)
    : comm_(space.mesh().comm), q_(q) {
  const mesh::Mesh& mesh = space.mesh();
  const auto own = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space.quadrature().own_rule);
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    if (own(K) >= 0) cells_.push_back(K);
  if (!comm_.any(!cells_.empty())) return;
  fine_ = refined(mesh, cells_);
  const auto all = method::owned_cells(fine_);
  quadrature_ = method::make_quadrature(fine_, all, space.quadrature().order, interface, time);
  metric_ = metrics(fine_, all);
}

void CutOscillation::sharpen(const scene::Field& force, double time, std::vector<double>& bound) const {
  if (!comm_.any(std::any_of(cells_.begin(), cells_.end(), [&](LocalIndex K) { return bound[K] > 0; }))) return;
  const auto metric = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), metric_);
  const reference::Modal modal(q_);
  const int n = modal.size(), flux = 2 * reference::dimension(q_ + 1);
  std::vector<double> density(static_cast<std::size_t>(fine_.cells) * n, 0.0), remainder(fine_.cells, 0.0);
  const View<double*> force_at("thixis::bound::force_in_children", quadrature_.largest_block);
  const auto rule_xi = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), quadrature_.rule_xi);
  const auto at_rule = modal.values(rule_xi.extent_int(0), rule_xi.data());
  comm_.together([&] {
    method::for_each_block(quadrature_, [&](const method::QuadratureBlock& block) {
      method::evaluate(force, time, block, force_at);
      const auto offset = on_host(block.offset);
      const auto own = on_host(block.own_rule);
      const auto xi = on_host(block.xi);
      const auto weight = on_host(block.weight);
      const auto values = on_host(force_at);
      std::vector<double> at_own;
      for (LocalIndex c = 0; c < block.cells; ++c) {
        const int first = offset(c), count = offset(c + 1) - first;
        if (own(c) >= 0) at_own = modal.values(count, &xi(first, 0));
        const double* const phi = own(c) >= 0 ? at_own.data() : at_rule.data();
        double* const coefficient = &density[static_cast<std::size_t>(block.first + c) * n];
        for (int i = 0; i < count; ++i)
          for (int m = 0; m < n; ++m) coefficient[m] += weight(first + i) * values(first + i) * phi[i * n + m];
        for (int i = 0; i < count; ++i) {
          double rest = values(first + i);
          for (int m = 0; m < n; ++m) rest -= coefficient[m] * phi[i * n + m] / metric(block.first + c).det;
          remainder[block.first + c] += weight(first + i) * rest * rest;
        }
      }
    });
  });

  Flux smallest(q_);
  const auto host = mesh::on_host(fine_);
  for (std::size_t k = 0; k < cells_.size(); ++k) {
    const auto first = static_cast<LocalIndex>(children * k);
    const auto& sigma = smallest(&density[static_cast<std::size_t>(first) * n]);
    double square = 0, rest = 0;
    for (int c = 0; c < children; ++c) {
      square += metric(first + c).square(&sigma[c * flux], &sigma[c * flux + flux / 2], flux / 2);
      rest += std::pow(poincare * diameter(host, first + c), 2) * remainder[first + c];
    }
    bound[cells_[k]] = std::min(bound[cells_[k]], std::sqrt(std::max(square, 0.0)) + std::sqrt(rest));
  }
}

}  // namespace thixis::bound
