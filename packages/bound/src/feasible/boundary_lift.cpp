#include "feasible/boundary_lift.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "data/tables.hpp"
#include "thixis/algebra/solver.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/remoteness.hpp"
#include "thixis/method/gradient_form.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::bound {
namespace {

constexpr int degree_of_v = 4;
constexpr int rows = 3;  ///< of cells; each step inwards costs and gains less
/// Any v will do, and 1e-6 is near enough to the best one; but the bound is to be the same on any number of ranks.
constexpr double tolerance = 1e-10;
constexpr int order = 2 * LiftInCell::resolution + 4;  ///< exact for |grad l|²

/// Rules for the layer, with what is known at their points.
struct Rule {
  method::CellQuadrature quadrature;
  Tension mu;
  LiftTable table;

  Rule(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, int exact, const reference::Bernstein& of_v,
       const std::array<scene::FieldPtr, 2>& tension, int count)
      : quadrature(method::make_quadrature(mesh, cells, exact, nullptr)), table(of_v, quadrature.rule_xi) {
    for (int alpha = 0; alpha < count; ++alpha)
      if (const double* constant = tension[alpha]->constant()) mu.constant[alpha] = *constant;
      else mu.at_points[alpha] = method::tension_at_points(mesh, quadrature, *tension[alpha]);
  }
};

/// Makes of the derivatives of L in xi, eta at the points of cell k the weights f with (mu grad L, grad w)_K = sum_q f_1 ∂w/∂xi + f_2
/// ∂w/∂eta; returns |||L|||²_K.
double weigh(const Rule& rule, int alpha, LocalIndex k, const mesh::CellGeometry& K, std::vector<double> (&L)[3]) {
  const PointsOf points(rule.quadrature, k);
  const auto dot = [&](int a, int b) { return K.gradient[a][0] * K.gradient[b][0] + K.gradient[a][1] * K.gradient[b][1]; };
  const double G11 = dot(1, 1), G12 = dot(1, 2), G22 = dot(2, 2);
  double energy = 0;
  for (int q = 0; q < points.count; ++q) {
    const double weight = 2 * K.area * points.weight(q) * rule.mu(alpha, points.first + q), xi = L[1][q], eta = L[2][q];
    L[1][q] = weight * (G11 * xi + G12 * eta);
    L[2][q] = weight * (G12 * xi + G22 * eta);
    energy += L[1][q] * xi + L[2][q] * eta;
  }
  return energy;
}

/// (point, k): derivatives of Bernstein polynomials in xi, eta.
std::array<std::vector<double>, 2> derivatives(const reference::Bernstein& B, const View<const double* [2]>& points) {
  std::array<std::vector<double>, 2> table;
  const auto at = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), points);
  for (std::size_t q = 0; q < at.extent(0); ++q) {
    const double lambda[3] = {1 - at(q, 0) - at(q, 1), at(q, 0), at(q, 1)};
    double dB[reference::max_functions][3];
    B.derivatives(lambda, dB);
    for (int d = 0; d < 2; ++d)
      for (int k = 0; k < B.size; ++k) table[d].push_back(dB[k][1 + d] - dB[k][0]);
  }
  return table;
}

/// sum[k] += factor sum_q f_1(q) ∂B_k/∂xi + f_2(q) ∂B_k/∂eta.
void add_products(double factor, const std::vector<double> (&f)[3], const std::array<std::vector<double>, 2>& dB, int n, double* sum) {
  for (int d = 0; d < 2; ++d) {
    const double* row = dB[d].data();
    for (const double weight : f[1 + d]) {
      for (int k = 0; k < n; ++k) sum[k] += factor * weight * row[k];
      row += n;
    }
  }
}

/// A face of a cell cut into equal pieces, with the functions on it at their ends.
class Pieces {
 public:
  static constexpr int count = 64;

