#include "root_flux.hpp"

#include <cmath>
#include <numeric>

#include "thixis/algebra/solver.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/method/graph.hpp"
#include "thixis/method/form.hpp"

namespace thixis::equilibration {
namespace {

/// Row of each vertex of a whole mesh, -1 where it is held, or rests because nothing else of its piece is held.
std::vector<LocalIndex> free_vertices(const mesh::Mesh& mesh, const std::vector<bool>& held, const std::vector<LocalIndex>& at_rest) {
  auto tag = method::held_vertices(mesh, held);
  for (const LocalIndex v : at_rest) tag[v] = 0;
  std::vector<LocalIndex> row(mesh.vertices);
  LocalIndex count = 0;
  for (LocalIndex v = 0; v < mesh.vertices; ++v) row[v] = tag[v] >= 0 ? -1 : count++;
  return row;
}

/// The pieces of a whole mesh that nothing holds: of every cell the number of its piece, -1 if that is held.
struct FreePieces {
  std::vector<int> of_cell;
  std::vector<double> area;
  std::vector<LocalIndex> vertex;  ///< one of each piece

  FreePieces(const mesh::Mesh& mesh, const std::vector<bool>& held, const Metrics& metric) : of_cell(mesh.cells, -1) {
    const auto host = mesh::on_host(mesh);
    const auto tag = method::held_vertices(mesh, held);
    const auto det = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), metric);
    std::vector<LocalIndex> above(mesh.vertices);  // towards the one that stands for the piece
    std::iota(above.begin(), above.end(), 0);
    const auto top = [&](LocalIndex v) {
      while (above[v] != v) v = above[v] = above[above[v]];
      return v;
    };
    for (LocalIndex K = 0; K < mesh.cells; ++K)
      for (int i = 1; i < 3; ++i) above[top(host.cell_vertices(K, i))] = top(host.cell_vertices(K, 0));
    std::vector<bool> is_held(mesh.vertices, false);
    for (LocalIndex v = 0; v < mesh.vertices; ++v)
      if (tag[v] >= 0) is_held[top(v)] = true;
    std::vector<int> piece(mesh.vertices, -1);
    for (LocalIndex K = 0; K < mesh.cells; ++K) {
      const LocalIndex v = top(host.cell_vertices(K, 0));
      if (is_held[v]) continue;
      if (piece[v] < 0) {
        piece[v] = static_cast<int>(area.size());
        area.push_back(0);
        vertex.push_back(v);
      }
      of_cell[K] = piece[v];
      area[piece[v]] += det(K).det / 2;
    }
  }

  /// r without its means on these pieces; the norm of what it loses.
  double take_means(const CellTable& r, const Metrics& metric) const {
    const auto values = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), r);
    const auto det = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), metric);
    std::vector<double> mean(area.size(), 0.0);
    for (std::size_t K = 0; K < of_cell.size(); ++K)
      if (of_cell[K] >= 0) mean[of_cell[K]] += std::sqrt(0.5) * values(K, 0) / area[of_cell[K]];
    for (std::size_t K = 0; K < of_cell.size(); ++K)
      if (of_cell[K] >= 0) values(K, 0) -= std::sqrt(0.5) * det(K).det * mean[of_cell[K]];
    Kokkos::deep_copy(r, values);
    double square = 0;
    for (std::size_t i = 0; i < area.size(); ++i) square += area[i] * mean[i] * mean[i];
    return std::sqrt(square);
  }
};

/// moments(k, i) = ∫_K r lambda_i from modal coefficients of r.
struct HatMoments {
  ConstCellTable r;
  Matrix first_row;   ///< (a, k): coefficient 0 of lambda_a phi_k
  CellTable moments;  ///< out
  KOKKOS_FUNCTION void operator()(int K) const {
    for (int a = 0; a < 3; ++a) {
      double sum = 0;
      for (int k = 0; k < first_row.extent_int(1); ++k) sum += first_row(a, k) * r(K, k);
      moments(K, a) = sum;
    }
  }
};

/// g(K, a, ·) = Pi_q(psi_a r) - grad rho·grad psi_a, w = -grad rho.
struct RootSources {
  ConstCellTable r;
  Metrics metric;
  Kokkos::View<const double***, Kokkos::LayoutRight> times;  ///< (a, l, k): lambda_a phi_k -> phi_l
  Kokkos::View<const double* [3], Kokkos::LayoutRight> rho;  ///< of the cell's vertices
  CellTable density, target;                                 ///< out

