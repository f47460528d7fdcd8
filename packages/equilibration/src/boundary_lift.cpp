#include "boundary_lift.hpp"

#include <algorithm>
#include <cmath>

#include "thixis/algebra/solver.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/method/gradient_form.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::equilibration {
namespace {

constexpr int degree_of_v = 4;
constexpr int rows = 3;                                  ///< of cells; each step inwards costs and gains less
constexpr int order = 2 * BoundaryLift::resolution + 4;  ///< exact for |grad l|²

View<const LocalIndex*> to_view(const char* label, const std::vector<LocalIndex>& values) {
  const View<LocalIndex*> view(std::string(label), values.size());
  const auto host = Kokkos::create_mirror_view(view);
  std::copy(values.begin(), values.end(), host.data());
  Kokkos::deep_copy(view, host);
  return view;
}

/// sum_j q_j L_j(s) and its derivative, L_j orthonormal on [0,1].
std::array<double, 2> series(const std::array<double, BoundaryLift::resolution + 1>& q, double s) {
  const double x = 2 * s - 1;
  double P[3] = {0, 1, x}, dP[3] = {0, 0, 1}, value = q[0], slope = 0;  // of degrees j-2, j-1, j
  for (int j = 1; j <= BoundaryLift::resolution; ++j) {
    if (j > 1) {
      P[2] = ((2 * j - 1) * x * P[1] - (j - 1) * P[0]) / j;
      dP[2] = dP[0] + (2 * j - 1) * P[1];
    }
    const double norm = std::sqrt(2.0 * j + 1);
    value += q[j] * norm * P[2];
    slope += 2 * q[j] * norm * dP[2];
    for (int i = 0; i < 2; ++i) {
      P[i] = P[i + 1];
      dP[i] = dP[i + 1];
    }
  }
  return {value, slope};
}

}  // namespace

BoundaryLift::BoundaryLift(const method::PolynomialSpace& space, const ContinuousNodes& nodes,
                           const std::array<scene::FieldPtr, 2>& tension, const std::array<method::BoundaryValues, 2>& boundary,
                           const std::vector<double> (&held)[2], int count)
    : space_(space), host_(mesh::on_host(space.mesh())), count_(count), basis_(degree_of_v, reference::Family::bernstein) {
  for (const auto& value : boundary[0].dirichlet) dirichlet_.push_back(value != nullptr);
  const core::Comm& comm = space.mesh().comm;
  comm.together([&] { find_faces(nodes, boundary, held); });
  empty_ = !comm.any(!empty_);
  if (empty_) {
    blends_ = {};
    return;
  }
  find_layer();
  minimise(tension);
  integrate(tension);
}

void BoundaryLift::find_faces(const ContinuousNodes& nodes, const std::array<method::BoundaryValues, 2>& boundary,
                              const std::vector<double> (&held)[2]) {
  const auto rule = reference::line_quadrature(2 * resolution + 8);
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
    for (const double value : reference::legendre(resolution + 1, s)) legendre.push_back(value);

  blends_.resize(cells.extent(0));
  double largest = 0, size = 0;
  std::vector<double> x(points), y(points), g(points);
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
      Blend blend{i, {}, 0};
      std::vector<double> difference(points, 0.0);
      for (int alpha = 0; alpha < count_; ++alpha) {
        boundary[alpha].dirichlet[tag]->evaluate({x.size(), x.data(), y.data()}, 0, g.data());
        for (int q = 0; q < points; ++q) {
          double delta = g[q];
          for (int l = 0; l < n; ++l) delta -= trace[i].value[q * n + l] * held[alpha][of_cells(k, l)];
          largest = std::max(largest, std::abs(delta));
          size = std::max(size, std::abs(g[q]));
          difference[q] += alpha == 0 ? delta : -delta;
          const double s = rule.point[q], quotient = delta / (s * (1 - s));
          for (int j = 0; j <= resolution; ++j) blend.q[alpha][j] += rule.weight[q] * quotient * legendre[q * (resolution + 1) + j];
        }
      }
      for (const double d : difference) blend.difference = std::max(blend.difference, std::abs(d));
      blends_[k].push_back(blend);
    }
  empty_ = largest <= 1e-13 * size;
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
  std::vector<std::vector<Blend>> blends;
  for (std::size_t k = 0; k < cells.extent(0); ++k) {
    if (in(k) == 0) continue;
    layer.push_back(cells(k));
    blends.push_back(std::move(blends_[k]));
    if (cells(k) < mesh.owned_cells) owned.push_back(cells(k));
  }
  blends_ = std::move(blends);
  layer_ = to_view("thixis::equilibration::layer", layer);
  owned_ = to_view("thixis::equilibration::owned_layer", owned);
}

