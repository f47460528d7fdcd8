#include "levels/root_flux.hpp"

#include "levels/free_pieces.hpp"
#include "levels/root_kernels.hpp"
#include "levels/root_poisson.hpp"
#include "thixis/method/quadrature.hpp"

namespace thixis::equilibration {
namespace {

/// (a, l, k): coefficient l of lambda_a phi_k, both below dim P_q.
Kokkos::View<double***, Kokkos::LayoutRight> times_hats(int q) {
  const reference::Modal modal(q + 1);
  const int n = reference::dimension(q);
  const Kokkos::View<double***, Kokkos::LayoutRight> times("thixis::equilibration::times", 3, n, n);
  const auto host = Kokkos::create_mirror_view(times);
  for (int a = 0; a < 3; ++a)
    for (int k = 0; k < n; ++k)
      for (int l = 0; l < n; ++l) host(a, l, k) = modal.times_barycentric(a)[l * modal.size() + k];
  Kokkos::deep_copy(times, host);
  return times;
}

}  // namespace

struct RootFlux::Impl {
  std::shared_ptr<const mesh::Mesh> mesh;
  Metrics metric;
  PatchFlux patches;
  FreePieces pieces;
  RootPoisson poisson;
  RootSources sources;     ///< but for r
  CellTable without_mean;  ///< of length 0 where every piece is held

  Impl(std::shared_ptr<const mesh::Mesh> whole, const std::vector<bool>& held, int q)
      : mesh(std::move(whole)),
        metric(metrics(*mesh, method::owned_cells(*mesh))),
        patches(*mesh, method::owned_cells(*mesh), held, q),
        pieces(*mesh, held, metric),
        poisson(*mesh, held, pieces.vertex, q),
        without_mean("thixis::equilibration::without_mean", pieces.area.empty() ? 0 : mesh->cells, reference::dimension(q)) {
    const int n = reference::dimension(q);
    sources.metric = metric;
    sources.times = times_hats(q);
    sources.rho = rho = Kokkos::View<double* [3], Kokkos::LayoutRight>("thixis::equilibration::rho", mesh->cells);
    sources.density = CellTable("thixis::equilibration::root_density", mesh->cells, 3 * n);
    sources.target = CellTable("thixis::equilibration::root_target", mesh->cells, 2 * n);
  }

  Kokkos::View<double* [3], Kokkos::LayoutRight> rho;
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
  in.poisson.solve(r, in.rho);
  RootSources sources = in.sources;
  sources.r = r;
  Kokkos::parallel_for("thixis::equilibration::root_sources", Kokkos::RangePolicy<>(0, in.mesh->cells), sources);
  in.patches({sources.density, sources.target, {}}, sigma);
  return left;
}

std::size_t RootFlux::bytes() const {
  const Impl& in = *impl_;
  return in.patches.bytes() + in.poisson.bytes() + sizeof(double) * (in.sources.density.size() + in.sources.target.size() + in.rho.size());
}

}  // namespace thixis::equilibration
