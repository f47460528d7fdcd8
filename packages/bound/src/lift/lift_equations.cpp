#include "lift/lift_equations.hpp"

#include "data/on_host.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/method/form.hpp"
#include "thixis/method/gradient_form.hpp"

namespace thixis::bound {
namespace {

/// Any v will do, and 1e-6 is near enough to the best one; but the bound is to be the same on any number of ranks.
constexpr double tolerance = 1e-10;

bool all_constant(const std::array<scene::FieldPtr, 2>& tension, int count) {
  return tension[0]->constant() && (count == 1 || tension[1]->constant());
}

std::array<scene::FieldPtr, 2> tensions_of_v(const std::array<scene::FieldPtr, 2>& tension, int count) {
  if (!all_constant(tension, count)) return tension;
  return {scene::constant(1), scene::constant(1)};
}

}  // namespace

LiftEquations::LiftEquations(const method::Space& space, const View<const LocalIndex*>& layer, const reference::CellBasis& basis,
                             const std::vector<bool>& dirichlet, const std::array<scene::FieldPtr, 2>& tension, int count)
    : host_(mesh::on_host(space.mesh())),
      layer_(layer),
      basis_(basis),
      constant_(all_constant(tension, count)),
      rule_(space.mesh(), layer, lift_order, basis.bernstein(), tensions_of_v(tension, count), count),
      derivatives_(rule_.derivatives(basis.bernstein())) {
  const mesh::Mesh& mesh = space.mesh();
  method::ContinuousNodes nodes = continuous_nodes(mesh, layer, basis, basis.points(), dirichlet);
  hold_rim(space, nodes);
  numbering_ = method::number(nodes.entries, mesh.comm);
  elements_ = Kokkos::View<LocalIndex**, Kokkos::LayoutRight>("thixis::bound::lift_elements", layer.extent(0), basis.size());
  const auto elements = elements_;
  const auto column_of_entry = numbering_.column_of_entry;
  const auto of_cells = nodes.of_cells;
  Kokkos::parallel_for(
      "thixis::bound::lift_elements", Kokkos::RangePolicy<>(0, elements.extent_int(0)), KOKKOS_LAMBDA(int k) {
        for (int l = 0; l < elements.extent_int(1); ++l) elements(k, l) = column_of_entry(of_cells(k, l));
      });
  graph_ = method::make_graph(numbering_.rows, numbering_.columns, elements_);
  const auto mu = tensions_of_v(tension, count);
  const method::CellQuadrature quadrature = method::make_quadrature(mesh, layer, 2 * degree_of_v, nullptr);
  algebra::LinearParams cg;
  cg.solver = algebra::SolverKind::cg;
  cg.preconditioner = algebra::PreconditionerKind::ilu;
  for (int alpha = 0; alpha < (constant_ ? 1 : count); ++alpha) {
    solver_[alpha] = std::make_unique<algebra::Solver>(cg);
    const auto form = method::gradient_form(mesh, quadrature, basis, *mu[alpha]);
    solver_[alpha]->set_matrix(method::assemble(mesh.comm, graph_, elements_, *form), 1);
  }
}

LiftEquations::~LiftEquations() = default;

void LiftEquations::hold_rim(const method::Space& space, method::ContinuousNodes& nodes) const {
  const auto of_cells = on_host(nodes.of_cells);
  const auto cells = on_host(space.cells()), layer = on_host(layer_);
  std::vector<bool> in_layer(space.mesh().cells, false), rim(space.mesh().vertices, false);
  for (std::size_t k = 0; k < layer.extent(0); ++k) in_layer[layer(k)] = true;
  for (std::size_t k = 0; k < cells.extent(0); ++k)
    for (int i = 0; i < 3 && !in_layer[cells(k)]; ++i) rim[host_.cell_vertices(cells(k), i)] = true;
  const auto outside = [&](LocalIndex F, LocalIndex K) {
    const LocalIndex other = mesh::neighbour(host_.face_cells, F, K);
    return host_.face_tag(F) < 0 && (other < 0 || !in_layer[other]);
  };
  for (std::size_t k = 0; k < layer.extent(0); ++k)
    for (int l = 0; l < basis_.size(); ++l) {
      const auto& entity = basis_.entities()[l];
      LocalIndex& held = nodes.entries.held[of_cells(k, l)];
      if (held >= 0 || entity.kind == reference::Entity::interior) continue;
      const bool on_rim = entity.kind == reference::Entity::vertex ? rim[host_.cell_vertices(layer(k), entity.index)]
                                                                   : outside(host_.cell_faces(layer(k), entity.index), layer(k));
      if (on_rim) held = 0;
    }
}

void LiftEquations::solve(int alpha, LocalIndex owned, std::vector<LiftInCell>& lift) const {
  const int n = basis_.size();
  const LocalIndex count = layer_.extent_int(0);
  const auto layer = on_host(layer_);
  const CellTable moments("thixis::bound::lift_moments", count, n);
  const auto right = Kokkos::create_mirror_view(moments);
  std::vector<double> l[3];
  for (LocalIndex k = 0; k < count; ++k) {
    if (lift[k].faces == 0) continue;
    rule_.table.evaluate(lift[k], l);
    rule_.weigh(alpha, k, mesh::cell_geometry(host_.coordinates, host_.cell_vertices, layer(k)), l);
    add_products(-1, l, derivatives_, n, &right(k, 0));
  }
  Kokkos::deep_copy(moments, right);
  algebra::Vector b(numbering_.rows), x(numbering_.rows), ghosted(numbering_.columns);
  method::scatter(elements_, 0, moments, b);
  algebra::LinearStop stop;
  stop.tolerance = tolerance * b.norm2();
  if (stop.tolerance > 0) solver_[constant_ ? 0 : alpha]->solve(b, x, stop);
  const auto import = graph_->getImporter();
  if (import.is_null()) ghosted.assign(x);
  else ghosted.doImport(x, *import, Tpetra::INSERT);
  const auto values = algebra::host_view(std::as_const(ghosted));
  const auto elements = on_host(elements_);
  for (LocalIndex k = 0; k < owned; ++k)
    for (int i = 0; i < n; ++i)
      if (elements(k, i) >= 0) lift[k].v[i] = values(elements(k, i));
}

}  // namespace thixis::bound
