#include "thixis/fv/flux_lift.hpp"

#include <algorithm>
#include <cmath>

#include "thixis/algebra/solver.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/fv/host.hpp"

namespace thixis::fv {
namespace {

using algebra::Vector;
using Range = Kokkos::RangePolicy<Vector::execution_space>;

/// The squared diagonal of the box around the domain. Collective.
double square_of_diagonal(const Grid& grid) {
  const auto vertex = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), grid.vertex);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> upper(4, -infinity);  // largest x, y, -x, -y
  for (LocalIndex v = 0; v < grid.vertices; ++v)
    for (int i = 0; i < 2; ++i) {
      upper[i] = std::max(upper[i], vertex(v, i));
      upper[2 + i] = std::max(upper[2 + i], -vertex(v, i));
    }
  grid.comm.max(upper);
  return std::pow(upper[0] + upper[2], 2) + std::pow(upper[1] + upper[3], 2);
}

struct TwoPointFluxes {
  View<const LocalIndex* [2]> face_cells;
  View<const double*> distance;
  View<const char*> held;
  decltype(std::declval<const Vector&>().getLocalViewDevice(Tpetra::Access::ReadOnly)) rho;
  int j;
  View<double**> sigma;  ///< out, column j overwritten

  KOKKOS_FUNCTION void operator()(LocalIndex F) const {
    const LocalIndex K = face_cells(F, 0), L = face_cells(F, 1);
    const double fall = L >= 0 ? rho(K, 0) - rho(L, 0) : held(F) ? rho(K, 0) : 0;
    sigma(F, j) = fall / distance(F);
  }
};

}  // namespace

struct FluxLift::Impl {
  Grid grid;
  View<char*> held;
  double c;
  algebra::MapPtr owned, all;
  Teuchos::RCP<const algebra::Import> import;
  algebra::MatrixPtr A;
  std::unique_ptr<algebra::Solver> solver;

  Impl(const Grid& on, const std::vector<bool>& held_faces) : grid(on), held("thixis::fv::held", on.faces) {
    const auto host = Kokkos::create_mirror_view(held);
    for (LocalIndex F = 0; F < grid.faces; ++F) host(F) = held_faces[F];
    Kokkos::deep_copy(held, host);
    const bool some = grid.comm.any(std::find(held_faces.begin(), held_faces.end(), true) != held_faces.end());
    c = some ? 0 : 1 / square_of_diagonal(grid);
    owned = algebra::map_of({grid.cell_id.begin(), grid.cell_id.begin() + grid.owned_cells}, grid.comm);
    all = algebra::map_of(grid.cell_id, grid.comm);
    import = Teuchos::rcp(new algebra::Import(owned, all));
    assemble();
    algebra::LinearParams direct;
    direct.solver = algebra::SolverKind::direct;
    solver = std::make_unique<algebra::Solver>(direct);
    solver->set_matrix(A, 1);
  }

  void assemble() {
    const HostGrid host = on_host(grid);
    const auto held_host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), held);
    std::vector<std::size_t> rows = {0};
    std::vector<LocalIndex> columns;
    std::vector<double> values;
    std::vector<std::pair<LocalIndex, double>> row;
    for (LocalIndex K = 0; K < grid.owned_cells; ++K) {
      row.assign(1, {K, c * host.volume(K)});
      for (LocalIndex f = host.cell_face_begin(K); f < host.cell_face_begin(K + 1); ++f) {
        const LocalIndex F = host.cell_faces(f), L = host.face_cells(F, host.face_cells(F, 0) == K ? 1 : 0);
        const double conductance = host.face_area(F) / host.face_distance(F);
        if (L >= 0) row.emplace_back(L, -conductance);
        if (L >= 0 || held_host(F)) row[0].second += conductance;
      }
      std::sort(row.begin(), row.end());
      for (const auto& [column, value] : row) {
        columns.push_back(column);
        values.push_back(value);
      }
      rows.push_back(columns.size());
    }
    using LocalGraph = algebra::Graph::local_graph_device_type;
    const LocalGraph::row_map_type::non_const_type row_map("thixis::fv::row_map", rows.size());
    const LocalGraph::entries_type::non_const_type entries("thixis::fv::entries", columns.size());
    const auto rows_host = Kokkos::create_mirror_view(row_map);
    const auto columns_host = Kokkos::create_mirror_view(entries);
    std::copy(rows.begin(), rows.end(), rows_host.data());
    std::copy(columns.begin(), columns.end(), columns_host.data());
    Kokkos::deep_copy(row_map, rows_host);
    Kokkos::deep_copy(entries, columns_host);
    A = Teuchos::rcp(new algebra::Matrix(algebra::make_graph(owned, all, row_map, entries)));
    A->fillComplete();
    const auto local = A->getLocalMatrixDevice().values;
    const auto local_host = Kokkos::create_mirror_view(local);
    std::copy(values.begin(), values.end(), local_host.data());
    Kokkos::deep_copy(local, local_host);
  }
};

FluxLift::FluxLift(const Grid& grid, const std::vector<bool>& held) : impl_(std::make_unique<Impl>(grid, held)) {}
FluxLift::~FluxLift() = default;

void FluxLift::operator()(const View<const double**>& r, const View<double**>& sigma, const View<double**>& rest) const {
  const Impl& in = *impl_;
  const auto volume = in.grid.volume;
  const double c = in.c;
  Vector b(in.owned), rho(in.owned), rho_all(in.all);
  for (int j = 0; j < r.extent_int(1); ++j) {
    {
      const auto right = b.getLocalViewDevice(Tpetra::Access::OverwriteAll);
      Kokkos::parallel_for(
          "thixis::fv::right_hand_side", Range(0, in.grid.owned_cells), KOKKOS_LAMBDA(LocalIndex K) { right(K, 0) = volume(K) * r(K, j); });
    }
    algebra::LinearStop stop;
    stop.tolerance = 1e-10 * b.norm2();
    rho.putScalar(0);
    if (stop.tolerance > 0) in.solver->solve(b, rho, stop);
    rho_all.doImport(rho, *in.import, Tpetra::INSERT);
    const auto values = std::as_const(rho_all).getLocalViewDevice(Tpetra::Access::ReadOnly);
    Kokkos::parallel_for("thixis::fv::two_point_fluxes", Range(0, in.grid.faces),
                         TwoPointFluxes{in.grid.face_cells, in.grid.face_distance, in.held, values, j, sigma});
    Kokkos::parallel_for(
        "thixis::fv::lift_rest", Range(0, in.grid.owned_cells),
        KOKKOS_LAMBDA(LocalIndex K) { rest(K, j) = c * volume(K) * values(K, 0) * values(K, 0); });
  }
}

}  // namespace thixis::fv
