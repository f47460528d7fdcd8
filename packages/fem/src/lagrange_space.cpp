#include "thixis/fem/lagrange_space.hpp"

#include <algorithm>

#include "kernels.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/core/error.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/method/graph.hpp"
#include "thixis/reference/quadrature.hpp"
#include "vertex_numbering.hpp"

namespace thixis::fem {
namespace {

using algebra::Vector;
using method::BoundaryValues;
using method::Coefficients;
using Values = Kokkos::View<double*>;

/// Continuous P1. Coefficients are numbered by local vertices; positions in `cells_` number the patch cells, owned ones first.
class LagrangeSpace final : public method::Space {
 public:
  LagrangeSpace(const mesh::Mesh& mesh, const method::SpaceOptions& options)
      : mesh_(mesh),
        host_(mesh::on_host(mesh)),
        numbering_(number_vertices(mesh, options.dirichlet)),
        cells_(method::patch_cells(mesh)),
        quadrature_(method::make_quadrature(mesh, cells_, options.params.order(), options.level_set)),
        order_(options.params.order()),
        graph_(method::make_graph(numbering_.rows, numbering_.columns, numbering_.cell_columns)),
        coordinates_(vertex_coordinates()),
        pairing_(numbering_.rows) {
    const Block2 d("thixis::fem::mean_values", block_length(), 3);
    over_blocks([&](LocalIndex first, LocalIndex count) {
      const auto block = Kokkos::subview(d, std::pair(0, count), Kokkos::ALL);
      mean_values(mesh_, cells_, first, block);
      method::scatter(numbering_.cell_columns, first, block, pairing_);
    });
  }

  const mesh::Mesh& mesh() const override { return mesh_; }
  algebra::MapPtr map() const override { return numbering_.rows; }
  algebra::GraphPtr graph() const override { return graph_; }
  std::vector<GlobalIndex> unknown_ids() const override {
    std::vector<GlobalIndex> ids;
    ids.reserve(algebra::local_size(*numbering_.rows));
    for (LocalIndex row = 0; row < algebra::local_size(*numbering_.rows); ++row)
      ids.push_back(mesh_.vertex_id[numbering_.vertex_of_column[row]]);
    return ids;
  }
  Teuchos::RCP<const algebra::MultiVector> coordinates() const override { return coordinates_; }
  const Vector& pairing() const override { return pairing_; }

  algebra::MatrixPtr stiffness(const scene::Field& tension) const override {
    auto S = Teuchos::rcp(new algebra::Matrix(graph_));
    S->fillComplete();
    const Values mu = mean_over_cells(tension);
    const Block3 A("thixis::fem::stiffness", block_length(), 3, 3);
    over_blocks([&](LocalIndex first, LocalIndex count) {
      const auto block = Kokkos::subview(A, std::pair(0, count), Kokkos::ALL, Kokkos::ALL);
      fem::stiffness(mesh_, cells_, first, Kokkos::subview(mu, std::pair(first, first + count)), block);
      method::scatter(numbering_.cell_columns, first, block, *S);
    });
    return S;
  }

  Coefficients lift(const BoundaryValues& boundary, double t) const override {
    const Coefficients values("thixis::fem::lift", mesh_.vertices);
    const auto host = Kokkos::create_mirror_view(values);
    mesh_.comm.together([&] {
      for (std::size_t tag = 0; tag < boundary.dirichlet.size(); ++tag) {
        if (!boundary.dirichlet[tag]) continue;
        std::vector<LocalIndex> held;
        for (LocalIndex v = 0; v < mesh_.vertices; ++v)
          if (numbering_.dirichlet_tag[v] == static_cast<LocalIndex>(tag)) held.push_back(v);
        const auto g = at_vertices(*boundary.dirichlet[tag], held, t);
        for (std::size_t k = 0; k < held.size(); ++k) host(held[k]) = g[k];
      }
    });
    Kokkos::deep_copy(values, host);
    return values;
  }

  void load(const scene::Field& force, const BoundaryValues& boundary, double t, Vector& F) const override {
    F.putScalar(0);
    mesh_.comm.together([&] {
      const Values f("thixis::fem::force", quadrature_.largest_block);
      const Block2 local("thixis::fem::loads", quadrature_.block_cells, 3);
      method::for_each_block(quadrature_, [&](const method::QuadratureBlock& block) {
        method::evaluate(force, t, block, f);
        const auto part = Kokkos::subview(local, std::pair(0, block.cells), Kokkos::ALL);
        loads(block, f, part);
        method::scatter(numbering_.cell_columns, block.first, part, F);
      });
      add_tractions(boundary, t, F);
    });
  }

  void forces(const scene::Field& tension, const Coefficients& u, Vector& y) const override {
    y.putScalar(0);
    const Values mu = mean_over_cells(tension);
    const Block2 local("thixis::fem::forces", block_length(), 3);
    const Block1 energy("thixis::fem::energy", block_length());
    over_blocks([&](LocalIndex first, LocalIndex count) {
      const auto part = Kokkos::subview(local, std::pair(0, count), Kokkos::ALL);
      fem::forces(mesh_, cells_, first, Kokkos::subview(mu, std::pair(first, first + count)), u, part, energy);
      method::scatter(numbering_.cell_columns, first, part, y);
    });
  }

