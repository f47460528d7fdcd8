#include "held_boundary.hpp"

#include <set>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/reference/modal.hpp"

namespace thixis::dg {

HeldBoundary::HeldBoundary(const method::Space& space, const std::vector<bool>& dirichlet)
    : space_(space),
      host_(mesh::on_host(space.mesh())),
      functions_(space.basis().size()),
      width_(2 * reference::dimension(space.basis().degree() + 1)) {
  collect_cells(dirichlet);
  collect_fans();
  tabulate();
}

void HeldBoundary::collect_cells(const std::vector<bool>& dirichlet) {
  const mesh::Mesh& mesh = space_.mesh();
  const auto entries = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space_.coefficients().element_entries);
  const auto patch = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space_.cells());
  std::vector<GlobalIndex> own_ids, ids;
  for (LocalIndex k = 0; k < patch.extent_int(0); ++k) {
    Cell cell{k, std::vector<bool>(functions_), {}};
    bool any = false;
    for (int l = 0; l < functions_; ++l) {
      cell.held[l] = space_.numbering().held[entries(k, l)] >= 0;
      any = any || cell.held[l];
    }
    if (!any) continue;
    for (int f = 0; f < 3; ++f) {
      const LocalIndex tag = host_.face_tag(host_.cell_faces(patch(k), f));
      cell.boundary_held[f] = tag >= 0 && dirichlet[tag];
    }
    ids.push_back(mesh.cell_id[patch(k)]);
    if (owned(cell)) own_ids.push_back(ids.back());
    cells_.push_back(std::move(cell));
  }
  owned_ = own_ids.size();
  import_ = Teuchos::rcp(new algebra::Import(algebra::map_of(own_ids, mesh.comm), algebra::map_of(ids, mesh.comm)));
}

void HeldBoundary::collect_fans() {
  for (int l = 0; l < functions_; ++l) {
    const auto& entity = space_.basis().entities()[l];
    if (entity.kind == reference::Entity::vertex) function_of_vertex_[entity.index] = l;
  }
  const auto patch = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), space_.cells());
  std::vector<std::size_t> place(space_.mesh().cells, cells_.size());
  for (std::size_t c = 0; c < cells_.size(); ++c) place[patch(cells_[c].position)] = c;
  std::set<LocalIndex> seen;
  for (std::size_t c = 0; c < owned_; ++c) {
    const LocalIndex K = patch(cells_[c].position);
    for (int v = 0; v < 3; ++v)
      if (cells_[c].held[function_of_vertex_[v]] && seen.insert(host_.cell_vertices(K, v)).second) fans_.push_back(fan_around(K, v, place));
  }
}

HeldBoundary::Fan HeldBoundary::fan_around(LocalIndex K, int vertex, const std::vector<std::size_t>& place) const {
  const LocalIndex a = host_.cell_vertices(K, vertex);
  const auto number = [&](LocalIndex cell) { return host_.cell_vertices(cell, 0) == a ? 0 : host_.cell_vertices(cell, 1) == a ? 1 : 2; };
  const auto across = [&](LocalIndex cell, int turn) {
    return mesh::neighbour(host_.face_cells, host_.cell_faces(cell, (number(cell) + turn) % 3), cell);
  };
  for (LocalIndex before = across(K, 2); before >= 0; before = across(K, 2)) K = before;
  Fan fan;
  for (LocalIndex cell = K; cell >= 0; cell = across(cell, 1)) {
    fan.cells.push_back(place[cell]);
    fan.vertex.push_back(number(cell));
  }
  fan.first_held = cells_[fan.cells.front()].boundary_held[(fan.vertex.front() + 2) % 3];
  fan.last_held = cells_[fan.cells.back()].boundary_held[(fan.vertex.back() + 1) % 3];
  return fan;
}

