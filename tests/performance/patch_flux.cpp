/// What fluxes on patches cost: set-up and evaluation per cell, and the memory they hold.
///
///     bench_patch_flux [refinements]        T_refinements of the unit square, default 5: 65536 cells
#include "thixis/equilibration/patch_flux.hpp"

#include <fmt/format.h>

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "thixis/mesh/build.hpp"
#include "thixis/mesh/mesh.hpp"
#include "thixis/method/quadrature.hpp"

namespace thixis {
namespace {

/// Shortest of several runs, in seconds.
template <class F>
double seconds(int runs, F f) {
  double best = 1e300;
  for (int run = 0; run < runs; ++run) {
    const auto start = std::chrono::steady_clock::now();
    f();
    Kokkos::fence();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

void measure(const mesh::Mesh& mesh, int q) {
  using equilibration::CellTable;
  using equilibration::PatchFlux;
  const auto cells = method::patch_cells(mesh);
  const std::vector<bool> held(mesh.tags.size(), true);
  const int n = reference::dimension(q);
  const CellTable density("density", cells.extent(0), 3 * n), target("target", cells.extent(0), 2 * n),
      sigma("sigma", mesh.owned_cells, 2 * reference::dimension(q + 1));
  Kokkos::deep_copy(target, 1);
  std::unique_ptr<PatchFlux> flux;
  const double setup = seconds(3, [&] { flux = std::make_unique<PatchFlux>(mesh, cells, held, q); });
  const double evaluation = seconds(10, [&] { (*flux)({density, target, {}}, sigma); });
  const double per_cell = 1.0 / mesh.owned_cells;
  fmt::print("RT_{} {:10.2f} {:10.3f} {:10.0f}\n", q, 1e6 * setup * per_cell, 1e6 * evaluation * per_cell,
             static_cast<double>(flux->bytes()) * per_cell);
}

}  // namespace
}  // namespace thixis

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  thixis::mesh::MeshParams params;
  params.refinements = argc > 1 ? std::atoi(argv[1]) : 5;
  const auto levels = thixis::mesh::build(params, thixis::core::Comm(), ".");
  fmt::print("{} cells\n     {:>10} {:>10} {:>10}\n", levels.finest().cells, "set-up us", "eval us", "bytes");
  for (int q = 1; q <= 4; ++q) thixis::measure(levels.finest(), q);
}