  KOKKOS_FUNCTION void operator()(int K) const {
    const int n = times.extent_int(1);
    const double d0 = rho(K, 1) - rho(K, 0), d1 = rho(K, 2) - rho(K, 0), root = Kokkos::Experimental::sqrt(0.5);
    const Metric& M = metric(K);
    const double w0 = -(M.G11 * d0 - M.G01 * d1), w1 = -(M.G00 * d1 - M.G01 * d0);  // G^{-1} grad rho, det G = 1
    for (int k = 0; k < target.extent_int(1); ++k) target(K, k) = 0;
    target(K, 0) = root * w0;
    target(K, n) = root * w1;
    const double of_vertex[3] = {-w0 - w1, w0, w1};  // density of -grad rho·grad lambda_a = ŵ·grad^ lambda_a
    for (int a = 0; a < 3; ++a)
      for (int l = 0; l < n; ++l) {
        double sum = l == 0 ? root * of_vertex[a] : 0;
        for (int k = 0; k < n; ++k) sum += times(a, l, k) * r(K, k);
        density(K, a * n + l) = sum;
      }
  }
};

}  // namespace

struct RootFlux::Impl {
  std::shared_ptr<const mesh::Mesh> mesh;
  int n;  ///< dim P_q
  View<const LocalIndex*> cells;
  Metrics metric;
  PatchFlux patches;
  FreePieces pieces;
  std::vector<LocalIndex> row;
  algebra::MatrixPtr A;
  std::unique_ptr<algebra::Solver> solver;  ///< none where every vertex is held
  Matrix first_row;
  Kokkos::View<double***, Kokkos::LayoutRight> times;
  CellTable moments, density, target;
  CellTable without_mean;  ///< of length 0 where every piece is held
  Kokkos::View<double* [3], Kokkos::LayoutRight> rho;

  Impl(std::shared_ptr<const mesh::Mesh> whole, const std::vector<bool>& held, int q)
      : mesh(std::move(whole)),
        n(reference::dimension(q)),
        cells(method::owned_cells(*mesh)),
        metric(metrics(*mesh, cells)),
        patches(*mesh, cells, held, q),
        pieces(*mesh, held, metric),
        row(free_vertices(*mesh, held, pieces.vertex)),
        moments("thixis::equilibration::hat_moments", mesh->cells, 3),
        density("thixis::equilibration::root_density", mesh->cells, 3 * n),
        target("thixis::equilibration::root_target", mesh->cells, 2 * n),
        without_mean("thixis::equilibration::without_mean", pieces.area.empty() ? 0 : mesh->cells, n),
        rho("thixis::equilibration::rho", mesh->cells) {
    const reference::Modal modal(q + 1);
    const int wide = modal.size();
    const Kokkos::View<double**, Kokkos::LayoutRight> first("thixis::equilibration::first_row", 3, n);
    times = Kokkos::View<double***, Kokkos::LayoutRight>("thixis::equilibration::times", 3, n, n);
    const auto first_host = Kokkos::create_mirror_view(first);
    const auto times_host = Kokkos::create_mirror_view(times);
    for (int a = 0; a < 3; ++a)
      for (int k = 0; k < n; ++k) {
        first_host(a, k) = modal.times_barycentric(a)[k] * std::sqrt(0.5);  // ∫ phi_0 = √(1/2)
        for (int l = 0; l < n; ++l) times_host(a, l, k) = modal.times_barycentric(a)[l * wide + k];
      }
    Kokkos::deep_copy(first, first_host);
    Kokkos::deep_copy(times, times_host);
    first_row = first;
    assemble();
  }

