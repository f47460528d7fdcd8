#include "multiplier/multiplier_fits.hpp"

#include <algorithm>
#include <cmath>

#include "data/on_host.hpp"
#include "data/tables.hpp"
#include "multiplier/least_squares.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::bound {
namespace {

/// psi_l at the places of a patch: which functions of a cell do not vanish with the hat function of its vertex i.
bool inside_patch(const reference::NodeEntity& entity, int i) {
  return entity.kind == reference::Entity::interior || (entity.kind == reference::Entity::vertex && entity.index == i) ||
         (entity.kind == reference::Entity::face && entity.index != i);
}

/// (i, l): the hat function of vertex i in a basis.
std::vector<double> hat_coefficients(const reference::CellBasis& basis) {
  const int n = basis.size();
  std::vector<double> hat(3 * n, 0.0);
  for (int i = 0; i < 3; ++i)
    for (int l = 0; l < n; ++l)
      for (int m = 0; m < n; ++m) {
        const double xi = basis.points()[2 * m], eta = basis.points()[2 * m + 1], lambda[3] = {1 - xi - eta, xi, eta};
        hat[i * n + l] += basis.from_values()[l * n + m] * lambda[i];
      }
  return hat;
}

/// (l, v): values at the lattice of degree p - 1 -> moments against psi_l on the reference triangle.
std::vector<double> lattice_to_moments(const reference::CellBasis& basis, const reference::Bernstein& B) {
  const int functions = basis.size(), n = B.size;
  const reference::Modal modal(basis.degree());
  const auto T = bernstein_to_modal(B, modal, functions), psi = to_modal(basis, modal), coefficients = from_lattice(B);
  std::vector<double> against_bernstein(functions * n, 0.0), moments(functions * n, 0.0);
  for (int l = 0; l < functions; ++l)
    for (int b = 0; b < n; ++b)
      for (int m = 0; m < functions; ++m) against_bernstein[l * n + b] += psi[m * functions + l] * T[m * n + b];
  for (int l = 0; l < functions; ++l)
    for (int b = 0; b < n; ++b)
      for (int v = 0; v < n; ++v) moments[l * n + v] += against_bernstein[l * n + b] * coefficients[b * n + v];
  return moments;
}

/// Goes from patch to patch, on the host.
class Builder {
 public:
  Builder(const method::Space& space, const VertexPatches& patches, const Metrics& metric)
      : basis_(space.basis()),
        B_(reference::bernstein(basis_.degree() - 1)),
        host_(mesh::on_host(space.mesh())),
        cells_(on_host(space.cells())),
        entries_(on_host(space.coefficients().element_entries)),
        column_(on_host(space.numbering().column_of_entry)),
        offset_(on_host(patches.offset)),
        cell_(on_host(patches.cell)),
        corner_(on_host(patches.corner)),
        vertex_(on_host(patches.vertex)),
        metric_(on_host(metric)),
        hat_(hat_coefficients(basis_)),
        lattice_(bernstein_lattice(B_)),
        to_moments_(lattice_to_moments(basis_, B_)),
        local_(space.coefficients().entries.size(), -1),
        weight_(patches.size(), 0.0),
        diameter_(patches.size()),
        place_("thixis::bound::place", patches.size()),
        place_host_(Kokkos::create_mirror_view(place_)),
        free_("thixis::bound::free_patch", patches.size()),
        free_host_(Kokkos::create_mirror_view(free_)) {
    Kokkos::deep_copy(free_host_, true);
  }

  Fits fits() {
    for (LocalIndex a = 0; a < static_cast<LocalIndex>(weight_.size()); ++a) {
      measure(a);
      const auto first = static_cast<LocalIndex>(node_.size());
      collect_functions(a);
      const LocalIndex nodes = static_cast<LocalIndex>(node_.size()) - first;
      if (basis_.degree() > 1 && nodes >= B_.size) {
        assemble_moments(a, first, nodes);
        append_fit(A_, nodes, B_.size, fit_);
      }
      for (LocalIndex l = first; l < first + nodes; ++l) local_[node_[l]] = -1;
      node_offset_.push_back(static_cast<LocalIndex>(node_.size()));
      fit_offset_.push_back(static_cast<LocalIndex>(fit_.size()));
    }
    Kokkos::deep_copy(place_, place_host_);
    Kokkos::deep_copy(free_, free_host_);
    return {to_view("thixis::bound::node_offset", node_offset_),
            to_view("thixis::bound::patch_nodes", node_),
            to_view("thixis::bound::hat", hat_of_node_),
            to_view("thixis::bound::fit_offset", fit_offset_),
            to_view("thixis::bound::fit", fit_),
            to_view("thixis::bound::patch_weight", weight_),
            free_,
            to_view("thixis::bound::patch_diameter", diameter_),
            place_};
  }

