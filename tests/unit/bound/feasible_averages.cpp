/// The feasible pair of methods without continuity: nodal averages, the same on any number of ranks.
#include "feasible/averages.hpp"
#include "feasible_setting.hpp"

namespace thixis::bound {
namespace {

class Broken : public ::testing::TestWithParam<Setting> {
 protected:
  mesh::Hierarchy levels = square(1);
  const mesh::Mesh& mesh = levels.finest();
  std::unique_ptr<Space> V = make_space(mesh, GetParam());
  const int p = GetParam().degree;

  /// A field whose values depend on the cell, not on the rank.
  Coefficients jumping(const FieldPtr& u, double jump) const {
    const Coefficients c = interpolated(*V, u);
    for (std::size_t k = 0; k < V->cells().extent(0); ++k)
      for (int l = 0; l < V->basis().size(); ++l)
        c(V->coefficients().element_entries(k, l)) += jump * std::sin(1.0 + 7.0 * mesh.cell_id[V->cells()(k)] + l);
    return c;
  }
};

std::string name_of(const ::testing::TestParamInfo<Setting>& info) {
  return (info.param.name == "dg" ? "dg" : "hho") + std::to_string(info.param.degree) +
         (info.param.nodes == Nodes::bernstein ? "_bernstein" : "");
}

}  // namespace

TEST_P(Broken, averages_are_continuous_and_keep_continuous_functions) {
  const std::vector<bool> held(mesh.tags.size(), false);
  const ContinuousNodes nodes = continuous_nodes(mesh, V->cells(), V->basis(), V->basis().points(), held);
  const Averages average(*V, nodes);
  const View<double*> none("none", nodes.entries.size()), mean("mean", nodes.entries.size());
  const auto u = interpolated(*V, scene::formula([](double x, double y) { return std::cos(2 * x - y); }));
  average(u, none, mean);
  const auto host = mesh::on_host(mesh);
  const auto& entries = V->coefficients().element_entries;
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int l = 0; l < V->basis().size(); ++l) EXPECT_NEAR(mean(nodes.of_cells(K, l)), u(entries(K, l)), 1e-12);

  // on a face both cells have the same polynomial
  average(jumping(scene::constant(0), 1), none, mean);
  std::vector<double> seen(mesh.faces, NAN);
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K)
    for (int i = 0; i < 3; ++i) {
      const LocalIndex F = host.cell_faces(K, i);
      const bool along = host.face_vertices(F, 0) == host.cell_vertices(K, (i + 1) % 3);
      double lambda[3] = {};
      lambda[(i + 1) % 3] = along ? 0.2 : 0.8;
      lambda[(i + 2) % 3] = along ? 0.8 : 0.2;
      const double point[2] = {lambda[1], lambda[2]};
      const auto table = V->basis().tabulate(1, point);
      double value = 0;
      for (int l = 0; l < V->basis().size(); ++l) value += table.value[l] * mean(nodes.of_cells(K, l));
      if (std::isnan(seen[F])) seen[F] = value;
      EXPECT_NEAR(seen[F], value, 1e-13);
    }
}

TEST_P(Broken, nothing_is_done_to_continuous_functions_with_polynomial_data) {
  const auto u1 = scene::formula([this](double x, double y) { return 2 + std::pow(x - y, p); });
  const auto u2 = scene::formula([](double x, double y) { return x - y; });
  const FeasiblePair s(*V, two_membranes(mesh, u1, u2, scene::constant(1), scene::constant(3)));
  FeasiblePair::Parts parts;
  s.evaluate({interpolated(*V, u1), interpolated(*V, u2)}, density_of(mesh, scene::constant(1), 0), 0, parts);
  EXPECT_LT(sum_of(mesh.comm, parts.whole), 1e-11);
  EXPECT_LT(sum_of(mesh.comm, parts.rest), 1e-11);
  EXPECT_EQ(sum_of(mesh.comm, parts.at_nodes), 0);
}

TEST_P(Broken, parts_do_not_depend_on_the_ranks) {
  const auto g = scene::formula([](double x, double y) { return std::cos(x + 2 * y); });
  const auto u2 = scene::formula([](double x, double y) { return std::cos(x + 2 * y) - 0.2 + 2 * x * (1 - x) * y * (1 - y); });
  const auto evaluated = [&](const mesh::Mesh& of, const Space& space, double(&sums)[4]) {
    const auto jumping = [&](const FieldPtr& u, double jump) {
      const Coefficients c = interpolated(space, u);
      for (std::size_t k = 0; k < space.cells().extent(0); ++k)
        for (int l = 0; l < space.basis().size(); ++l)
          c(space.coefficients().element_entries(k, l)) += jump * std::sin(1.0 + 7.0 * of.cell_id[space.cells()(k)] + l);
      return c;
    };
    const FeasiblePair s(space, two_membranes(of, g, u2, scene::constant(1), scene::constant(3)));
    FeasiblePair::Parts parts;
    s.evaluate({jumping(g, 0.1), jumping(u2, 0.2)}, density_of(of, scene::constant(1), 1), 1, parts);
    const View<double*> of_parts[4] = {parts.whole, parts.at_nodes, parts.rest, parts.contact};
    for (int i = 0; i < 4; ++i) sums[i] = sum_of(of.comm, of_parts[i]);
  };
  mesh::MeshParams params;
  params.refinements = 1;
  params.cells_per_rank = 20;
  const auto alone = mesh::build(params, core::Comm(MPI_COMM_SELF), "");
  double here[4], serial[4];
  evaluated(mesh, *V, here);
  evaluated(alone.finest(), *make_space(alone.finest(), GetParam()), serial);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(here[i], serial[i], 1e-8 * serial[i]);
}

INSTANTIATE_TEST_SUITE_P(Methods, Broken,
                         ::testing::ValuesIn(tests::built(std::vector<Setting>{Setting{"dg", 1}, Setting{"dg", 2}, Setting{"dg", 4},
                                                                               Setting{"dg", 3, Nodes::bernstein}, Setting{"hho", 1},
                                                                               Setting{"hho", 3}})),
                         name_of);

}  // namespace thixis::bound