  explicit Pieces(const reference::CellBasis& basis) : functions_(basis.size()) {
    constexpr double corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    for (int i = 0; i < 3; ++i) {
      std::vector<double> at;
      for (int m = 0; m <= count; ++m)
        for (int d = 0; d < 2; ++d) at.push_back((1 - s(m)) * corner[(i + 1) % 3][d] + s(m) * corner[(i + 2) % 3][d]);
      trace_[i] = basis.tabulate(count + 1, at.data()).value;
    }
    for (int m = 0; m <= count; ++m)
      for (const double value : reference::legendre(LiftInCell::resolution + 1, s(m))) legendre_.push_back(value);
  }
  static double s(int m) { return static_cast<double>(m) / count; }

  /// g <- g - g_h at the ends of the pieces of face i; `u`: coefficients in the cell.
  void subtract(int i, const double* u, std::vector<double>& g) const {
    for (int m = 0; m <= count; ++m)
      for (int l = 0; l < functions_; ++l) g[m] -= trace_[i][m * functions_ + l] * u[l];
  }
  /// delta <- rho.
  void subtract_lift(const LiftInCell::Series& q, std::vector<double>& delta) const {
    for (int m = 0; m <= count; ++m)
      for (int j = 0; j <= LiftInCell::resolution; ++j)
        delta[m] -= s(m) * (1 - s(m)) * q[j] * legendre_[m * (LiftInCell::resolution + 1) + j];
  }
  /// ∫_K |grad E|² of the extension of rho from the face from a to b into the triangle with the third vertex c.
  static double energy(const std::vector<double>& rho, const double (&a)[2], const double (&b)[2], const double (&c)[2]) {
    const double e[2] = {b[0] - a[0], b[1] - a[1]}, d[2] = {c[0] - a[0], c[1] - a[1]};
    const double length2 = e[0] * e[0] + e[1] * e[1], twice_area = std::abs(e[0] * d[1] - e[1] * d[0]);
    const double foot = (e[0] * d[0] + e[1] * d[1]) / length2, height2 = twice_area * twice_area / length2;
    double sum = 0;
    for (int m = 0; m < count; ++m) {
      const double slope = count * (rho[m + 1] - rho[m]), mean = 0.5 * (rho[m] + rho[m + 1]);
      const double across = slope * (0.5 * (s(m) + s(m + 1)) - foot) - mean;
      sum += (slope * slope / length2 + across * across / height2) / count;
    }
    return 0.5 * twice_area * sum;
  }

 private:
  int functions_;
  std::vector<double> trace_[3], legendre_;
};

/// Of |s (1 - s) q(s)| on the face, and of |lambda_j lambda_k q(lambda_k + lambda_i/2)| in the cell, for lambda_j lambda_k <= s (1 - s)
/// there: a polynomial of degree n is at most 1/cos(n pi/(2m)) times its largest value at the m > n zeros of a Chebyshev polynomial
/// (Ehlich, Zeller, Math. Z. 86, 1964, doi:10.1007/BF01111276).
double largest_on_face(const LiftInCell::Series& q) {
  constexpr int degree = LiftInCell::resolution + 2, zeros = 4 * degree;
  const double pi = std::acos(-1.0);
  double most = 0;
  for (int m = 0; m < zeros; ++m) {
    const double s = 0.5 + 0.5 * std::cos((m + 0.5) * pi / zeros);
    most = std::max(most, std::abs(s * (1 - s) * series(q, s)[0]));
  }
  return most / std::cos(pi * degree / (2 * zeros));
}

/// The largest of some values of a tension at points, all of them if it varies.
double largest_tension(const scene::Field& tension, const std::vector<double>& x, const std::vector<double>& y) {
  if (const double* constant = tension.constant()) return *constant;
  std::vector<double> mu(x.size());
  tension.evaluate({x.size(), x.data(), y.data()}, 0, mu.data());
  return *std::max_element(mu.begin(), mu.end());
}

}  // namespace