  void assemble() {
    LocalIndex count = 0;
    for (const LocalIndex r : row) count += r >= 0;
    if (count == 0) return;
    const auto map = algebra::contiguous_map(count, mesh->comm);
    const auto host = mesh::on_host(*mesh);
    const Kokkos::View<LocalIndex**, Kokkos::LayoutRight> unknowns("thixis::equilibration::root_unknowns", mesh->cells, 3);
    const method::LocalMatrices local("thixis::equilibration::root_stiffness", mesh->cells, 3, 3);
    const auto unknowns_host = Kokkos::create_mirror_view(unknowns);
    const auto local_host = Kokkos::create_mirror_view(local);
    const auto metric_host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), metric);
    constexpr double gradient[3][2] = {{-1, -1}, {1, 0}, {0, 1}};
    for (LocalIndex K = 0; K < mesh->cells; ++K) {
      const Metric& M = metric_host(K);
      for (int i = 0; i < 3; ++i) {
        unknowns_host(K, i) = row[host.cell_vertices(K, i)];
        for (int j = 0; j < 3; ++j) {
          const auto &d = gradient[i], &e = gradient[j];
          local_host(K, i, j) = 0.5 * (M.G11 * d[0] * e[0] - M.G01 * (d[0] * e[1] + d[1] * e[0]) + M.G00 * d[1] * e[1]);
        }
      }
    }
    Kokkos::deep_copy(unknowns, unknowns_host);
    Kokkos::deep_copy(local, local_host);
    A = Teuchos::rcp(new algebra::Matrix(method::make_graph(map, map, unknowns)));
    A->fillComplete();
    method::scatter(unknowns, 0, local, *A);
    algebra::LinearParams direct;
    direct.solver = algebra::SolverKind::direct;
    solver = std::make_unique<algebra::Solver>(direct);
    solver->set_matrix(A, 1, Teuchos::null);
  }

  void solve(const ConstCellTable& r) const {
    const auto host = mesh::on_host(*mesh);
    std::vector<double> value(mesh->vertices, 0.0);
    if (solver) {
      Kokkos::parallel_for("thixis::equilibration::hat_moments", Kokkos::RangePolicy<>(0, mesh->cells), HatMoments{r, first_row, moments});
      const auto parts = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), moments);
      algebra::Vector b(A->getRowMap()), x(A->getRowMap());
      {
        const auto rhs = algebra::host_view(b);
        for (LocalIndex K = 0; K < mesh->cells; ++K)
          for (int i = 0; i < 3; ++i)
            if (const LocalIndex l = row[host.cell_vertices(K, i)]; l >= 0) rhs(l) += parts(K, i);
      }
      if (b.norm2() > 0) {
        algebra::LinearStop stop;
        stop.tolerance = 1e-12 * b.norm2();
        const auto report = solver->solve(b, x, stop);
        if (!(report.residual <= 1e-8 * b.norm2()))
          throw core::Error(core::ExitCode::internal,
                            "The coarse problem of the algebraic error can not be solved: " + report.reason + ".");
      }
      const auto solution = algebra::host_view(std::as_const(x));
      for (LocalIndex v = 0; v < mesh->vertices; ++v)
        if (row[v] >= 0) value[v] = solution(row[v]);
    }
    const auto of_cells = Kokkos::create_mirror_view(rho);
    for (LocalIndex K = 0; K < mesh->cells; ++K)
      for (int i = 0; i < 3; ++i) of_cells(K, i) = value[host.cell_vertices(K, i)];
    Kokkos::deep_copy(rho, of_cells);
  }
};

RootFlux::RootFlux(std::shared_ptr<const mesh::Mesh> mesh, const std::vector<bool>& held, int q)
    : impl_(std::make_unique<Impl>(std::move(mesh), held, q)) {}
RootFlux::~RootFlux() = default;

double RootFlux::operator()(const ConstCellTable& given, const CellTable& sigma) const {
  const Impl& in = *impl_;
  ConstCellTable r = given;
  double left = 0;
  if (!in.pieces.area.empty()) {
    const CellTable copy = in.without_mean;
    Kokkos::parallel_for(
        "thixis::equilibration::copy_density", Kokkos::RangePolicy<>(0, copy.extent_int(0)), KOKKOS_LAMBDA(int K) {
          for (int k = 0; k < copy.extent_int(1); ++k) copy(K, k) = given(K, k);
        });
    left = in.pieces.take_means(copy, in.metric);
    r = copy;
  }
  in.solve(r);
  Kokkos::parallel_for("thixis::equilibration::root_sources", Kokkos::RangePolicy<>(0, in.mesh->cells),
                       RootSources{r, in.metric, in.times, in.rho, in.density, in.target});
  in.patches({in.density, in.target, {}}, sigma);
  return left;
}

std::size_t RootFlux::bytes() const {
  const Impl& in = *impl_;
  return in.patches.bytes() + sizeof(double) * (in.moments.size() + in.density.size() + in.target.size() + in.rho.size());
}

}  // namespace thixis::equilibration
