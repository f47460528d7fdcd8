/// Throughput of assembly, for each method and degree, beside what the memory and the arithmetic units of the machine give in the same run.
///
///     bench_assembly [refinements]        T_refinements of the unit square, default 5: 65536 cells
#include <fmt/format.h>

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include "registry.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/mesh/mesh.hpp"
#include "thixis/method/gradient_form.hpp"
#include "thixis/method/quadrature.hpp"

namespace thixis {
namespace {

/// Shortest of several runs, in seconds.
template <class F>
double seconds(F f) {
  double best = 1e300;
  for (int run = 0; run < 5; ++run) {
    const auto start = std::chrono::steady_clock::now();
    f();
    Kokkos::fence();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

/// Bytes per second of a = b + s c on arrays beyond the caches.
double bandwidth() {
  const int n = 1 << 24;
  const Kokkos::View<double*> a("a", n), b("b", n), c("c", n);
  const double time = seconds([&] {
    Kokkos::parallel_for(
        "triad", n, KOKKOS_LAMBDA(int i) { a(i) = b(i) + 3 * c(i); });
  });
  return 24.0 * n / time;
}

/// Flops per second of y += sum of three small matrices in cache: the arithmetic of the local kernels without their memory.
double arithmetic() {
  const int n = 1024, sweeps = 2000;
  const Kokkos::View<double* [3], Kokkos::LayoutRight> Q("Q", n);
  const Kokkos::View<double*> y("y", n);
  Kokkos::deep_copy(Q, 1e-3);
  const double time = seconds([&] {
    for (int s = 0; s < sweeps; ++s) {
      const double m0 = 1 + s, m1 = 2 + s, m2 = 3 + s;
      Kokkos::parallel_for(
          "multiply_add", n, KOKKOS_LAMBDA(int i) { y(i) = m0 * Q(i, 0) + m1 * Q(i, 1) + m2 * Q(i, 2); });
    }
  });
  return 5.0 * n * sweeps / time;
}

struct Subject {
  std::string name;
  method::Method method;
  method::MethodParams params;
};

std::vector<Subject> subjects() {
  std::vector<Subject> all;
  for (int p = 1; p <= 4; ++p) {
    method::MethodParams params;
    params.degree = p;
    for (const method::Method& known : catalogue().methods()) {
      if (!known.make_space) continue;
      params.name = known.name;
      all.push_back({fmt::format("{} P{}", known.name, p), known, params});
    }
  }
  return all;
}

void measure(const Subject& subject, const mesh::Mesh& mesh, double bytes_per_second, double flops_per_second) {
  const method::BoundaryValues boundary = {std::vector<scene::FieldPtr>(mesh.tags.size(), scene::constant(0)),
                                           std::vector<scene::FieldPtr>(mesh.tags.size(), nullptr)};
  const auto tension = scene::constant(1);
  const auto force = scene::formula([](double x, double y) { return x * y; });
  std::unique_ptr<method::Space> V;
  const double setup = seconds([&] {
    V = subject.method.make_space(mesh, {std::vector<bool>(mesh.tags.size(), true), nullptr, subject.params});
  });
  algebra::MatrixPtr S;
  const double matrix = seconds([&] { S = method::assemble(*subject.method.diffusion(*V, tension)); });
  algebra::Vector F(V->map());
  const double load = seconds([&] { method::load(*subject.method.diffusion(*V, tension), *force, boundary, 0, F); });

  const auto form = subject.method.diffusion(*V, tension)->cells();
  const int n = V->elements().extent_int(1);
  const LocalIndex cells = V->elements().extent_int(0), most = method::cells_per_block(n);
  const method::LocalMatrices A("local", most, n, n);
  const double kernel = seconds([&] {
    for (LocalIndex first = 0; first < cells; first += most)
      form->matrices(first, Kokkos::subview(A, std::pair(0, std::min(most, cells - first)), Kokkos::ALL, Kokkos::ALL));
  });

  // what must be moved: coordinates, vertices and columns of each cell in, column numbers read, values read and written
  const double bytes = cells * (60.0 + 4.0 * n) + 20.0 * static_cast<double>(S->getGlobalNumEntries());
  // what must be computed: five operations per entry of a local matrix for three reference matrices (hho: twice that), one to add it; on
  // each of 1.5 faces per cell, at p+1 points, 2(p+1) functions with a trace against 4n and 2(p+1) others, and 4n² to add
  const int p = subject.params.degree;
  double per_cell = n * n * (subject.params.name == "hho" ? 12.0 : 6.0);
  if (subject.params.name == "dg") per_cell += 1.5 * ((p + 1) * 2 * (p + 1) * (8.0 * n + 6 * (p + 1)) + 4.0 * n * n);
  const double flops = cells * per_cell;
  const double bound = std::max(bytes / bytes_per_second, flops / flops_per_second);
  fmt::print("{:8} {:4} {:10} {:10.2e} {:10.2e} {:10.2e} {:10.2e} {:8} {:8.1f}\n", subject.name, n, S->getGlobalNumEntries(), cells / setup,
             cells / kernel, cells / matrix, cells / load, bytes / bytes_per_second > flops / flops_per_second ? "memory" : "flops",
             matrix / bound);
}

/// What it costs to follow a circle through the cells, at the orders that degree p asks for.
void measure_cut_cells(const mesh::Mesh& mesh) {
  const auto circle = scene::formula([](double x, double y) { return std::hypot(x - 0.5, y - 0.5) - 1.0 / 3; });
  const auto cells = method::owned_cells(mesh);
  fmt::print("\n{:>6} {:>10} {:>10} {:>10} {:>12} {:>12}\n", "order", "points", "cut cells", "points", "plain rule", "with circle");
  for (int p = 1; p <= 4; ++p) {
    method::MethodParams params;
    params.degree = p;
    method::CellQuadrature rule;
    const double plain = seconds([&] { rule = method::make_quadrature(mesh, cells, params.order(), nullptr); });
    const double cut = seconds([&] { rule = method::make_quadrature(mesh, cells, params.order(), circle); });
    fmt::print("{:6} {:10} {:10} {:10.0f} {:10.4f} s {:10.4f} s\n", params.order(), rule.rule_weight.extent(0), rule.cut_cells(),
               static_cast<double>(rule.own_weight.extent(0)) / rule.cut_cells(), plain, cut);
  }
}

}  // namespace
}  // namespace thixis

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  thixis::mesh::MeshParams params;
  params.refinements = argc > 1 ? std::atoi(argv[1]) : 5;
  const auto levels = thixis::mesh::build(params, thixis::core::Comm(), "");
  const double bytes_per_second = thixis::bandwidth(), flops_per_second = thixis::arithmetic();
  fmt::print("{} cells; memory {:.1f} GB/s, arithmetic {:.1f} Gflop/s; cells per second, and time of the matrix / bound\n",
             levels.finest().global_cells, bytes_per_second / 1e9, flops_per_second / 1e9);
  fmt::print("{:8} {:>4} {:>10} {:>10} {:>10} {:>10} {:>10} {:>8} {:>8}\n", "method", "n", "nonzeros", "space", "kernel", "matrix", "load",
             "bound", "ratio");
  for (const auto& subject : thixis::subjects()) thixis::measure(subject, levels.finest(), bytes_per_second, flops_per_second);
  thixis::measure_cut_cells(levels.finest());
  return 0;
}