/// (mu grad v, grad w) in the layer, with what its right-hand side is made of.
struct BoundaryLift::Equations {
  method::Numbering numbering;
  Kokkos::View<LocalIndex**, Kokkos::LayoutRight> elements;  ///< (layer cell, i) -> column
  algebra::GraphPtr graph;
  bool constant;  ///< v does not depend on constant tensions: one matrix for both
  Rule rule;
  std::array<std::vector<double>, 2> derivatives;  ///< at the points of the rule
  std::unique_ptr<algebra::Solver> solver[2];
};

BoundaryLift::~BoundaryLift() = default;

BoundaryLift::BoundaryLift(const method::PolynomialSpace& space, const ContinuousNodes& nodes,
                           const std::array<scene::FieldPtr, 2>& tension, const std::array<method::BoundaryValues, 2>& boundary,
                           const std::vector<double> (&held)[2], int count, double time, const BoundaryLift* other)
    : space_(space), host_(mesh::on_host(space.mesh())), count_(count), time_(time), basis_(degree_of_v, reference::Family::bernstein) {
  for (const auto& value : boundary[0].dirichlet) dirichlet_.push_back(value != nullptr);
  const core::Comm& comm = space.mesh().comm;
  comm.together([&] { find_faces(nodes, tension, boundary, held); });
  empty_ = !comm.any(!empty_);
  if (empty_) {
    boundary_ = {};
    return;
  }
  find_layer();
  if (other) equations_ = other->equations_;
  if (!equations_) set_up_equations(tension);
  minimise();
  integrate(tension);
}

void BoundaryLift::find_faces(const ContinuousNodes& nodes, const std::array<scene::FieldPtr, 2>& tension,
                              const std::array<method::BoundaryValues, 2>& boundary, const std::vector<double> (&held)[2]) {
  const auto rule = reference::line_quadrature(2 * LiftInCell::resolution + 8);
  const int points = rule.size(), n = space_.basis().size();
  const auto of_cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), nodes.of_cells);
  const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space_.cells());
  std::vector<double> legendre;
  reference::Tabulation trace[3];
  constexpr double corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  for (int i = 0; i < 3; ++i) {
    std::vector<double> at;
    for (const double s : rule.point)
      for (int d = 0; d < 2; ++d) at.push_back((1 - s) * corner[(i + 1) % 3][d] + s * corner[(i + 2) % 3][d]);
    trace[i] = space_.basis().tabulate(points, at.data());
  }
  for (const double s : rule.point)
    for (const double value : reference::legendre(LiftInCell::resolution + 1, s)) legendre.push_back(value);

  const Pieces pieces(space_.basis());
  double largest = 0, size = 0;
  std::vector<double> x(points), y(points), g(points), fine_x(Pieces::count + 1), fine_y(fine_x), rho(fine_x), u(n);
  std::map<LocalIndex, double> left;  // of owned cells: sum over their faces of |||E|||
  for (std::size_t k = 0; k < cells.extent(0); ++k)
    for (int i = 0; i < 3; ++i) {
      const LocalIndex tag = host_.face_tag(host_.cell_faces(cells(k), i));
      if (tag < 0 || !dirichlet_[tag]) continue;
      const LocalIndex a = host_.cell_vertices(cells(k), (i + 1) % 3), b = host_.cell_vertices(cells(k), (i + 2) % 3);
      for (int q = 0; q < points; ++q) {
        const double s = rule.point[q];
        x[q] = (1 - s) * host_.coordinates(a, 0) + s * host_.coordinates(b, 0);
        y[q] = (1 - s) * host_.coordinates(a, 1) + s * host_.coordinates(b, 1);
      }
      if (boundary_.empty() || boundary_.back().position != static_cast<LocalIndex>(k))
        boundary_.push_back({static_cast<LocalIndex>(k), {}});
      OnBoundary& cell = boundary_.back();
      const LocalIndex c = host_.cell_vertices(cells(k), i);
      const double corners[3][2] = {{host_.coordinates(a, 0), host_.coordinates(a, 1)},
                                    {host_.coordinates(b, 0), host_.coordinates(b, 1)},
                                    {host_.coordinates(c, 0), host_.coordinates(c, 1)}};
      for (int m = 0; m <= Pieces::count; ++m) {
        fine_x[m] = (1 - Pieces::s(m)) * corners[0][0] + Pieces::s(m) * corners[1][0];
        fine_y[m] = (1 - Pieces::s(m)) * corners[0][1] + Pieces::s(m) * corners[1][1];
      }
      double square = 0;
      for (int alpha = 0; alpha < count_; ++alpha) {
        boundary[alpha].dirichlet[tag]->evaluate({x.size(), x.data(), y.data()}, time_, g.data());
        const auto [low, high] = std::minmax_element(g.begin(), g.end());
        const double by_place = mesh::remoteness(3, [&](int v, int d) { return corners[v][d]; }) * (*high - *low);
        size = std::max({size, boundary[alpha].dirichlet[tag]->cancelled(), by_place});
        LiftInCell& lift = cell.l[alpha];
        LiftInCell::Series& coefficient = lift.q[lift.faces];
        coefficient = {};
        lift.face[lift.faces++] = i;
        for (int q = 0; q < points; ++q) {
          double delta = g[q];
          for (int l = 0; l < n; ++l) delta -= trace[i].value[q * n + l] * held[alpha][of_cells(k, l)];
          largest = std::max(largest, std::abs(delta));
          size = std::max(size, std::abs(g[q]));
          const double s = rule.point[q], quotient = delta / (s * (1 - s));
          for (int j = 0; j <= LiftInCell::resolution; ++j)
            coefficient[j] += rule.weight[q] * quotient * legendre[q * (LiftInCell::resolution + 1) + j];
        }
        for (int l = 0; l < n; ++l) u[l] = held[alpha][of_cells(k, l)];
        boundary[alpha].dirichlet[tag]->evaluate({fine_x.size(), fine_x.data(), fine_y.data()}, time_, rho.data());
        pieces.subtract(i, u.data(), rho);
        for (const double delta : rho) largest = std::max(largest, std::abs(delta));
        pieces.subtract_lift(coefficient, rho);
        square += largest_tension(*tension[alpha], fine_x, fine_y) * Pieces::energy(rho, corners[0], corners[1], corners[2]);
      }
      if (static_cast<LocalIndex>(k) < space_.mesh().owned_cells) left[static_cast<LocalIndex>(k)] += std::sqrt(square);
    }
  largest_ = largest;
  empty_ = largest <= 1e-13 * size;
  if (empty_) return;
  for (const auto& [cell, energy] : left) remainder_.push_back({cell, energy});
}

