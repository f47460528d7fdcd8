#include "transfer/parents.hpp"

#include <algorithm>

namespace thixis::method {

Parents::Parents(const Space& coarse, const Space& fine) : width_(coarse.components() * coarse.basis().size()) {
  const mesh::Mesh& mesh = fine.mesh();
  const auto cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), fine.cells());
  std::vector<LocalIndex> shape, parent;
  bool in_place = true;
  for (LocalIndex k = 0; k < cells.extent_int(0); ++k) {
    const LocalIndex above = mesh.cell_parent[cells(k)];
    shape.push_back(mesh.cell_shape[cells(k)]);
    parent.push_back(above < 0 ? -1 : coarse.position(above));
    in_place = in_place && parent.back() >= 0 && parent.back() < coarse.mesh().owned_cells;
  }
  if (!mesh.comm.all(in_place)) {
    std::vector<GlobalIndex> ids;
    for (LocalIndex k = 0; k < cells.extent_int(0); ++k) ids.push_back(mesh.cell_parent_id[cells(k)]);
    const std::vector<GlobalIndex> of_cell = ids;
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    for (std::size_t k = 0; k < of_cell.size(); ++k)
      parent[k] = static_cast<LocalIndex>(std::lower_bound(ids.begin(), ids.end(), of_cell[k]) - ids.begin());
    set_import(coarse.mesh(), ids);
  }
  shape_ = to_view("thixis::method::child", shape);
  parent_ = to_view("thixis::method::parent", parent);
}

void Parents::set_import(const mesh::Mesh& coarse, const std::vector<GlobalIndex>& parents) {
  const auto own = algebra::map_of({coarse.cell_id.begin(), coarse.cell_id.begin() + coarse.owned_cells}, coarse.comm);
  import_ = Teuchos::rcp(new algebra::Import(own, algebra::map_of(parents, coarse.comm)));
  const int n = width_;
  const Kokkos::View<LocalIndex**, Kokkos::LayoutRight> at("thixis::method::fetched", parents.size(), n);
  Kokkos::parallel_for(
      "thixis::method::fetched", Range(0, at.extent_int(0)), KOKKOS_LAMBDA(int s) {
        for (int i = 0; i < n; ++i) at(s, i) = s * n + i;
      });
  fetched_ = at;
}

Coefficients Parents::from_owners(const algebra::MultiVector& own) const {
  const int n = width_;
  algebra::MultiVector here(import_->getTargetMap(), n);
  here.doImport(own, *import_, Tpetra::INSERT);
  const Coefficients values("thixis::method::of_parents", fetched_.size());
  const auto in = std::as_const(here).getLocalViewDevice(Tpetra::Access::ReadOnly);
  Kokkos::parallel_for(
      "thixis::method::of_parents", Range(0, in.extent_int(0)), KOKKOS_LAMBDA(int s) {
        for (int i = 0; i < n; ++i) values(s * n + i) = in(s, i);
      });
  return values;
}

algebra::MultiVector Parents::to_owners(const Coefficients& values) const {
  const int n = width_;
  algebra::MultiVector own(import_->getSourceMap(), n), here(import_->getTargetMap(), n);
  {
    const auto out = here.getLocalViewDevice(Tpetra::Access::OverwriteAll);
    Kokkos::parallel_for(
        "thixis::method::to_owners", Range(0, out.extent_int(0)), KOKKOS_LAMBDA(int s) {
          for (int i = 0; i < n; ++i) out(s, i) = values(s * n + i);
        });
  }
  own.doExport(here, *import_, Tpetra::ADD);
  return own;
}

}  // namespace thixis::method
