#include <algorithm>
#include <cmath>

#include "data/tables.hpp"
#include "multiplier/contact_vectors.hpp"
#include "multiplier/multiplier.hpp"
#include "multiplier/multiplier_extension.hpp"
#include "multiplier/multiplier_fits.hpp"
#include "multiplier/patch_kernels.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::bound {
namespace {

class PatchwiseMultiplier final : public NonNegativeMultiplier {
 public:
  PatchwiseMultiplier(const method::Space& space, const View<const bool*>& avoid)
      : space_(space),
        q_(space.flux_degree()),
        B_(reference::bernstein(space.basis().degree() - 1)),
        metric_(metrics(space.mesh(), space.cells())),
        patches_(vertex_patches(space.mesh(), space.cells())),
        mean_("thixis::bound::patch_mean", patches_.size()),
        cell_mean_("thixis::bound::cell_mean", space.cells().extent(0)),
        shared_("thixis::bound::shared_moments", space.cells().extent(0), space.basis().size()),
        coefficients_("thixis::bound::patch_polynomial", patches_.size(), B_.size),
        data_(multiplier_fits(space, patches_, metric_)),
        extension_(space, patches_, data_) {
    weigh_cells();
    tabulate();
    limit_.patches = patches_;
    limit_.data = data_;
    limit_.generation = extension_.generations();
    limit_.x = space.mesh().coordinates;
    limit_.vertices = space.mesh().cell_vertices;
    limit_.cells = space.cells();
    limit_.metric = metric_;
    limit_.degree = B_.degree;
    limit_.cell_mean = cell_mean_;
    limit_.avoid = avoid;
    limit_.coefficients = coefficients_;
    limit_.mean = mean_;
  }

  void operator()(const algebra::Vector& moments, const CellTable& density, const CellTable& patch) const override {
    // values at contact points as coefficients: u = moments at the unknowns, zero at held ones
    const algebra::Vector all = at_unknowns(space_, moments);
    const auto at_entries = space_.complete(all, method::Coefficients("thixis::bound::nothing", space_.coefficients().entries.size()));
    space_.share(all, shared_);
    const auto shared = shared_, of_mean = of_mean_;
    const auto cell_mean = cell_mean_;
    Kokkos::parallel_for(
        "thixis::bound::cell_means", Kokkos::RangePolicy<>(0, cell_mean.extent_int(0)), KOKKOS_LAMBDA(int k) {
          double sum = 0, known = 0;
          for (int l = 0; l < shared.extent_int(1); ++l) {
            sum += of_mean(k, l) * shared(k, l);
            known += of_mean(k, l);
          }
          cell_mean(k) = known > 0 ? sum : -1;
        });
    const Kokkos::RangePolicy<> all_patches(0, patches_.size());
    Kokkos::parallel_for("thixis::bound::fit_multiplier", all_patches, FitPatch{data_, at_entries, coefficients_, mean_});
    extension_(coefficients_, mean_);
    LimitPatch limit = limit_;
    limit.patch = patch;
    Kokkos::parallel_for("thixis::bound::limit_multiplier", all_patches, limit);
    const int modes = density.extent_int(1);
    Kokkos::parallel_for(
        "thixis::bound::sum_patches", Kokkos::RangePolicy<>(0, density.extent_int(0)), KOKKOS_LAMBDA(int K) {
          for (int m = 0; m < modes; ++m) density(K, m) = patch(K, m) + patch(K, modes + m) + patch(K, 2 * modes + m);
        });
  }

  std::size_t bytes() const override {
    return sizeof(double) * (data_.fit.size() + data_.hat.size() + coefficients_.size()) +
           sizeof(LocalIndex) * (data_.node.size() + patches_.cell.size());
  }

 private:
  void tabulate() {
    const reference::Modal modal(q_ + 1);
    const int n = B_.size, modes = reference::dimension(q_), wide = modal.size();
    limit_.lattice = matrix_view("thixis::bound::lattice", n, 3, bernstein_lattice(B_));
    limit_.from_lattice = matrix_view("thixis::bound::from_lattice", n, n, bound::from_lattice(B_));
    const auto T = bernstein_to_modal(B_, modal, wide);
    const Kokkos::View<double***, Kokkos::LayoutRight> hat_modal("thixis::bound::hat_modal", 3, modes, n);
    const auto host = Kokkos::create_mirror_view(hat_modal);
    std::vector<double> integral;
    for (int i = 0; i < 3; ++i) {
      for (int m = 0; m < modes; ++m)
        for (int b = 0; b < n; ++b)
          for (int k = 0; k < wide; ++k) host(i, m, b) += modal.times_barycentric(i)[m * wide + k] * T[k * n + b];
      for (int b = 0; b < n; ++b) integral.push_back(host(i, 0, b) * std::sqrt(0.5));
    }
    Kokkos::deep_copy(hat_modal, host);
    limit_.hat_modal = hat_modal;
    limit_.hat_integral = matrix_view("thixis::bound::hat_integral", 3, n, integral);
  }

  /// The mean of lambda in a cell is that of the values moment / (1, psi_l) of its free functions, with weights (1, psi_l)_K: exact for
  /// constants next to the held boundary and between cells of different sizes, too.
  void weigh_cells() {
    const auto& basis = space_.basis();
    const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space_.coefficients().element_entries);
    const auto column = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space_.numbering().column_of_entry);
    const auto metric = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), metric_);
    const auto cells = static_cast<LocalIndex>(metric.extent(0));
    const double least = 1e-3 / basis.size();  // functions without a mean say nothing about that of lambda
    algebra::Vector integral(space_.map());
    {
      const auto out = algebra::host_view(integral);
      for (LocalIndex k = 0; k < cells; ++k)
        for (int l = 0; l < basis.size(); ++l)
          if (const LocalIndex row = column(entries(k, l)); row >= 0 && row < static_cast<LocalIndex>(out.extent(0)))
            out(row) += metric(k).det * basis.integrals()[l];
    }
    of_mean_ = CellTable("thixis::bound::of_mean", cells, basis.size());
    const CellTable shared("thixis::bound::shared_integrals", cells, basis.size());
    space_.share(integral, shared);
    const auto host = Kokkos::create_mirror_view(of_mean_);
    const auto part = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), shared);
    for (LocalIndex k = 0; k < cells; ++k) {
      double known = 0;
      for (int l = 0; l < basis.size(); ++l)
        if (part(k, l) > 0 && basis.integrals()[l] > least) known += basis.integrals()[l];
      for (int l = 0; l < basis.size(); ++l)
        if (part(k, l) > 0 && basis.integrals()[l] > least) host(k, l) = basis.integrals()[l] / known / part(k, l);
    }
    Kokkos::deep_copy(of_mean_, host);
  }

  const method::Space& space_;
  int q_;
  reference::Bernstein B_;  ///< of degree p - 1
  Metrics metric_;
  VertexPatches patches_;
  View<double*> mean_, cell_mean_;
  CellTable shared_, of_mean_, coefficients_;
  Fits data_;
  MultiplierExtension extension_;
  LimitPatch limit_;  ///< but for `patch`
};

}  // namespace

std::unique_ptr<NonNegativeMultiplier> patchwise_multiplier(const method::Space& space, const View<const bool*>& avoid) {
  return std::make_unique<PatchwiseMultiplier>(space, avoid);
}

}  // namespace thixis::bound