/// Row by row: the cells that touch the held boundary, those that touch them, … The owner of a cell knows all cells around it.
void BoundaryLift::find_layer() {
  const mesh::Mesh& mesh = space_.mesh();
  const auto held = method::held_vertices(mesh, dirichlet_);
  const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space_.cells());
  std::vector<GlobalIndex> ids;
  for (std::size_t k = 0; k < cells.extent(0); ++k) ids.push_back(mesh.cell_id[cells(k)]);
  const auto own = algebra::map_of({ids.begin(), ids.begin() + mesh.owned_cells}, mesh.comm);
  const auto all = algebra::map_of(ids, mesh.comm);
  const algebra::Import import(own, all);
  algebra::Vector touches(own), touches_all(all);
  std::vector<bool> reached(mesh.vertices);
  for (LocalIndex v = 0; v < mesh.vertices; ++v) reached[v] = held[v] >= 0;
  for (int row = 0; row < rows; ++row) {
    {
      const auto out = algebra::host_overwrite(touches);
      for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
        out(K) = 0;
        for (int i = 0; i < 3; ++i)
          if (reached[host_.cell_vertices(K, i)]) out(K) = 1;
      }
    }
    touches_all.doImport(touches, import, Tpetra::INSERT);
    const auto in = algebra::host_view(std::as_const(touches_all));
    for (std::size_t k = 0; k < cells.extent(0); ++k)
      for (int i = 0; i < 3 && in(k) != 0; ++i) reached[host_.cell_vertices(cells(k), i)] = true;
  }
  const auto in = algebra::host_view(std::as_const(touches_all));
  std::vector<LocalIndex> layer, owned;
  auto next = boundary_.begin();
  for (std::size_t k = 0; k < cells.extent(0); ++k) {
    if (in(k) == 0) continue;
    const bool on_boundary = next != boundary_.end() && next->position == static_cast<LocalIndex>(k);
    for (int alpha = 0; alpha < 2; ++alpha) lift_[alpha].push_back(on_boundary ? next->l[alpha] : LiftInCell());
    if (on_boundary) ++next;
    layer.push_back(cells(k));
    if (cells(k) < mesh.owned_cells) owned.push_back(cells(k));
  }
  boundary_ = {};
  layer_ = to_view("thixis::bound::layer", layer);
  owned_ = to_view("thixis::bound::owned_layer", owned);
}

