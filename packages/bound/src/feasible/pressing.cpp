#include "feasible/pressing.hpp"

#include <algorithm>
#include <cmath>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/mesh/host.hpp"

namespace thixis::bound {
namespace {

/// Functions with a smaller share of the cell say nothing about a constant multiplier.
constexpr double no_mean = 1e-3;

/// ∫ max(v, 0) of a polynomial in Bernstein coefficients over the reference triangle, by the midpoints of equal parts.
double positive_part(const reference::Bernstein& B, const double* c) {
  constexpr int sides = 48;
  double sum = 0;
  const auto add = [&](double xi, double eta) {
    const double lambda[3] = {1 - xi - eta, xi, eta};
    sum += std::max(B.value(c, lambda), 0.0) / (2.0 * sides * sides);
  };
  for (int i = 0; i < sides; ++i)
    for (int j = 0; i + j < sides; ++j) {
      add((i + 1.0 / 3) / sides, (j + 1.0 / 3) / sides);
      if (i + j + 1 < sides) add((i + 2.0 / 3) / sides, (j + 2.0 / 3) / sides);
    }
  return sum;
}

double stiffness(const FeasibleParts& kernel, LocalIndex K) {
  return kernel.move_tension.extent(0) > 0 ? kernel.move_tension(K) : kernel.constant_move_tension;
}

/// Whether functions with a mean leave a gap that can be compared with those at vertices: where membranes come apart, quadratically, it is
/// a quarter half the way to a vertex.
bool comes_apart(const FeasibleParts& kernel, LocalIndex K) {
  double at_vertices = 0, at_others = 0;
  for (int l = 0; l < kernel.functions.size(); ++l) {
    const LocalIndex e = kernel.of_cells(K, l);
    double& most = l >= kernel.first_vertex && l < kernel.first_vertex + 3 ? at_vertices : at_others;
    most = std::max(most, kernel.s_c[0](e) - kernel.s_c[1](e));
  }
  return at_others > at_vertices / 16;
}

/// Whether the gap of s_N is nowhere below |D|, by its Bernstein coefficients.
bool is_open(const FeasibleParts& kernel, LocalIndex K) {
  double gap[reference::max_functions] = {}, c[reference::max_functions] = {};
  const int n = kernel.functions.size();
  for (int l = 0; l < n; ++l) {
    const LocalIndex e = kernel.of_cells(K, l);
    gap[l] = std::max(kernel.s_c[0](e) - kernel.s_c[1](e), 0.0);
  }
  kernel.functions.to_bernstein(gap, c);
  return *std::min_element(c, c + n) >= kernel.deviation.bound(kernel.deviation(K));
}

}  // namespace

Pressing::Pressing(const method::PolynomialSpace& space, const FeasibleParts& kernel, const std::vector<bool>& dirichlet,
                   const std::vector<bool>& keeps)
    : mesh_(space.mesh()) {
  const reference::CellBasis& basis = space.basis();
  const bool functions = std::abs(basis.integrals()[basis.interior()]) < no_mean / basis.size();
  const bool deviates = mesh_.comm.any(kernel.deviation.place.extent(0) > 0);
  if (!functions && !deviates) return;
  std::vector<GlobalIndex> own_ids;
  for (LocalIndex v = 0; v < mesh_.vertices; ++v)
    if (mesh_.vertex_owner[v] == mesh_.comm.rank()) {
      own_.push_back(v);
      own_ids.push_back(mesh_.vertex_id[v]);
    }
  import_ = Teuchos::rcp(new algebra::Import(algebra::map_of(own_ids, mesh_.comm), algebra::map_of(mesh_.vertex_id, mesh_.comm)));
  if (functions) integrate_functions(kernel, dirichlet);
  if (deviates) integrate_deviation(kernel, keeps);
}

Pressing::~Pressing() = default;

Pressing::Columns Pressing::columns() const {
  Columns columns;
  for (auto& column : columns) column.assign(mesh_.vertices, 0.0);
  return columns;
}

Pressing::Columns Pressing::sum(const Columns& columns) const {
  algebra::MultiVector own(import_->getSourceMap(), columns.size()), all(import_->getTargetMap(), columns.size());
  {
    const auto out = all.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (std::size_t c = 0; c < columns.size(); ++c)
      for (LocalIndex v = 0; v < mesh_.vertices; ++v) out(v, c) = columns[c][v];
  }
  own.doExport(all, *import_, Tpetra::ADD);
  all.doImport(own, *import_, Tpetra::INSERT);
  Columns sums = columns;
  const auto in = all.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t c = 0; c < columns.size(); ++c)
    for (LocalIndex v = 0; v < mesh_.vertices; ++v) sums[c][v] = in(v, c);
  return sums;
}