  Coefficients complete(const Vector& u, const Coefficients& lift) const override {
    const Coefficients values("thixis::fem::coefficients", mesh_.vertices);
    Kokkos::deep_copy(values, lift);
    Vector ghosted(numbering_.columns);
    const auto import = graph_->getImporter();
    if (import.is_null()) ghosted.assign(u);
    else ghosted.doImport(u, *import, Tpetra::INSERT);
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), values);
    const auto unknowns = algebra::host_view(std::as_const(ghosted));
    for (std::size_t c = 0; c < numbering_.vertex_of_column.size(); ++c) host(numbering_.vertex_of_column[c]) = unknowns(c);
    Kokkos::deep_copy(values, host);
    return values;
  }

  void restrict_to_unknowns(const Coefficients& u, Vector& values) const override {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), u);
    const auto out = algebra::host_overwrite(values);
    for (std::size_t row = 0; row < out.extent(0); ++row) out(row) = host(numbering_.vertex_of_column[row]);
  }

  void interpolate(const scene::Field& u, double t, Vector& values) const override {
    mesh_.comm.together([&] {
      const std::vector<LocalIndex> nodes(numbering_.vertex_of_column.begin(),
                                          numbering_.vertex_of_column.begin() + algebra::local_size(*numbering_.rows));
      const auto at_nodes = at_vertices(u, nodes, t);
      const auto out = algebra::host_overwrite(values);
      for (std::size_t row = 0; row < at_nodes.size(); ++row) out(row) = at_nodes[row];
    });
  }

  void prolongate(const method::Space& coarse_space, const Coefficients& coarse_u, Vector& values) const override {
    const auto& coarse = dynamic_cast<const LagrangeSpace&>(coarse_space);
    const LocalIndex rows = algebra::local_size(*numbering_.rows);

    // the parents of this rank's unknowns may have another owner on the coarse mesh
    std::vector<LocalIndex> parents;
    for (LocalIndex row = 0; row < rows; ++row)
      for (const LocalIndex parent : mesh_.vertex_parents[numbering_.vertex_of_column[row]]) parents.push_back(parent);
    std::sort(parents.begin(), parents.end());
    parents.erase(std::unique(parents.begin(), parents.end()), parents.end());
    std::vector<GlobalIndex> ids;
    ids.reserve(parents.size());
    for (const LocalIndex v : parents) ids.push_back(coarse.mesh_.vertex_id[v]);
    const auto needed = algebra::map_of(ids, mesh_.comm);

    Vector owned(coarse.numbering_.vertex_map), fetched(needed);
    {
      const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), coarse_u);
      const auto out = algebra::host_overwrite(owned);
      for (std::size_t k = 0; k < coarse.numbering_.owned_vertices.size(); ++k) out(k) = host(coarse.numbering_.owned_vertices[k]);
    }
    fetched.doImport(owned, algebra::Import(coarse.numbering_.vertex_map, needed), Tpetra::INSERT);

    std::vector<double> at_coarse(coarse.mesh_.vertices);
    const auto in = algebra::host_view(std::as_const(fetched));
    for (std::size_t k = 0; k < parents.size(); ++k) at_coarse[parents[k]] = in(k);
    const auto out = algebra::host_overwrite(values);
    for (LocalIndex row = 0; row < rows; ++row) {
      const auto& parent = mesh_.vertex_parents[numbering_.vertex_of_column[row]];
      out(row) = 0.5 * (at_coarse[parent[0]] + at_coarse[parent[1]]);
    }
  }

  double energy(const scene::Field& tension, const Coefficients& u) const override {
    const Values mu = mean_over_cells(tension);
    const Block2 local("thixis::fem::forces", block_length(), 3);
    const Block1 energy("thixis::fem::energy", block_length());
    double sum = 0;
    over_blocks([&](LocalIndex first, LocalIndex count) {
      const auto part = Kokkos::subview(local, std::pair(0, count), Kokkos::ALL);
      fem::forces(mesh_, cells_, first, Kokkos::subview(mu, std::pair(first, first + count)), u, part, energy);
      const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), energy);
      for (LocalIndex e = 0; e < count && first + e < mesh_.owned_cells; ++e) sum += host(e);
    });
    return mesh_.comm.sum(sum);
  }

  double energy_error(const scene::Field& tension, const Coefficients& u, const method::Gradient& exact, double t) const override {
    const double sum = mesh_.comm.together([&] {
      const int length = quadrature_.largest_block;
      const Values mu("thixis::fem::tension", length), x("thixis::fem::gradient_x", length), y("thixis::fem::gradient_y", length);
      double here = 0;
      method::for_each_block(quadrature_, [&](const method::QuadratureBlock& block) {
        const LocalIndex owned = std::min(block.cells, mesh_.owned_cells - block.first);
        if (owned <= 0) return;
        method::evaluate(tension, t, block, mu);
        method::evaluate(*exact[0], t, block, x);
        method::evaluate(*exact[1], t, block, y);
        here += gradient_error(mesh_, block, owned, {mu, x, y}, u);
      });
      return here;
    });
    return mesh_.comm.sum(sum);
  }

  std::vector<double> at_vertices(const Coefficients& u) const override {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), u);
    return std::vector<double>(host.data(), host.data() + host.extent(0));
  }

 private:
  /// f(first, count) for blocks of patch cells.
  template <class F>
  void over_blocks(F f) const {
    const LocalIndex cells = cells_.extent_int(0);
    for (LocalIndex first = 0; first < cells; first += method::block_size) f(first, std::min(method::block_size, cells - first));
  }
  LocalIndex block_length() const { return std::min(method::block_size, cells_.extent_int(0)); }

  /// mu_K for every patch cell.
  Values mean_over_cells(const scene::Field& tension) const {
    const Values mu("thixis::fem::mean_tension", cells_.extent(0));
    if (const double* value = tension.constant()) {
      Kokkos::deep_copy(mu, *value);
      return mu;
    }
    mesh_.comm.together([&] {
      const Values at_points("thixis::fem::tension", quadrature_.largest_block);
      method::for_each_block(quadrature_, [&](const method::QuadratureBlock& block) {
        method::evaluate(tension, 0, block, at_points);
        means(block, at_points, Kokkos::subview(mu, std::pair(block.first, block.first + block.cells)));
      });
      const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), mu);
      for (std::size_t k = 0; k < host.extent(0); ++k)
        if (!(host(k) > 0))
          throw core::InputError("scene/data: a tension is not positive in some cell; give mu1 > 0 and mu2 > 0 everywhere.");
    });
    return mu;
  }

  std::vector<double> at_vertices(const scene::Field& field, const std::vector<LocalIndex>& vertices, double t) const {
    std::vector<double> x, y, values(vertices.size());
    x.reserve(vertices.size());
    y.reserve(vertices.size());
    for (const LocalIndex v : vertices) {
      x.push_back(host_.coordinates(v, 0));
      y.push_back(host_.coordinates(v, 1));
    }
    field.evaluate({vertices.size(), x.data(), y.data()}, t, values.data());
    return values;
  }

  /// F_l += <t, psi_l> over the Neumann faces.
  void add_tractions(const BoundaryValues& boundary, double t, Vector& F) const {
    const auto rule = reference::line_quadrature(order_);
    const auto out = algebra::host_view(F);
    const auto column = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), numbering_.column_of_vertex);
    std::vector<double> x(rule.size()), y(rule.size()), traction(rule.size());
    for (LocalIndex face = 0; face < mesh_.faces; ++face) {
      const LocalIndex tag = host_.face_tag(face);
      if (tag < 0 || !boundary.neumann[tag]) continue;
      const LocalIndex end[2] = {host_.face_vertices(face, 0), host_.face_vertices(face, 1)};
      double tangent[2];
      for (int d = 0; d < 2; ++d) tangent[d] = host_.coordinates(end[1], d) - host_.coordinates(end[0], d);
      for (int q = 0; q < rule.size(); ++q) {
        x[q] = host_.coordinates(end[0], 0) + rule.point[q] * tangent[0];
        y[q] = host_.coordinates(end[0], 1) + rule.point[q] * tangent[1];
      }
      boundary.neumann[tag]->evaluate({x.size(), x.data(), y.data()}, t, traction.data());
      const double length = std::hypot(tangent[0], tangent[1]);
      for (int i = 0; i < 2; ++i) {
        const LocalIndex row = column(end[i]);
        if (row < 0 || row >= static_cast<LocalIndex>(out.extent(0))) continue;
        for (int q = 0; q < rule.size(); ++q)
          out(row) += length * rule.weight[q] * traction[q] * (i == 0 ? 1 - rule.point[q] : rule.point[q]);
      }
    }
  }

  Teuchos::RCP<const algebra::MultiVector> vertex_coordinates() const {
    auto coordinates = Teuchos::rcp(new algebra::MultiVector(numbering_.rows, 2));
    const auto out = coordinates->getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (std::size_t row = 0; row < out.extent(0); ++row)
      for (int d = 0; d < 2; ++d) out(row, d) = host_.coordinates(numbering_.vertex_of_column[row], d);
    return coordinates;
  }

  const mesh::Mesh& mesh_;
  mesh::HostMesh host_;
  VertexNumbering numbering_;
  mesh::View<const LocalIndex*> cells_;
  method::CellQuadrature quadrature_;
  int order_;
  algebra::GraphPtr graph_;
  Teuchos::RCP<const algebra::MultiVector> coordinates_;
  Vector pairing_;
};

}  // namespace

std::unique_ptr<method::Space> make_lagrange_space(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  THIXIS_ASSERT_EQ(options.params.degree, 1, "the registry refuses other degrees");
  return std::make_unique<LagrangeSpace>(mesh, options);
}

}  // namespace thixis::fem