BoundaryLift::Value BoundaryLift::operator()(int alpha, LocalIndex place, double xi, double eta) const {
  const auto K = mesh::cell_geometry(host_.coordinates, host_.cell_vertices, layer_(place));
  const LiftInCell& lift = lift_[alpha][place];
  const double lambda[3] = {1 - xi - eta, xi, eta};
  double slope[3];
  Value sum;
  sum.value = basis_.bernstein().value(lift.v.data(), lambda);
  basis_.bernstein().gradient(lift.v.data(), lambda, slope);
  for (int f = 0; f < lift.faces; ++f) {
    const int i = lift.face[f], j = (i + 1) % 3, k = (i + 2) % 3;
    const auto [q, dq] = series(lift.q[f], lambda[k] + 0.5 * lambda[i]);
    sum.value += lambda[j] * lambda[k] * q;
    slope[i] += 0.5 * lambda[j] * lambda[k] * dq;
    slope[j] += lambda[k] * q;
    slope[k] += lambda[j] * q + lambda[j] * lambda[k] * dq;
  }
  for (int a = 0; a < 3; ++a)
    for (int d = 0; d < 2; ++d) sum.gradient[d] += slope[a] * K.gradient[a][d];
  return sum;
}

LiftInCell BoundaryLift::difference(LocalIndex place) const {
  LiftInCell difference = lift_[0][place];
  if (count_ == 1) return difference;
  const LiftInCell& lower = lift_[1][place];
  for (std::size_t k = 0; k < lower.v.size(); ++k) difference.v[k] -= lower.v[k];
  for (int f = 0; f < lower.faces; ++f)
    for (std::size_t j = 0; j < lower.q[f].size(); ++j) difference.q[f][j] -= lower.q[f][j];
  return difference;
}

double BoundaryLift::bound_of_difference(LocalIndex place) const {
  const LiftInCell D = difference(place);
  double bound = 0;
  for (const double v : D.v) bound = std::max(bound, std::abs(v));
  for (int f = 0; f < D.faces; ++f) bound += largest_on_face(D.q[f]);
  return bound;
}

