#include <algorithm>
#include <cmath>

#include "multiplier.hpp"
#include "tables.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/mesh/host.hpp"
#include "vertex_patches.hpp"

namespace thixis::equilibration {
namespace {

constexpr int most_coefficients = 10;  ///< dim P_3
using Flags = View<const bool*>;

/// psi_l at the places of a patch: which functions of a cell do not vanish with the hat function of its vertex i.
bool inside_patch(const reference::NodeEntity& entity, int i) {
  return entity.kind == reference::Entity::interior || (entity.kind == reference::Entity::vertex && entity.index == i) ||
         (entity.kind == reference::Entity::face && entity.index != i);
}

/// Everything that one patch needs, for all of them one after the other.
struct Fits {
  View<LocalIndex*> node_offset;  ///< free functions inside patch a: node_offset(a) … node_offset(a+1)-1
  View<LocalIndex*> node;         ///< entry
  View<double*> hat;              ///< c_l: psi_a = sum_l c_l psi_l
  View<LocalIndex*> fit_offset;   ///< into `fit`
  View<double*> fit;              ///< (coefficient, node): moments -> scaled monomials around the vertex; nothing where they do not suffice
  View<double*> weight;           ///< sum_l c_l (psi_l, 1) over the free functions; 0 where there is none
  View<double*> diameter;         ///< of the patch: the scale of the monomials
  View<double* [2]> place;        ///< of the vertex
};

/// x^i y^j, i + j <= degree <= 3.
KOKKOS_INLINE_FUNCTION void monomials(int degree, double x, double y, double* value) {
  const double px[4] = {1, x, x * x, x * x * x}, py[4] = {1, y, y * y, y * y * y};
  int b = 0;
  for (int total = 0; total <= degree; ++total)
    for (int j = 0; j <= total; ++j) value[b++] = px[total - j] * py[j];
}

struct FitPatch {
  VertexPatches patches;
  Fits data;
  View<double* [2]> x;
  View<LocalIndex* [3]> vertices;
  View<const LocalIndex*> cells;
  Metrics metric;
  int degree;                                                    ///< p - 1
  Matrix lattice;                                                ///< (b, 3)
  Matrix from_lattice;                                           ///< (b, b)
  Matrix hat_integral;                                           ///< (i, b): ∫ lambda_i B_b
  Kokkos::View<const double***, Kokkos::LayoutRight> hat_modal;  ///< (i, m, b): ∫ lambda_i B_b phi_m
  View<const double*> moment;                                    ///< of entries, 0 where there is none
  View<const double*> cell_mean;  ///< of lambda, from the moments of the free functions; -1 where there is none
  CellTable patch;                ///< out, overwritten
  View<double*> mean;             ///< out: of L_a; -1 where no function is free

