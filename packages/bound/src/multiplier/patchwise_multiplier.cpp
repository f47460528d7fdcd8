#include <algorithm>
#include <cmath>

#include "data/tables.hpp"
#include "multiplier/multiplier.hpp"
#include "multiplier/multiplier_extension.hpp"
#include "multiplier/multiplier_fits.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::bound {
namespace {

/// L_a from the moments of the free functions inside each patch, and its mean.
struct FitPatch {
  Fits data;
  View<const double*> moment;  ///< of entries, 0 where there is none
  CellTable coefficients;      ///< out, overwritten: (a, b) of scaled monomials; 0 without contact and where there is no fit
  View<double*> mean;          ///< out, overwritten; -1 where no function is free

  KOKKOS_FUNCTION void operator()(int a) const {
    const int n = coefficients.extent_int(1);
    const LocalIndex first = data.node_offset(a), count = data.node_offset(a + 1) - first;
    double total = 0;
    for (LocalIndex l = first; l < first + count; ++l) total += data.hat(l) * moment(data.node(l));
    mean(a) = data.weight(a) > 0 ? total / data.weight(a) : -1;
    for (int b = 0; b < n; ++b) coefficients(a, b) = 0;
    if (!(mean(a) > 0)) return;
    if (n == 1) coefficients(a, 0) = mean(a);
    else if (data.fit_offset(a + 1) > data.fit_offset(a))
      for (int b = 0; b < n; ++b)
        for (LocalIndex l = 0; l < count; ++l)
          coefficients(a, b) += data.fit(data.fit_offset(a) + b * count + l) * moment(data.node(first + l));
  }
};

/// lambda^_a from L_a: its moment, and no negative values.
struct LimitPatch {
  VertexPatches patches;
  Fits data;
  View<const int*> generation;
  View<double* [2]> x;
  View<LocalIndex* [3]> vertices;
  View<const LocalIndex*> cells;
  Metrics metric;
  int degree;                                                    ///< p - 1
  Matrix lattice;                                                ///< (b, 3)
  Matrix from_lattice;                                           ///< (b, b)
  Matrix hat_integral;                                           ///< (i, b): ∫ lambda_i B_b
  Kokkos::View<const double***, Kokkos::LayoutRight> hat_modal;  ///< (i, m, b): ∫ lambda_i B_b phi_m
  View<const double*> cell_mean;  ///< of lambda, from the moments of the free functions; -1 where there is none
  View<const bool*> avoid;        ///< of length 0: no cell
  ConstCellTable coefficients;
  View<const double*> mean;
  CellTable patch;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int a) const {
    const int n = from_lattice.extent_int(0), modes = hat_modal.extent_int(1);
    const double average = mean(a) > 0 ? mean(a) : 0, elsewhere = average > 0 ? beside(a) : 0;
    const double steepness = elsewhere > 0 ? elsewhere : data.weight(a) > 0 && average > 0 ? concentration(a) : 0;
    // along the edge of the contact zone what others continue says nothing
    const bool fitted = elsewhere == 0 && average > 0 && degree > 0 && (generation(a) == 0 || (generation(a) > 0 && steepness == 0));
    double shift = 0, part = 0;
    if (fitted) part = share(a, average, steepness, shift);
    for (LocalIndex e = patches.offset(a); e < patches.offset(a + 1); ++e) {
      const LocalIndex k = patches.cell(e);
      const int i = patches.corner(e);
      const double simple = elsewhere > 0 ? open_mean(k) * average * elsewhere : in_cell(k, average, steepness);
      double B[most_coefficients];
      if (part > 0) of_cell(a, k, B);
      for (int b = 0; b < n; ++b) B[b] = part > 0 ? part * (B[b] + shift) + (1 - part) * simple : simple;
      for (int m = 0; m < modes; ++m) {
        double sum = 0;
        for (int b = 0; b < n; ++b) sum += hat_modal(i, m, b) * B[b];
        patch(k, i * modes + m) = metric(k).det * sum;
      }
    }
  }

  /// The simple function with the moment of L_a: its mean, or, along the edge of the contact zone, in proportion to the means of the cells.
  KOKKOS_FUNCTION double in_cell(LocalIndex k, double average, double steepness) const {
    return steepness > 0 && cell_mean(k) >= 0 ? average * steepness * cell_mean(k) : average;
  }
  /// The mean of lambda in a cell that is not to be avoided.
  KOKKOS_FUNCTION double open_mean(LocalIndex k) const { return avoid(k) || cell_mean(k) < 0 ? 0 : cell_mean(k); }
  /// The factor of proportion to these over the mean, where the patch has both cells to be avoided and others with contact; 0 elsewhere.
  KOKKOS_FUNCTION double beside(int a) const {
    if (avoid.extent(0) == 0) return 0;
    double integral = 0, area = 0;
    bool any = false;
    for (LocalIndex e = patches.offset(a); e < patches.offset(a + 1); ++e) {
      const LocalIndex k = patches.cell(e);
      any = any || avoid(k);
      integral += metric(k).det / 6 * open_mean(k);
      area += metric(k).det / 6;
    }
    return any && integral > 0 ? area / integral : 0;
  }
  /// The factor of proportion over the mean; 0 away from the edge.
  KOKKOS_FUNCTION double concentration(int a) const {
    double lowest = 1e300, highest = 0, integral = 0, area = 0;
    for (LocalIndex e = patches.offset(a); e < patches.offset(a + 1); ++e) {
      const LocalIndex k = patches.cell(e);
      if (cell_mean(k) < 0) continue;
      lowest = cell_mean(k) < lowest ? cell_mean(k) : lowest;
      highest = cell_mean(k) > highest ? cell_mean(k) : highest;
      integral += metric(k).det / 6 * cell_mean(k);
      area += metric(k).det / 6;
    }
    return lowest < 0.5 * highest ? area / integral : 0;
  }