 private:
  /// Place and size of a patch.
  void measure(LocalIndex a) {
    double size = 0;
    for (int d = 0; d < 2; ++d) place_host_(a, d) = host_.coordinates(vertex_(a), d);
    for (LocalIndex e = offset_(a); e < offset_(a + 1); ++e)
      for (int i = 0; i < 3; ++i) {
        const LocalIndex v = host_.cell_vertices(cells_(cell_(e)), i);
        size = std::max(size, std::hypot(host_.coordinates(v, 0) - place_host_(a, 0), host_.coordinates(v, 1) - place_host_(a, 1)));
      }
    diameter_[a] = size;
  }

  /// The free functions inside a patch, and sum_l c_l (psi_l, 1).
  void collect_functions(LocalIndex a) {
    const int functions = basis_.size();
    for (LocalIndex e = offset_(a); e < offset_(a + 1); ++e)
      for (int l = 0; l < functions; ++l) {
        const LocalIndex entry = entries_(cell_(e), l);
        if (!inside_patch(basis_.entities()[l], corner_(e))) continue;
        if (column_(entry) < 0) free_host_(a) = false;
        if (column_(entry) < 0) continue;
        const double c = hat_[corner_(e) * functions + l];
        if (local_[entry] < 0) {
          local_[entry] = static_cast<LocalIndex>(node_.size());
          node_.push_back(entry);
          hat_of_node_.push_back(c);
        }
        weight_[a] += c * metric_(cell_(e)).det * basis_.integrals()[l];
      }
  }

  /// A(l, b) = (monomial_b, psi_l) over the patch.
  void assemble_moments(LocalIndex a, LocalIndex first, LocalIndex nodes) {
    const int functions = basis_.size(), n = B_.size;
    double at_lattice[most_coefficients][most_coefficients];
    A_.assign(static_cast<std::size_t>(nodes) * n, 0.0);
    for (LocalIndex e = offset_(a); e < offset_(a + 1); ++e) {
      const LocalIndex k = cell_(e);
      for (int v = 0; v < n; ++v) {
        double at[2] = {0, 0};
        for (int i = 0; i < 3; ++i)
          for (int d = 0; d < 2; ++d) at[d] += lattice_[3 * v + i] * host_.coordinates(host_.cell_vertices(cells_(k), i), d);
        monomials(B_.degree, (at[0] - place_host_(a, 0)) / diameter_[a], (at[1] - place_host_(a, 1)) / diameter_[a], at_lattice[v]);
      }
      for (int l = 0; l < functions; ++l) {
        const LocalIndex at = local_[entries_(k, l)];
        if (at < 0 || !inside_patch(basis_.entities()[l], corner_(e))) continue;
        for (int b = 0; b < n; ++b) {
          double sum = 0;
          for (int v = 0; v < n; ++v) sum += to_moments_[l * n + v] * at_lattice[v][b];
          A_[static_cast<std::size_t>(at - first) * n + b] += metric_(k).det * sum;
        }
      }
    }
  }

  const reference::CellBasis& basis_;
  reference::Bernstein B_;
  mesh::HostMesh host_;
  mesh::ConstHostView<const LocalIndex*> cells_;
  mesh::ConstHostView<const LocalIndex**> entries_;
  mesh::ConstHostView<const LocalIndex*> column_, offset_, cell_;
  mesh::ConstHostView<const int*> corner_;
  mesh::ConstHostView<const LocalIndex*> vertex_;
  mesh::ConstHostView<const Metric*> metric_;
  std::vector<double> hat_, lattice_, to_moments_, A_;
  std::vector<LocalIndex> local_;  ///< entry -> its number among all functions of patches, during its patch
  std::vector<LocalIndex> node_, node_offset_{0}, fit_offset_{0};
  std::vector<double> hat_of_node_, fit_, weight_, diameter_;
  View<double* [2]> place_;
  View<double* [2]>::HostMirror place_host_;
  View<bool*> free_;
  View<bool*>::HostMirror free_host_;
};

}  // namespace

Fits multiplier_fits(const method::Space& space, const VertexPatches& patches, const Metrics& metric) {
  return Builder(space, patches, metric).fits();
}

}  // namespace thixis::bound