  KOKKOS_FUNCTION void operator()(int a) const {
    const int n = from_lattice.extent_int(0), modes = hat_modal.extent_int(1);
    const LocalIndex first = data.node_offset(a), count = data.node_offset(a + 1) - first;
    double total = 0;
    for (LocalIndex l = first; l < first + count; ++l) total += data.hat(l) * moment(data.node(l));
    const double average = data.weight(a) > 0 ? total / data.weight(a) : 0;
    mean(a) = data.weight(a) > 0 ? average : -1;
    double coefficient[most_coefficients] = {};
    const bool fitted = average > 0 && degree > 0 && data.fit_offset(a + 1) > data.fit_offset(a);
    if (fitted)
      for (int b = 0; b < n; ++b)
        for (LocalIndex l = 0; l < count; ++l)
          coefficient[b] += data.fit(data.fit_offset(a) + b * count + l) * moment(data.node(first + l));
    const double steepness = average > 0 ? concentration(a) : 0;
    double shift = 0, part = 0;
    if (fitted) part = share(a, coefficient, average, steepness, shift);
    for (LocalIndex e = patches.offset(a); e < patches.offset(a + 1); ++e) {
      const LocalIndex k = patches.cell(e);
      const int i = patches.corner(e);
      const double simple = in_cell(k, average, steepness);
      double B[most_coefficients];
      if (part > 0) of_cell(a, k, coefficient, B);
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
  KOKKOS_FUNCTION void of_cell(int a, LocalIndex k, const double* coefficient, double* B) const {
    const int n = from_lattice.extent_int(0);
    const LocalIndex K = cells(k);
    double value[most_coefficients], monomial[most_coefficients];
    for (int l = 0; l < n; ++l) {
      double at[2] = {0, 0};
      for (int v = 0; v < 3; ++v)
        for (int d = 0; d < 2; ++d) at[d] += lattice(l, v) * x(vertices(K, v), d);
      monomials(degree, (at[0] - data.place(a, 0)) / data.diameter(a), (at[1] - data.place(a, 1)) / data.diameter(a), monomial);
      value[l] = 0;
      for (int b = 0; b < n; ++b) value[l] += coefficient[b] * monomial[b];
    }
    for (int b = 0; b < n; ++b) {
      B[b] = 0;
      for (int l = 0; l < n; ++l) B[b] += from_lattice(b, l) * value[l];
    }
  }

  /// The shift that gives L_a its moment, and the largest part of it that, with the simple function for the rest, is non-negative.
  KOKKOS_FUNCTION double share(int a, const double* coefficient, double average, double steepness, double& shift) const {
    const int n = from_lattice.extent_int(0);
    double moment_of_fit = 0, area = 0;
    for (LocalIndex e = patches.offset(a); e < patches.offset(a + 1); ++e) {
      const LocalIndex k = patches.cell(e);
      double B[most_coefficients];
      of_cell(a, k, coefficient, B);
      for (int b = 0; b < n; ++b) moment_of_fit += metric(k).det * hat_integral(patches.corner(e), b) * B[b];
      area += metric(k).det / 6;
    }
    shift = average - moment_of_fit / area;
    double part = 1;
    for (LocalIndex e = patches.offset(a); e < patches.offset(a + 1); ++e) {
      const LocalIndex k = patches.cell(e);
      const double simple = in_cell(k, average, steepness);
      double B[most_coefficients];
      of_cell(a, k, coefficient, B);
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

/// Where no function of a patch is free, the mean of the other vertices of its cells that have one. For p = 1 their values are those of
/// lambda_h: the patches of some of them may be known to other ranks only. For p >= 2 such a patch is a single cell, of this rank.
struct FillEmpty {
  VertexPatches patches;
  View<const LocalIndex*> patch_of_vertex;
  View<LocalIndex* [3]> vertices;
  View<const LocalIndex*> cells;
  Kokkos::View<LocalIndex**, Kokkos::LayoutRight> entries;
  View<const LocalIndex*> column_of_entry;
  method::Coefficients nodal;  ///< p = 1: values at the vertices; empty: means of patches
  Metrics metric;
  Matrix constant;  ///< (i, m): ∫ lambda_i phi_m
  View<const double*> mean;
  CellTable patch;  ///< out

  KOKKOS_FUNCTION void operator()(int a) const {
    if (mean(a) >= 0) return;
    double sum = 0;
    int count = 0;
    for (LocalIndex e = patches.offset(a); e < patches.offset(a + 1); ++e)
      for (int i = 0; i < 3; ++i) {
        const LocalIndex k = patches.cell(e), entry = entries(k, i), b = patch_of_vertex(vertices(cells(k), i));
        if (nodal.extent(0) > 0 ? column_of_entry(entry) < 0 : b < 0 || mean(b) < 0) continue;
        sum += nodal.extent(0) > 0 ? nodal(entry) : mean(b);
        ++count;
      }
    const int modes = constant.extent_int(1);
    for (LocalIndex e = patches.offset(a); e < patches.offset(a + 1); ++e)
      for (int m = 0; m < modes; ++m)
        patch(patches.cell(e), patches.corner(e) * modes + m) =
            count > 0 ? sum / count * metric(patches.cell(e)).det * constant(patches.corner(e), m) : 0;
  }
};

class PatchwiseMultiplier final : public NonNegativeMultiplier {
 public:
  PatchwiseMultiplier(const method::PolynomialSpace& space, const std::vector<bool>& held)
      : space_(space),
        q_(space.flux_degree()),
        B_(reference::bernstein(space.basis().degree() - 1)),
        metric_(metrics(space.mesh(), space.cells())),
        patches_(vertex_patches(space.mesh(), space.cells(), held)),
        patch_of_vertex_("thixis::equilibration::patch_of_vertex", space.mesh().vertices),
        mean_("thixis::equilibration::patch_mean", patches_.size()),
        cell_mean_("thixis::equilibration::cell_mean", space.cells().extent(0)),
        shared_("thixis::equilibration::shared_moments", space.cells().extent(0), space.basis().size()) {
    Kokkos::deep_copy(patch_of_vertex_, -1);
    const auto patch_of_vertex = patch_of_vertex_;
    const auto vertex = patches_.vertex;
    Kokkos::parallel_for(
        "thixis::equilibration::patch_of_vertex", Kokkos::RangePolicy<>(0, patches_.size()),
        KOKKOS_LAMBDA(int a) { patch_of_vertex(vertex(a)) = a; });
    tabulate();
    set_up();
    set_up_means();
  }

  void operator()(const algebra::Vector& moments, const CellTable& density, const CellTable& patch) const override {
    // values at contact points as coefficients: u = moments at the unknowns, zero at held ones
    algebra::Vector all(space_.map());
    {
      const auto in = algebra::host_view(moments);
      const auto out = algebra::host_view(all);
      for (std::size_t l = 0; l < in.extent(0); ++l) out(l) = in(l);
    }
    const auto at_entries =
        space_.complete(all, method::Coefficients("thixis::equilibration::nothing", space_.coefficients().entries.size()));
    space_.share(all, shared_);
    const auto shared = shared_, of_mean = of_mean_;
    const auto cell_mean = cell_mean_;
    Kokkos::parallel_for(
        "thixis::equilibration::cell_means", Kokkos::RangePolicy<>(0, cell_mean.extent_int(0)), KOKKOS_LAMBDA(int k) {
          double sum = 0, known = 0;
          for (int l = 0; l < shared.extent_int(1); ++l) {
            sum += of_mean(k, l) * shared(k, l);
            known += of_mean(k, l);
          }
          cell_mean(k) = known > 0 ? sum : -1;
        });
    const mesh::Mesh& mesh = space_.mesh();
    Kokkos::parallel_for("thixis::equilibration::fit_multiplier", Kokkos::RangePolicy<>(0, patches_.size()),
                         FitPatch{patches_, data_, mesh.coordinates, mesh.cell_vertices, space_.cells(), metric_, B_.degree, lattice_,
                                  from_lattice_, hat_integral_, hat_modal_, at_entries, cell_mean_, patch, mean_});
    Kokkos::parallel_for("thixis::equilibration::fill_empty_patches", Kokkos::RangePolicy<>(0, patches_.size()),
                         FillEmpty{patches_, patch_of_vertex_, mesh.cell_vertices, space_.cells(), space_.coefficients().element_entries,
                                   space_.numbering().column_of_entry, nodal_values(moments), metric_, constant_, mean_, patch});
    const int modes = density.extent_int(1);
    Kokkos::parallel_for(
        "thixis::equilibration::sum_patches", Kokkos::RangePolicy<>(0, density.extent_int(0)), KOKKOS_LAMBDA(int K) {
          for (int m = 0; m < modes; ++m) density(K, m) = patch(K, m) + patch(K, modes + m) + patch(K, 2 * modes + m);
        });
  }

  std::size_t bytes() const override {
    return sizeof(double) * (data_.fit.size() + data_.hat.size()) + sizeof(LocalIndex) * (data_.node.size() + patches_.cell.size());
  }

 private:
  /// lambda_h at the vertices for p = 1, with those of other ranks; empty otherwise.
  method::Coefficients nodal_values(const algebra::Vector& moments) const {
    if (B_.degree > 0) return {};
    algebra::Vector values(space_.map());
    {
      const auto M = algebra::host_view(moments), D = algebra::host_view(space_.pairing());
      const auto out = algebra::host_overwrite(values);
      for (std::size_t l = 0; l < M.extent(0); ++l) out(l) = M(l) / D(l);
    }
    return space_.complete(values, method::Coefficients("thixis::equilibration::nothing", space_.coefficients().entries.size()));
  }

  void tabulate() {
    const reference::Modal modal(q_ + 1);
    const int n = B_.size, modes = reference::dimension(q_), wide = modal.size();
    lattice_ = matrix("thixis::equilibration::lattice", n, 3, bernstein_lattice(B_));
    from_lattice_ = matrix("thixis::equilibration::from_lattice", n, n, equilibration::from_lattice(B_));
    const auto T = bernstein_to_modal(B_, modal, wide);
    const Kokkos::View<double***, Kokkos::LayoutRight> hat_modal("thixis::equilibration::hat_modal", 3, modes, n);
    const auto host = Kokkos::create_mirror_view(hat_modal);
    std::vector<double> integral, constant;
    for (int i = 0; i < 3; ++i) {
      for (int m = 0; m < modes; ++m)
        for (int b = 0; b < n; ++b)
          for (int k = 0; k < wide; ++k) host(i, m, b) += modal.times_barycentric(i)[m * wide + k] * T[k * n + b];
      for (int b = 0; b < n; ++b) integral.push_back(host(i, 0, b) * std::sqrt(0.5));
      for (int m = 0; m < modes; ++m) {
        constant.push_back(0);
        for (int b = 0; b < n; ++b) constant.back() += host(i, m, b);
      }
    }
    Kokkos::deep_copy(hat_modal, host);
    hat_modal_ = hat_modal;
    hat_integral_ = matrix("thixis::equilibration::hat_integral", 3, n, integral);
    constant_ = matrix("thixis::equilibration::hat_constant", 3, modes, constant);
  }

  /// Functions of each patch, and the fit of polynomials of degree p - 1 to their moments.
  void set_up() {
    const auto& basis = space_.basis();
    const auto host = mesh::on_host(space_.mesh());
    const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space_.cells());
    const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space_.coefficients().element_entries);
    const auto column = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space_.numbering().column_of_entry);
    const auto offset = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), patches_.offset);
    const auto cell = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), patches_.cell);
    const auto corner = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), patches_.corner);
    const auto vertex = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), patches_.vertex);
    const auto metric = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), metric_);
    const int p = basis.degree(), functions = basis.size(), n = B_.size;

    // hat functions in the basis, and ∫ psi_l B_b
    std::vector<std::vector<double>> hat(3, std::vector<double>(functions, 0.0));
    for (int i = 0; i < 3; ++i)
      for (int l = 0; l < functions; ++l)
        for (int m = 0; m < functions; ++m) {
          const double xi = basis.points()[2 * m], eta = basis.points()[2 * m + 1], lambda[3] = {1 - xi - eta, xi, eta};
          hat[i][l] += basis.from_values()[l * functions + m] * lambda[i];
        }
    const reference::Modal modal(p);
    const auto T = bernstein_to_modal(B_, modal, functions), psi = to_modal(basis, modal);
    std::vector<double> tested(functions * n, 0.0);  // (l, b)
    for (int l = 0; l < functions; ++l)
      for (int b = 0; b < n; ++b)
        for (int m = 0; m < functions; ++m) tested[l * n + b] += psi[m * functions + l] * T[m * n + b];
    const auto lattice = bernstein_lattice(B_), from_lattice = equilibration::from_lattice(B_);
    std::vector<double> tested_at_lattice(functions * n, 0.0);  // (l, v): values at the lattice -> moments
    for (int l = 0; l < functions; ++l)
      for (int r = 0; r < n; ++r)
        for (int v = 0; v < n; ++v) tested_at_lattice[l * n + v] += tested[l * n + r] * from_lattice[r * n + v];

    const LocalIndex count = patches_.size();
    std::vector<LocalIndex> node, node_offset(1, 0), fit_offset(1, 0);
    std::vector<double> c, fit, weight(count), diameter(count);
    std::vector<LocalIndex> local(entries.extent(0) > 0 ? space_.coefficients().entries.size() : 0, -1);
    std::vector<double> A, moment, at_lattice(n * n), monomial(n);
    data_.place = View<double* [2]>("thixis::equilibration::place", count);
    const auto place = Kokkos::create_mirror_view(data_.place);
    for (LocalIndex a = 0; a < count; ++a) {
      const auto first = static_cast<LocalIndex>(node.size());
      double size = 0;
      for (int d = 0; d < 2; ++d) place(a, d) = host.coordinates(vertex(a), d);
      for (LocalIndex e = offset(a); e < offset(a + 1); ++e)
        for (int i = 0; i < 3; ++i) {
          const LocalIndex v = host.cell_vertices(cells(cell(e)), i);
          const double dx = host.coordinates(v, 0) - place(a, 0), dy = host.coordinates(v, 1) - place(a, 1);
          size = std::max(size, dx * dx + dy * dy);
        }
      size = std::sqrt(size);
      diameter[a] = size;
      for (LocalIndex e = offset(a); e < offset(a + 1); ++e)
        for (int l = 0; l < functions; ++l) {
          const LocalIndex entry = entries(cell(e), l);
          if (!inside_patch(basis.entities()[l], corner(e)) || column(entry) < 0) continue;
          if (local[entry] < 0) {
            local[entry] = static_cast<LocalIndex>(node.size());
            node.push_back(entry);
            c.push_back(hat[corner(e)][l]);
          }
          weight[a] += hat[corner(e)][l] * metric(cell(e)).det * basis.integrals()[l];
        }
      const LocalIndex nodes = static_cast<LocalIndex>(node.size()) - first;
      if (p > 1 && nodes >= n) {
        // A(l, b) = (monomial_b, psi_l) over the patch, relative to its area
        A.assign(nodes * n, 0.0);
        for (LocalIndex e = offset(a); e < offset(a + 1); ++e) {
          const LocalIndex k = cell(e);
          for (int v = 0; v < n; ++v) {
            double at[2] = {0, 0};
            for (int i = 0; i < 3; ++i)
              for (int d = 0; d < 2; ++d) at[d] += lattice[3 * v + i] * host.coordinates(host.cell_vertices(cells(k), i), d);
            monomials(B_.degree, (at[0] - place(a, 0)) / size, (at[1] - place(a, 1)) / size, monomial.data());
            for (int b = 0; b < n; ++b) at_lattice[v * n + b] = monomial[b];
          }
          for (int l = 0; l < functions; ++l) {
            const LocalIndex entry = entries(k, l), at = local[entry];
            if (!inside_patch(basis.entities()[l], corner(e)) || at < 0) continue;
            for (int b = 0; b < n; ++b) {
              double sum = 0;
              for (int v = 0; v < n; ++v) sum += tested_at_lattice[l * n + v] * at_lattice[v * n + b];
              A[(at - first) * n + b] += metric(k).det * sum;
            }
          }
        }
        append_fit(A, nodes, n, fit);
      }
      for (LocalIndex l = first; l < first + nodes; ++l) local[node[l]] = -1;
      node_offset.push_back(static_cast<LocalIndex>(node.size()));
      fit_offset.push_back(static_cast<LocalIndex>(fit.size()));
    }
    Kokkos::deep_copy(data_.place, place);
    data_.node_offset = to_view("thixis::equilibration::node_offset", node_offset);
    data_.node = to_view("thixis::equilibration::patch_nodes", node);
    data_.hat = to_view("thixis::equilibration::hat", c);
    data_.fit_offset = to_view("thixis::equilibration::fit_offset", fit_offset);
    data_.fit = to_view("thixis::equilibration::fit", fit);
    data_.weight = to_view("thixis::equilibration::patch_weight", weight);
    data_.diameter = to_view("thixis::equilibration::patch_diameter", diameter);
  }

  /// The mean of lambda in a cell is that of the values moment / (1, psi_l) of its free functions, with weights (1, psi_l)_K: exact for
  /// constants next to the held boundary and between cells of different sizes, too.
  void set_up_means() {
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
    of_mean_ = CellTable("thixis::equilibration::of_mean", cells, basis.size());
    const CellTable shared("thixis::equilibration::shared_integrals", cells, basis.size());
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

  template <class T>
  static View<T*> to_view(const std::string& label, const std::vector<T>& values) {
    const View<T*> view(label, values.size());
    const auto host = Kokkos::create_mirror_view(view);
    std::copy(values.begin(), values.end(), host.data());
    Kokkos::deep_copy(view, host);
    return view;
  }

  /// Appends (A^T A)^{-1} A^T; nothing if the moments do not determine the polynomial.
  static void append_fit(const std::vector<double>& A, LocalIndex nodes, int n, std::vector<double>& fit) {
    double scale = 0;
    for (const double value : A) scale = std::max(scale, std::abs(value));
    double normal[most_coefficients][2 * most_coefficients] = {};
    for (int i = 0; i < n; ++i) {
      normal[i][n + i] = 1;
      for (int j = 0; j < n; ++j)
        for (LocalIndex l = 0; l < nodes; ++l) normal[i][j] += A[l * n + i] * A[l * n + j] / (scale * scale);
    }
    for (int k = 0; k < n; ++k) {  // Gauss–Jordan: the matrix is symmetric and positive, or the patch has no fit
      if (!(normal[k][k] > 1e-9)) return;
      const double pivot = normal[k][k];
      for (int j = 0; j < 2 * n; ++j) normal[k][j] /= pivot;
      for (int i = 0; i < n; ++i) {
        const double factor = normal[i][k];
        if (i == k || factor == 0) continue;
        for (int j = 0; j < 2 * n; ++j) normal[i][j] -= factor * normal[k][j];
      }
    }
    for (int b = 0; b < n; ++b)
      for (LocalIndex l = 0; l < nodes; ++l) {
        double sum = 0;
        for (int j = 0; j < n; ++j) sum += normal[b][n + j] * A[l * n + j];
        fit.push_back(sum / (scale * scale));
      }
  }

  const method::PolynomialSpace& space_;
  int q_;
  reference::Bernstein B_;  ///< of degree p - 1
  Metrics metric_;
  VertexPatches patches_;
  View<LocalIndex*> patch_of_vertex_;
  View<double*> mean_, cell_mean_;
  CellTable shared_, of_mean_;
  Fits data_;
  Matrix lattice_, from_lattice_, hat_integral_, constant_;
  Kokkos::View<const double***, Kokkos::LayoutRight> hat_modal_;
};

}  // namespace

std::unique_ptr<NonNegativeMultiplier> patchwise_multiplier(const method::PolynomialSpace& space, const std::vector<bool>& held) {
  return std::make_unique<PatchwiseMultiplier>(space, held);
}

}  // namespace thixis::equilibration
