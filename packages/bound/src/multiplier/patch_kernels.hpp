#pragma once
#include "multiplier/multiplier_fits.hpp"

/// Kernels of patchwise_multiplier, in the order in which it runs them.
namespace thixis::bound {

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

}  // namespace thixis::bound