void BoundaryLift::set_up_equations(const std::array<scene::FieldPtr, 2>& tension) {
  const mesh::Mesh& mesh = space_.mesh();
  const int n = basis_.size();
  ContinuousNodes nodes = continuous_nodes(mesh, layer_, basis_, basis_.points(), dirichlet_);
  const auto of_cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), nodes.of_cells);
  {  // the rim: faces whose other cell is outside of the layer; owners of nodes have all their cells
    std::vector<bool> in_layer(mesh.cells, false), rim(mesh.vertices, false);
    for (std::size_t k = 0; k < layer_.extent(0); ++k) in_layer[layer_(k)] = true;
    const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space_.cells());
    for (std::size_t k = 0; k < cells.extent(0); ++k)
      for (int i = 0; i < 3 && !in_layer[cells(k)]; ++i) rim[host_.cell_vertices(cells(k), i)] = true;
    for (std::size_t k = 0; k < layer_.extent(0); ++k)
      for (int l = 0; l < n; ++l) {
        const auto& entity = basis_.entities()[l];
        LocalIndex& held = nodes.entries.held[of_cells(k, l)];
        if (held >= 0 || entity.kind == reference::Entity::interior) continue;
        const LocalIndex K = layer_(k);
        if (entity.kind == reference::Entity::vertex) {
          if (rim[host_.cell_vertices(K, entity.index)]) held = 0;
          continue;
        }
        const LocalIndex F = host_.cell_faces(K, entity.index), other = mesh::neighbour(host_.face_cells, F, K);
        if (host_.face_tag(F) < 0 && (other < 0 || !in_layer[other])) held = 0;
      }
  }
  const method::Numbering numbering = method::number(nodes.entries, mesh.comm);
  const LocalIndex count = layer_.extent_int(0);
  const Kokkos::View<LocalIndex**, Kokkos::LayoutRight> elements("thixis::bound::lift_elements", count, n);
  for (LocalIndex k = 0; k < count; ++k)
    for (int l = 0; l < n; ++l) elements(k, l) = numbering.column_of_entry(of_cells(k, l));
  const auto graph = method::make_graph(numbering.rows, numbering.columns, elements);
  const bool constant = tension[0]->constant() && (count_ == 1 || tension[1]->constant());
  const std::array<scene::FieldPtr, 2> mu = constant ? std::array<scene::FieldPtr, 2>{scene::constant(1), scene::constant(1)} : tension;
  const Rule rule(mesh, layer_, order, basis_.bernstein(), mu, count_);
  const auto equations = std::make_shared<Equations>(
      Equations{numbering, elements, graph, constant, rule, derivatives(basis_.bernstein(), rule.quadrature.rule_xi), {}});
  const method::CellQuadrature of_v = method::make_quadrature(mesh, layer_, 2 * degree_of_v, nullptr);
  algebra::LinearParams cg;
  cg.solver = algebra::SolverKind::cg;
  cg.preconditioner = algebra::PreconditionerKind::ilu;
  for (int alpha = 0; alpha < (constant ? 1 : count_); ++alpha) {
    const auto A = Teuchos::rcp(new algebra::Matrix(graph));
    A->fillComplete();
    const auto form = method::gradient_form(mesh, of_v, basis_, *mu[alpha]);
    const LocalIndex most = std::min(method::cells_per_block(n), count);
    const method::LocalMatrices local("thixis::bound::lift_matrices", most, n, n);
    for (LocalIndex first = 0; first < count; first += most) {
      const method::LocalMatrices block = Kokkos::subview(local, std::pair(0, std::min(most, count - first)), Kokkos::ALL, Kokkos::ALL);
      form->matrices(first, block);
      method::scatter(elements, first, block, *A);
    }
    equations->solver[alpha] = std::make_unique<algebra::Solver>(cg);
    equations->solver[alpha]->set_matrix(A, 1, Teuchos::null);
  }
  equations_ = equations;
}

/// (mu grad v, grad w) = -(mu grad l, grad w) for all w like v.
void BoundaryLift::minimise() {
  const Equations& of = *equations_;
  const int n = basis_.size();
  const LocalIndex count = layer_.extent_int(0);
  std::vector<double> l[3];
  for (int alpha = 0; alpha < count_; ++alpha) {
    const CellTable moments("thixis::bound::lift_moments", count, n);
    for (LocalIndex k = 0; k < count; ++k) {
      if (lift_[alpha][k].faces == 0) continue;
      of.rule.table.evaluate(lift_[alpha][k], l);
      weigh(of.rule, alpha, k, mesh::cell_geometry(host_.coordinates, host_.cell_vertices, layer_(k)), l);
      add_products(-1, l, of.derivatives, n, &moments(k, 0));
    }
    algebra::Vector b(of.numbering.rows), x(of.numbering.rows);
    method::scatter(of.elements, 0, moments, b);
    algebra::LinearStop stop;
    stop.tolerance = tolerance * b.norm2();
    if (stop.tolerance > 0) of.solver[of.constant ? 0 : alpha]->solve(b, x, stop);
    algebra::Vector ghosted(of.numbering.columns);
    const auto import = of.graph->getImporter();
    if (import.is_null()) ghosted.assign(x);
    else ghosted.doImport(x, *import, Tpetra::INSERT);
    const auto in = algebra::host_view(std::as_const(ghosted));
    for (std::size_t k = 0; k < owned_.extent(0); ++k)
      for (int i = 0; i < n; ++i)
        if (of.elements(k, i) >= 0) lift_[alpha][k].v[i] = in(of.elements(k, i));
  }
}