void HeldBoundary::balance(const scene::Field& force, double t, const method::HeldSource& source,
                           const method::View<double**>& sigma) const {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), sigma);
  const auto e = fetched(space_.mesh().comm.together([&] { return defects(force, t, source, host.data()); }));
  for (std::size_t c = 0; c < owned_; ++c)
    for (int l = 0; l < functions_; ++l) {
      const auto& entity = space_.basis().entities()[l];
      if (entity.kind == reference::Entity::face && cells_[c].held[l])
        let_out(e[c * functions_ + l], cells_[c], entity.index, l, host.data());
    }
  for (const Fan& fan : fans_) {
    std::vector<double> of_vertex;
    for (std::size_t i = 0; i < fan.cells.size(); ++i)
      of_vertex.push_back(e[fan.cells[i] * functions_ + function_of_vertex_[fan.vertex[i]]]);
    const auto x = passing(fan, of_vertex);
    for (std::size_t i = 0; i < fan.cells.size(); ++i) {
      const int v = fan.vertex[i], l = function_of_vertex_[v];
      let_out(-x[i], cells_[fan.cells[i]], (v + 2) % 3, l, host.data());
      let_out(x[i + 1], cells_[fan.cells[i]], (v + 1) % 3, l, host.data());
    }
  }
  Kokkos::deep_copy(sigma, host);
}

std::vector<double> HeldBoundary::defects(const scene::Field& force, double t, const method::HeldSource& source,
                                          const double* sigma) const {
  const auto& basis = space_.basis();
  std::vector<double> e(owned_ * functions_, 0.0);
  method::QuadraturePoints points(space_.quadrature());
  const method::View<double*> f("thixis::dg::force", space_.quadrature().largest_block);
  const auto further = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), source.moments);
  for (std::size_t c = 0; c < owned_; ++c) {
    const Cell& cell = cells_[c];
    const auto& block = points.fill(cell.position, 1);
    method::evaluate(force, t, block, f);
    const auto xi = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), block.xi);
    const auto weight = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), block.weight);
    const auto value = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), f);
    const auto psi = basis.tabulate(block.points, xi.data()).value;
    for (int l = 0; l < functions_; ++l) {
      if (!cell.held[l]) continue;
      double sum = further.extent(0) > 0 ? source.factor * further(cell.position, l) : 0;
      for (int q = 0; q < block.points; ++q) sum += weight(q) * value(q) * psi[q * functions_ + l];
      for (int r = 0; r < width_; ++r) sum -= divergence_[l * width_ + r] * sigma[cell.position * width_ + r];
      e[c * functions_ + l] = sum;
    }
  }
  return e;
}

std::vector<double> HeldBoundary::fetched(const std::vector<double>& own) const {
  algebra::MultiVector source(import_->getSourceMap(), functions_), target(import_->getTargetMap(), functions_);
  {
    const auto values = source.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (std::size_t c = 0; c < owned_; ++c)
      for (int l = 0; l < functions_; ++l) values(c, l) = own[c * functions_ + l];
  }
  target.doImport(source, *import_, Tpetra::INSERT);
  std::vector<double> all(cells_.size() * functions_);
  const auto values = target.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t c = 0; c < cells_.size(); ++c)
    for (int l = 0; l < functions_; ++l) all[c * functions_ + l] = values(c, l);
  return all;
}

std::vector<double> HeldBoundary::passing(const Fan& fan, const std::vector<double>& e) {
  std::vector<double> x = {0};
  for (const double defect : e) x.push_back(x.back() + defect);
  double mean = 0;
  for (const double flux : x) mean += flux / static_cast<double>(x.size());
  const double first = !fan.first_held ? 0 : fan.last_held ? -mean : -x.back();
  for (double& flux : x) flux += first;
  return x;
}

void HeldBoundary::let_out(double x, const Cell& cell, int f, int l, double* sigma) const {
  if (!owned(cell)) return;
  for (int r = 0; r < width_; ++r) sigma[cell.position * width_ + r] += x * dual_[(f * functions_ + l) * width_ + r];
}

}  // namespace thixis::dg
