#include "thixis/equilibration/multilevel_flux.hpp"

#include <algorithm>

#include "levels/descend_kernels.hpp"
#include "levels/root_flux.hpp"

namespace thixis::equilibration {

struct MultilevelFlux::Impl {
  core::Comm comm;
  mesh::Ancestry ancestry;
  int n, flux;
  RootFlux root;
  std::vector<std::vector<Family>> families;      ///< between levels j and j + 1
  mutable std::vector<CellTable> density, sigma;  ///< of the levels; the last ones only if its list is not that of the owned cells
  bool direct;                                    ///< the last list holds the owned cells and nothing else
  View<LocalIndex*> leaf;

  Impl(mesh::Ancestry of_cells, const core::Comm& all, const std::vector<bool>& held, int q)
      : comm(all),
        ancestry(std::move(of_cells)),
        n(reference::dimension(q)),
        flux(2 * reference::dimension(q + 1)),
        root(ancestry.root, held, q),
        leaf("thixis::equilibration::leaf", ancestry.leaf.size()) {
    const auto leaf_host = Kokkos::create_mirror_view(leaf);
    std::copy(ancestry.leaf.begin(), ancestry.leaf.end(), leaf_host.data());
    Kokkos::deep_copy(leaf, leaf_host);
    const int last = static_cast<int>(ancestry.levels.size());
    direct = last > 0 && ancestry.leaf.size() == size_of(last) && !(comm.size() > 1 && last <= ancestry.shared);
    for (int j = 0; j <= last; ++j) {
      const LocalIndex count = j == last && direct ? 0 : static_cast<LocalIndex>(size_of(j));
      density.emplace_back("thixis::equilibration::level_density", count, n);
      sigma.emplace_back("thixis::equilibration::level_flux", count, flux);
    }
    Families families_of(q);
    for (int j = 0; j < last; ++j)
      families.push_back(families_of(size_of(j), ancestry.levels[j], direct && j + 1 == last ? cell_of_leaf() : std::vector<LocalIndex>()));
    for (auto& level : ancestry.levels) level = {};  // the families know all of it
  }

  std::size_t size_of(int level) const {
    return level == 0 ? static_cast<std::size_t>(ancestry.root->cells) : ancestry.levels[level - 1].parent.size();
  }

  /// Where the cells of the last list are among the owned ones.
  std::vector<LocalIndex> cell_of_leaf() const {
    std::vector<LocalIndex> cell(ancestry.leaf.size());
    for (std::size_t K = 0; K < ancestry.leaf.size(); ++K) cell[ancestry.leaf[K]] = static_cast<LocalIndex>(K);
    return cell;
  }

  void reduce(const CellTable& table) const {
    if (comm.size() == 1) return;
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), table);
    std::vector<double> values(host.data(), host.data() + host.size());
    comm.sum(values);
    std::copy(values.begin(), values.end(), host.data());
    Kokkos::deep_copy(table, host);
  }
};

MultilevelFlux::MultilevelFlux(mesh::Ancestry ancestry, const core::Comm& comm, const std::vector<bool>& held, int q)
    : impl_(std::make_unique<Impl>(std::move(ancestry), comm, held, q)) {}
MultilevelFlux::~MultilevelFlux() = default;

double MultilevelFlux::operator()(const ConstCellTable& r, const CellTable& sigma) const {
  const Impl& in = *impl_;
  const int last = static_cast<int>(in.families.size()), n = in.n, flux = in.flux;
  const auto leaf = in.leaf;
  if (!in.direct) {
    const CellTable table = in.density[last];
    Kokkos::deep_copy(table, 0);
    Kokkos::parallel_for(
        "thixis::equilibration::to_leaves", Kokkos::RangePolicy<>(0, leaf.extent_int(0)), KOKKOS_LAMBDA(int K) {
          for (int k = 0; k < n; ++k) table(leaf(K), k) = r(K, k);
        });
  }
  const auto density = [&](int j) { return j == last && in.direct ? r : ConstCellTable(in.density[j]); };
  if (last == in.ancestry.shared && !in.direct) in.reduce(in.density[last]);
  for (int j = last - 1; j >= 0; --j) {
    if (j == in.ancestry.shared) Kokkos::deep_copy(in.density[j], 0);
    for (const Family& family : in.families[j])
      Kokkos::parallel_for("thixis::equilibration::sum_children", Kokkos::RangePolicy<>(0, family.parent.extent_int(0)),
                           Sum{family.cut, family.parent, family.child, n, density(j + 1), in.density[j]});
    if (j == in.ancestry.shared) in.reduce(in.density[j]);
  }
  const double left =
      in.root(in.density[0].extent(0) > 0 ? ConstCellTable(in.density[0]) : r, in.direct && last == 0 ? sigma : in.sigma[0]);
  for (int j = 0; j < last; ++j)
    for (const Family& family : in.families[j]) {
      Descend kernel;
      kernel.cut = family.cut;
      kernel.parent = family.parent;
      kernel.child = family.child;
      kernel.n = n;
      kernel.flux = flux;
      kernel.fine = density(j + 1);
      kernel.coarse = in.density[j];
      kernel.sigma_coarse = in.sigma[j];
      kernel.sigma_fine = j + 1 == last && in.direct ? sigma : in.sigma[j + 1];
      Kokkos::parallel_for("thixis::equilibration::descend", Kokkos::RangePolicy<>(0, family.parent.extent_int(0)), kernel);
    }
  if (in.direct) return left;
  const ConstCellTable table = in.sigma[last];
  Kokkos::parallel_for(
      "thixis::equilibration::from_leaves", Kokkos::RangePolicy<>(0, leaf.extent_int(0)), KOKKOS_LAMBDA(int K) {
        for (int i = 0; i < flux; ++i) sigma(K, i) = table(leaf(K), i);
      });
  return left;
}

std::size_t MultilevelFlux::bytes() const {
  const Impl& in = *impl_;
  std::size_t sum = in.root.bytes();
  for (const auto& level : in.density) sum += sizeof(double) * level.size();
  for (const auto& level : in.sigma) sum += sizeof(double) * level.size();
  for (const auto& level : in.families)
    for (const Family& family : level) sum += sizeof(LocalIndex) * (family.parent.size() + family.child.size());
  return sum;
}

}  // namespace thixis::equilibration
