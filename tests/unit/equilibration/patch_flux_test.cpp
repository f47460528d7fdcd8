/// What a sum of equilibrated fluxes must satisfy for any compatible data: its divergence, its continuity, its values on the boundary.
#include "thixis/equilibration/patch_flux.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "patch_data.hpp"
#include "thixis/method/quadrature.hpp"

namespace thixis::equilibration {
namespace {

class PatchFluxes : public testing::TestWithParam<std::tuple<std::string, Held, int>> {
 protected:
  mesh::Hierarchy levels = hierarchy(std::get<0>(GetParam()), 1);
  const mesh::Mesh& mesh = levels.finest();
  const mesh::HostMesh host = mesh::on_host(mesh);
  const int q = std::get<2>(GetParam()), n = reference::dimension(q), N = reference::dimension(q + 1);
  const View<const LocalIndex*> cells = method::patch_cells(mesh);
  const std::vector<bool> held = held_tags(mesh, std::get<1>(GetParam()));
  const PatchData given = random_data(mesh, cells, held, q);
  const PatchFlux flux{mesh, cells, held, q};

  CellTable sigma() const {
    const CellTable sum("sigma", mesh.owned_cells, 2 * N);
    Kokkos::deep_copy(sum, 1e300);
    flux(given.data(), sum);
    return sum;
  }

  /// Moment j of the outward flux through face i of K, along the face from its end 0 to its end 1.
  double moment(const CellTable& sigma, LocalIndex K, int i, const std::vector<double>& trace, int j) const {
    double sum = 0;
    for (int d = 0; d < 2; ++d)
      for (int l = 0; l < N; ++l) sum += reference::face_normal[i][d] * trace[j * N + l] * sigma(K, d * N + l);
    const bool along = host.face_vertices(host.cell_faces(K, i), 0) == host.cell_vertices(K, (i + 1) % 3);
    return along || j % 2 == 0 ? sum : -sum;
  }
};

TEST_P(PatchFluxes, has_the_divergence_of_the_sum_of_the_densities) {
  const reference::Modal modal(q + 1);
  const auto sum = sigma();
  double worst = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int m = 0; m < N; ++m) {
      double divergence = 0;
      for (int d = 0; d < 2; ++d)
        for (int l = 0; l < N; ++l) divergence += modal.derivative(d)[m * N + l] * sum(K, d * N + l);
      for (int i = 0; i < 3 && m < n; ++i) divergence -= given.density(K, i * n + m);
      worst = std::max(worst, std::abs(divergence));
    }
  EXPECT_LT(worst, 1e-10);
}

TEST_P(PatchFluxes, leaves_cells_as_it_enters_their_neighbours_and_the_domain_as_given) {
  const reference::Modal modal(q + 1);
  const auto sum = sigma();
  struct Side {
    GlobalIndex face;
    int j;
    double moment;
  };
  std::vector<Side> sides;
  double worst = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int i = 0; i < 3; ++i) {
      const auto trace = modal.trace(i, q + 2);
      const LocalIndex F = host.cell_faces(K, i);
      for (int j = 0; j < q + 2; ++j) {
        const double outward = moment(sum, K, i, trace, j);
        if (host.face_tag(F) < 0) sides.push_back({mesh.face_id[F], j, outward});
        else if (!held[host.face_tag(F)])
          worst = std::max(worst, std::abs(outward - (j <= q ? given.traction(F, j) + given.traction(F, q + 1 + j) : 0)));
      }
    }
  std::map<std::pair<GlobalIndex, int>, double> jump;
  for (const Side& side : mesh.comm.gather(sides)) jump[{side.face, side.j}] += side.moment;
  for (const auto& [key, value] : jump) worst = std::max(worst, std::abs(value));
  EXPECT_LT(worst, 1e-10);
}

TEST_P(PatchFluxes, is_the_same_on_any_number_of_ranks) {
  const auto alone = hierarchy(std::get<0>(GetParam()), 1, core::Comm(MPI_COMM_SELF));
  const mesh::Mesh& whole = alone.finest();
  const auto all_cells = method::patch_cells(whole);
  const CellTable expected("sigma", whole.owned_cells, 2 * N);
  PatchFlux(whole, all_cells, held, q)(random_data(whole, all_cells, held, q).data(), expected);
  std::map<GlobalIndex, LocalIndex> place;
  for (LocalIndex K = 0; K < whole.owned_cells; ++K) place[whole.cell_id[K]] = K;
  const auto sum = sigma();
  double worst = 0;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int l = 0; l < 2 * N; ++l) worst = std::max(worst, std::abs(sum(K, l) - expected(place.at(mesh.cell_id[K]), l)));
  EXPECT_LT(worst, 1e-10);
}

TEST_P(PatchFluxes, is_linear_and_repeatable) {
  const auto first = sigma();
  const auto twice = random_data(mesh, cells, held, q);
  for (const CellTable& table : {twice.density, twice.target, twice.traction})
    for (std::size_t e = 0; e < table.span(); ++e) table.data()[e] *= -2;
  const CellTable second("sigma", mesh.owned_cells, 2 * N);
  flux(twice.data(), second);
  const auto again = sigma();
  for (std::size_t e = 0; e < first.span(); ++e) {
    EXPECT_EQ(second.data()[e], -2 * first.data()[e]);
    EXPECT_EQ(again.data()[e], first.data()[e]);
  }
}

std::string setting(const testing::TestParamInfo<std::tuple<std::string, Held, int>>& test) {
  std::string name = std::get<0>(test.param);
  name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
  const std::string parts[] = {"all", "none", "some"};
  return name + "_" + parts[static_cast<int>(std::get<1>(test.param))] + "_RT" + std::to_string(std::get<2>(test.param));
}

INSTANTIATE_TEST_SUITE_P(Degrees, PatchFluxes,
                         testing::Combine(testing::Values("criss-cross", "rectangle", "disk", "file"),
                                          testing::Values(Held::all, Held::none, Held::some), testing::Values(0, 1, 2, 3, 4)),
                         setting);

}  // namespace
}  // namespace thixis::equilibration