/// By the rule for |grad L|² where there is a face, which is more than enough.
View<double* [2]> BoundaryLift::change(const BoundaryLift* before) const {
  const bool then = before && !before->empty_;
  if (empty_ && !then) return {};
  const BoundaryLift& layer = empty_ ? *before : *this;
  const mesh::Mesh& mesh = space_.mesh();
  const View<double* [2]> norm("thixis::bound::change_of_lift", mesh.owned_cells);
  const auto on_faces = method::make_quadrature(mesh, layer.owned_, order, nullptr),
             inside = method::make_quadrature(mesh, layer.owned_, 2 * degree_of_v, nullptr);
  const LiftTable of_faces = table(on_faces.rule_xi), of_inside = table(inside.rule_xi);
  std::vector<double> L[3], other[3];
  for (LocalIndex k = 0; k < layer.owned_.extent_int(0); ++k) {
    const LocalIndex K = layer.owned_(k);
    const double area = mesh::cell_area(host_.coordinates, host_.cell_vertices, K);
    for (int alpha = 0; alpha < count_; ++alpha) {
      const LiftInCell& lift = layer.lift_[alpha][k];
      const auto& rule = lift.faces > 0 ? on_faces : inside;
      const LiftTable& values = lift.faces > 0 ? of_faces : of_inside;
      values.evaluate(lift, L);
      if (then && !empty_) values.evaluate(before->lift_[alpha][k], other);
      double square = 0;
      for (int q = 0; q < values.points(); ++q) {
        const double difference = L[0][q] - (then && !empty_ ? other[0][q] : 0);
        square += 2 * area * rule.rule_weight(q) * difference * difference;
      }
      norm(K, alpha) = std::sqrt(square);
    }
  }
  return norm;
}

void BoundaryLift::integrate(const std::array<scene::FieldPtr, 2>& tension) {
  const mesh::Mesh& mesh = space_.mesh();
  const reference::Bernstein& B = space_.basis().bernstein();
  const Rule of_faces(mesh, owned_, order, basis_.bernstein(), tension, count_),
      inside(mesh, owned_, 2 * degree_of_v, basis_.bernstein(), tension, count_);
  const auto dB_of_faces = derivatives(B, of_faces.quadrature.rule_xi), dB_inside = derivatives(B, inside.quadrature.rule_xi);
  const View<LocalIndex*> place("thixis::bound::place_in_layer", mesh.owned_cells);
  Kokkos::deep_copy(place, -1);
  const View<double* [2]> energy("thixis::bound::lift_energy", owned_.extent(0));
  const Kokkos::View<double***, Kokkos::LayoutRight> products("thixis::bound::lift_products", owned_.extent(0), 2, B.size);
  double sum = 0;
  std::vector<double> L[3];
  for (LocalIndex k = 0; k < owned_.extent_int(0); ++k) {
    place(owned_(k)) = k;
    const auto K = mesh::cell_geometry(host_.coordinates, host_.cell_vertices, owned_(k));
    for (int alpha = 0; alpha < count_; ++alpha) {
      const bool on_face = lift_[alpha][k].faces > 0;
      const Rule& rule = on_face ? of_faces : inside;
      rule.table.evaluate(lift_[alpha][k], L);
      energy(k, alpha) = weigh(rule, alpha, k, K, L);
      add_products(1, L, on_face ? dB_of_faces : dB_inside, B.size, &products(k, alpha, 0));
      sum += energy(k, alpha);
    }
  }
  energy_ = std::sqrt(mesh.comm.sum(sum));
  of_cells_ = {place, energy, products};
}

}  // namespace thixis::bound