void Pressing::integrate_functions(const FeasibleParts& kernel, const std::vector<bool>& dirichlet) {
  const auto host = mesh::on_host(mesh_);
  const auto held = method::held_vertices(mesh_, dirichlet);
  const int n = kernel.functions.size();
  double c[3][reference::max_functions];
  for (int i = 0; i < 3; ++i) {
    double unit[reference::max_functions] = {};
    unit[kernel.first_vertex + i] = 1;
    kernel.functions.to_bernstein(unit, c[i]);
    positive_[i] = 2 * positive_part(kernel.functions.B, c[i]);
  }
  Columns of_vertices = columns();
  for (LocalIndex K = 0; K < mesh_.owned_cells; ++K) {
    const auto geometry = mesh::cell_geometry(host.coordinates, host.cell_vertices, K);
    for (int i = 0; i < 3; ++i)
      of_vertices[0][host.cell_vertices(K, i)] += stiffness(kernel, K) * gradient_square(kernel.energy.products, geometry, n, c[i]);
  }
  stiffness_ = sum(of_vertices)[0];
  for (LocalIndex v = 0; v < mesh_.vertices; ++v)
    if (held[v] >= 0) stiffness_[v] = 0;
  closed_ = View<double*>("thixis::bound::closed", mesh_.vertices);
}

void Pressing::integrate_deviation(const FeasibleParts& kernel, const std::vector<bool>& keeps) {
  const Deviation& D = kernel.deviation;
  const auto host = mesh::on_host(mesh_);
  place_ = D.place;
  mean_of_positive_.assign(D.bound.extent(0), 0.0);
  Columns of_vertices = columns();
  for (LocalIndex v = 0; v < mesh_.vertices; ++v) of_vertices[1][v] = keeps[v] ? 1 : 0;
  for (LocalIndex K = 0; K < mesh_.owned_cells; ++K) {
    const LocalIndex place = D(K);
    if (place < 0) continue;
    const double area = mesh::cell_area(host.coordinates, host.cell_vertices, K);
    double square = 0;
    const PointsOf points(D.quadrature, place);
    for (int q = 0; q < points.count; ++q) {
      const GlobalIndex at = points.first + q;
      mean_of_positive_[place] += 2 * points.weight(q) * std::max(D.at_points(at, 0), 0.0);
      square += 2 * area * points.weight(q) * (std::pow(D.at_points(at, 1), 2) + std::pow(D.at_points(at, 2), 2));
    }
    for (int i = 0; i < 3; ++i) {
      of_vertices[0][host.cell_vertices(K, i)] += stiffness(kernel, K) * square;
      if (!D.on_held(place, i)) continue;
      for (int end = 1; end < 3; ++end) of_vertices[1][host.cell_vertices(K, (i + end) % 3)] += 1;
    }
  }
  const Columns sums = sum(of_vertices);
  cost_ = sums[0];
  for (LocalIndex v = 0; v < mesh_.vertices; ++v)
    if (sums[1][v] > 0) cost_[v] = 0;
  followed_ = View<double*>("thixis::bound::followed", mesh_.vertices);
}

void Pressing::operator()(const FeasibleParts& kernel) {
  if (import_.is_null()) return;
  const auto host = mesh::on_host(mesh_);
  Columns of_vertices = columns();
  for (LocalIndex K = 0; K < mesh_.owned_cells; ++K) {
    const double force = kernel.lambda(K, 0) * std::sqrt(0.5);
    const LocalIndex place = place_.extent(0) > 0 ? place_(K) : -1;
    const bool apart = closed_.extent(0) > 0 && comes_apart(kernel, K), open = place >= 0 && is_open(kernel, K);
    for (int i = 0; i < 3; ++i) {
      const LocalIndex v = host.cell_vertices(K, i);
      of_vertices[0][v] += positive_[i] * force;
      if (place >= 0) of_vertices[1][v] += mean_of_positive_[place] * force;
      if (apart) of_vertices[2][v] += 1;
      if (open) of_vertices[3][v] += 1;
    }
  }
  const Columns sums = sum(of_vertices);
  const auto ratio = [](double gain, double cost) { return cost > 0 && gain > 0 ? gain / cost : 0; };
  for (std::size_t v = 0; v < closed_.extent(0); ++v) closed_(v) = sums[2][v] > 0 ? 0 : ratio(sums[0][v], 2 * stiffness_[v]);
  for (std::size_t v = 0; v < followed_.extent(0); ++v) followed_(v) = sums[3][v] > 0 ? 0 : std::min(1.0, ratio(sums[1][v], cost_[v]));
}

std::size_t Pressing::bytes() const {
  return sizeof(double) * (stiffness_.size() + mean_of_positive_.size() + cost_.size() + closed_.size() + followed_.size());
}

}  // namespace thixis::bound