BoundaryLift::Value BoundaryLift::blended(int alpha, LocalIndex place, double xi, double eta) const {
  Value sum;
  if (blends_[place].empty()) return sum;
  const auto K = mesh::cell_geometry(host_.coordinates, host_.cell_vertices, layer_(place));
  const double lambda[3] = {1 - xi - eta, xi, eta};
  for (const Blend& blend : blends_[place]) {
    const int i = blend.face, j = (i + 1) % 3, k = (i + 2) % 3;
    const auto [q, slope] = series(blend.q[alpha], lambda[k] + 0.5 * lambda[i]);
    sum.value += lambda[j] * lambda[k] * q;
    for (int d = 0; d < 2; ++d)
      sum.gradient[d] += (K.gradient[j][d] * lambda[k] + lambda[j] * K.gradient[k][d]) * q +
                         lambda[j] * lambda[k] * slope * (K.gradient[k][d] + 0.5 * K.gradient[i][d]);
  }
  return sum;
}

BoundaryLift::Value BoundaryLift::operator()(int alpha, LocalIndex place, double xi, double eta) const {
  Value sum = blended(alpha, place, xi, eta);
  const auto K = mesh::cell_geometry(host_.coordinates, host_.cell_vertices, layer_(place));
  const double lambda[3] = {1 - xi - eta, xi, eta}, *const c = v_[alpha][place].data();
  double slope[3];
  sum.value += basis_.bernstein().value(c, lambda);
  basis_.bernstein().gradient(c, lambda, slope);
  for (int a = 0; a < 3; ++a)
    for (int d = 0; d < 2; ++d) sum.gradient[d] += slope[a] * K.gradient[a][d];
  return sum;
}

double BoundaryLift::bound_of_difference(LocalIndex place) const {
  double bound = 0, most = 0;
  for (const Blend& blend : blends_[place]) bound += 1.1 * blend.difference;  // seen at points only
  for (std::size_t k = 0; k < v_[0][place].size(); ++k)
    most = std::max(most, std::abs(v_[0][place][k] - (count_ == 2 ? v_[1][place][k] : 0)));
  return bound + most;
}

/// (mu grad v, grad w) = -(mu grad l, grad w) for all w like v.
void BoundaryLift::minimise(const std::array<scene::FieldPtr, 2>& tension) {
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
  Kokkos::View<LocalIndex**, Kokkos::LayoutRight> elements("thixis::equilibration::lift_elements", layer_.extent(0), n);
  for (std::size_t k = 0; k < layer_.extent(0); ++k)
    for (int l = 0; l < n; ++l) elements(k, l) = numbering.column_of_entry(of_cells(k, l));
  const auto graph = method::make_graph(numbering.rows, numbering.columns, elements);
  const method::CellQuadrature quadrature = method::make_quadrature(mesh, layer_, order, nullptr);

  for (int alpha = 0; alpha < count_; ++alpha) {
    auto A = Teuchos::rcp(new algebra::Matrix(graph));
    A->fillComplete();
    const auto form = method::gradient_form(mesh, quadrature, basis_, *tension[alpha]);
    const LocalIndex count = layer_.extent_int(0), most = std::min(method::cells_per_block(n), count);
    const method::LocalMatrices local("thixis::equilibration::lift_matrices", most, n, n);
    for (LocalIndex first = 0; first < count; first += most) {
      const method::LocalMatrices block = Kokkos::subview(local, std::pair(0, std::min(most, count - first)), Kokkos::ALL, Kokkos::ALL);
      form->matrices(first, block);
      method::scatter(elements, first, block, *A);
    }
    const CellTable moments("thixis::equilibration::lift_moments", count, n);
    View<double*> mu;
    const double* const constant = tension[alpha]->constant();
    if (!constant) mu = method::tension_at_points(mesh, quadrature, *tension[alpha]);
    for (LocalIndex k = 0; k < count; ++k) {
      if (blends_[k].empty()) continue;
      const auto K = mesh::cell_geometry(host_.coordinates, host_.cell_vertices, layer_(k));
      const PointsOf points(quadrature, k);
      for (int q = 0; q < points.count; ++q) {
        const double xi = points.xi(q, 0), eta = points.xi(q, 1), lambda[3] = {1 - xi - eta, xi, eta};
        const double weight = 2 * K.area * points.weight(q) * (constant ? *constant : mu(points.first + q));
        const Value l = blended(alpha, k, xi, eta);
        double dB[reference::max_functions][3];
        basis_.bernstein().derivatives(lambda, dB);
        for (int m = 0; m < n; ++m)
          for (int a = 0; a < 3; ++a)
            moments(k, m) -= weight * dB[m][a] * (l.gradient[0] * K.gradient[a][0] + l.gradient[1] * K.gradient[a][1]);
      }
    }
    algebra::Vector b(numbering.rows), x(numbering.rows);
    method::scatter(elements, 0, moments, b);
    algebra::LinearStop stop;
    stop.tolerance = 1e-10 * b.norm2();
    if (stop.tolerance > 0) {
      algebra::LinearParams cg;
      cg.solver = algebra::SolverKind::cg;
      cg.preconditioner = algebra::PreconditionerKind::ilu;
      algebra::Solver solver(cg);
      solver.set_matrix(A, 1, Teuchos::null);
      solver.solve(b, x, stop);  // any v will do, the best is wanted
    }
    algebra::Vector ghosted(numbering.columns);
    const auto import = graph->getImporter();
    if (import.is_null()) ghosted.assign(x);
    else ghosted.doImport(x, *import, Tpetra::INSERT);
    const auto in = algebra::host_view(std::as_const(ghosted));
    v_[alpha].assign(owned_.extent(0), std::vector<double>(n, 0.0));
    for (std::size_t k = 0; k < owned_.extent(0); ++k)
      for (int l = 0; l < n; ++l)
        if (elements(k, l) >= 0) v_[alpha][k][l] = in(elements(k, l));
  }
}