  /// Bernstein coefficients of L_a in a cell.
  KOKKOS_FUNCTION void of_cell(int a, LocalIndex k, double* B) const {
    const int n = from_lattice.extent_int(0);
    const LocalIndex K = cells(k);
    double value[most_coefficients], monomial[most_coefficients];
    for (int l = 0; l < n; ++l) {
      double at[2] = {0, 0};
      for (int v = 0; v < 3; ++v)
        for (int d = 0; d < 2; ++d) at[d] += lattice(l, v) * x(vertices(K, v), d);
      monomials(degree, (at[0] - data.place(a, 0)) / data.diameter(a), (at[1] - data.place(a, 1)) / data.diameter(a), monomial);
      value[l] = 0;
      for (int b = 0; b < n; ++b) value[l] += coefficients(a, b) * monomial[b];
    }
    for (int b = 0; b < n; ++b) {
      B[b] = 0;
      for (int l = 0; l < n; ++l) B[b] += from_lattice(b, l) * value[l];
    }
  }

  /// The shift that gives L_a its moment, and the largest part of it that, with the simple function for the rest, is non-negative. Where
  /// functions inside the patch are held, `average` is only near the mean of lambda, and no moment needs to be kept: no shift.
  KOKKOS_FUNCTION double share(int a, double average, double steepness, double& shift) const {
    const int n = from_lattice.extent_int(0);
    double moment_of_fit = 0, area = 0;
    for (LocalIndex e = patches.offset(a); e < patches.offset(a + 1); ++e) {
      const LocalIndex k = patches.cell(e);
      double B[most_coefficients];
      of_cell(a, k, B);
      for (int b = 0; b < n; ++b) moment_of_fit += metric(k).det * hat_integral(patches.corner(e), b) * B[b];
      area += metric(k).det / 6;
    }
    shift = data.free(a) || steepness > 0 ? average - moment_of_fit / area : 0;
    double part = 1;
    for (LocalIndex e = patches.offset(a); e < patches.offset(a + 1); ++e) {
      const LocalIndex k = patches.cell(e);
      const double simple = in_cell(k, average, steepness);
      double B[most_coefficients];
      of_cell(a, k, B);
      for (int b = 0; b < n; ++b) {
        const double value = B[b] + shift;
        if (value >= 0) continue;
        const double most = simple / (simple - value);
        part = most < part ? most : part;
      }
    }
    return part;
  }
};

class PatchwiseMultiplier final : public NonNegativeMultiplier {
 public:
  PatchwiseMultiplier(const method::PolynomialSpace& space, const View<const bool*>& avoid)
      : space_(space),
        avoid_(avoid),
        q_(space.flux_degree()),
        B_(reference::bernstein(space.basis().degree() - 1)),
        metric_(metrics(space.mesh(), space.cells())),
        patches_(vertex_patches(space.mesh(), space.cells())),
        mean_("thixis::bound::patch_mean", patches_.size()),
        cell_mean_("thixis::bound::cell_mean", space.cells().extent(0)),
        shared_("thixis::bound::shared_moments", space.cells().extent(0), space.basis().size()),
        coefficients_("thixis::bound::patch_polynomial", patches_.size(), B_.size),
        data_(multiplier_fits(space, patches_, metric_)),
        extension_(space, patches_, data_),
        generation_(extension_.generations()) {
    tabulate();
    weigh_cells();
  }

  void operator()(const algebra::Vector& moments, const CellTable& density, const CellTable& patch) const override {
    // values at contact points as coefficients: u = moments at the unknowns, zero at held ones
    algebra::Vector all(space_.map());
    {
      const auto in = algebra::host_view(moments);
      const auto out = algebra::host_view(all);
      for (std::size_t l = 0; l < in.extent(0); ++l) out(l) = in(l);
    }
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
    const mesh::Mesh& mesh = space_.mesh();
    const Kokkos::RangePolicy<> all_patches(0, patches_.size());
    Kokkos::parallel_for("thixis::bound::fit_multiplier", all_patches, FitPatch{data_, at_entries, coefficients_, mean_});
    extension_(coefficients_, mean_);
    Kokkos::parallel_for("thixis::bound::limit_multiplier", all_patches,
                         LimitPatch{patches_, data_, generation_, mesh.coordinates, mesh.cell_vertices, space_.cells(), metric_, B_.degree,
                                    lattice_, from_lattice_, hat_integral_, hat_modal_, cell_mean_, avoid_, coefficients_, mean_, patch});
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
    lattice_ = matrix("thixis::bound::lattice", n, 3, bernstein_lattice(B_));
    from_lattice_ = matrix("thixis::bound::from_lattice", n, n, bound::from_lattice(B_));
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
    hat_modal_ = hat_modal;
    hat_integral_ = matrix("thixis::bound::hat_integral", 3, n, integral);
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

  const method::PolynomialSpace& space_;
  View<const bool*> avoid_;
  int q_;
  reference::Bernstein B_;  ///< of degree p - 1
  Metrics metric_;
  VertexPatches patches_;
  View<double*> mean_, cell_mean_;
  CellTable shared_, of_mean_, coefficients_;
  Fits data_;
  MultiplierExtension extension_;
  View<const int*> generation_;
  Matrix lattice_, from_lattice_, hat_integral_;
  Kokkos::View<const double***, Kokkos::LayoutRight> hat_modal_;
};

}  // namespace

std::unique_ptr<NonNegativeMultiplier> patchwise_multiplier(const method::PolynomialSpace& space, const View<const bool*>& avoid) {
  return std::make_unique<PatchwiseMultiplier>(space, avoid);
}

}  // namespace thixis::bound