void BoundaryLift::integrate(const std::array<scene::FieldPtr, 2>& tension) {
  const mesh::Mesh& mesh = space_.mesh();
  const reference::Bernstein& B = space_.basis().bernstein();
  const method::CellQuadrature of_blends = method::make_quadrature(mesh, owned_, order, nullptr),
                               of_v = method::make_quadrature(mesh, owned_, 2 * degree_of_v, nullptr);
  const View<LocalIndex*> place("thixis::equilibration::place_in_layer", mesh.owned_cells);
  Kokkos::deep_copy(place, -1);
  const View<double* [2]> energy("thixis::equilibration::lift_energy", owned_.extent(0));
  const Kokkos::View<double***, Kokkos::LayoutRight> products("thixis::equilibration::lift_products", owned_.extent(0), 2, B.size);
  double sum = 0;
  for (int alpha = 0; alpha < count_; ++alpha) {
    View<double*> mu_of_blends, mu_of_v;
    const double* const constant = tension[alpha]->constant();
    if (!constant) {
      mu_of_blends = method::tension_at_points(mesh, of_blends, *tension[alpha]);
      mu_of_v = method::tension_at_points(mesh, of_v, *tension[alpha]);
    }
    for (std::size_t k = 0; k < owned_.extent(0); ++k) {
      place(owned_(k)) = static_cast<LocalIndex>(k);
      const auto K = mesh::cell_geometry(host_.coordinates, host_.cell_vertices, owned_(k));
      const bool blended_here = !blends_[k].empty();
      const PointsOf points(blended_here ? of_blends : of_v, static_cast<LocalIndex>(k));
      const auto& mu = blended_here ? mu_of_blends : mu_of_v;
      for (int q = 0; q < points.count; ++q) {
        const double xi = points.xi(q, 0), eta = points.xi(q, 1), lambda[3] = {1 - xi - eta, xi, eta};
        const double weight = 2 * K.area * points.weight(q) * (constant ? *constant : mu(points.first + q));
        const Value L = (*this)(alpha, static_cast<LocalIndex>(k), xi, eta);
        energy(k, alpha) += weight * (L.gradient[0] * L.gradient[0] + L.gradient[1] * L.gradient[1]);
        double dB[reference::max_functions][3];
        B.derivatives(lambda, dB);
        for (int m = 0; m < B.size; ++m)
          for (int a = 0; a < 3; ++a)
            products(k, alpha, m) += weight * dB[m][a] * (L.gradient[0] * K.gradient[a][0] + L.gradient[1] * K.gradient[a][1]);
      }
      sum += energy(k, alpha);
    }
  }
  energy_ = std::sqrt(mesh.comm.sum(sum));
  of_cells_ = {place, energy, products};
}

}  // namespace thixis::equilibration
