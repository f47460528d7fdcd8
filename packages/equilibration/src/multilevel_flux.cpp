#include "thixis/equilibration/multilevel_flux.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "root_flux.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/equilibration/cut.hpp"

namespace thixis::equilibration {
namespace {

constexpr int most_children = 4;
using Children = View<LocalIndex* [most_children]>;

/// The matrices of a Cut by columns, for kernels.
struct CutMatrices {
  int children;
  Matrix sum, share, lift, restrict;  ///< transposed
};

Matrix by_columns(const std::string& label, int rows, int columns, const std::vector<double>& values) {
  const Kokkos::View<double**, Kokkos::LayoutRight> matrix(label, columns, rows);
  const auto host = Kokkos::create_mirror_view(matrix);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) host(j, i) = values.empty() ? 0 : values[i * columns + j];
  Kokkos::deep_copy(matrix, host);
  return matrix;
}

CutMatrices matrices(const Cut& cut, int q) {
  const int n = reference::dimension(q), flux = 2 * reference::dimension(q + 1), c = cut.children;
  return {c, by_columns("thixis::equilibration::sum", n, c * n, cut.sum), by_columns("thixis::equilibration::share", c * n, n, cut.share),
          by_columns("thixis::equilibration::lift", c * flux, c * n, cut.lift),
          by_columns("thixis::equilibration::restrict", c * flux, flux, cut.restrict)};
}

/// The cells of one level that are cut alike, with their children.
struct Family {
  CutMatrices cut;
  View<LocalIndex*> parent;
  Children child;
};

/// y += M x, M by columns.
KOKKOS_INLINE_FUNCTION void add_product(const Matrix& M, const double* x, double* y) {
  const int rows = M.extent_int(1);
  for (int k = 0; k < M.extent_int(0); ++k) {
    const double a = x[k];
    const double* const column = &M(k, 0);
    for (int i = 0; i < rows; ++i) y[i] += a * column[i];
  }
}

constexpr int most_densities = reference::dimension(4), most_fluxes = 2 * reference::dimension(5);

struct Sum {
  CutMatrices cut;
  View<const LocalIndex*> parent;
  Children child;
  int n;
  ConstCellTable fine;
  CellTable coarse;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    double x[most_children * most_densities], y[most_densities];
    for (int c = 0; c < cut.children; ++c)
      for (int k = 0; k < n; ++k) x[c * n + k] = child(e, c) < 0 ? 0 : fine(child(e, c), k);
    for (int k = 0; k < n; ++k) y[k] = 0;
    add_product(cut.sum, x, y);
    for (int k = 0; k < n; ++k) coarse(parent(e), k) = y[k];
  }
};

/// sigma of the children = restriction of that of the cell + lift of what their densities are beyond that of the cell.
struct Descend {
  CutMatrices cut;
  View<const LocalIndex*> parent;
  Children child;
  int n, flux;
  ConstCellTable fine, coarse, sigma_coarse;
  CellTable sigma_fine;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const int c_n = cut.children * n, c_flux = cut.children * flux;
    double x[most_children * most_densities], y[most_children * most_fluxes], minus[most_densities];
    for (int c = 0; c < cut.children; ++c)
      for (int k = 0; k < n; ++k) x[c * n + k] = child(e, c) < 0 ? 0 : fine(child(e, c), k);
    for (int k = 0; k < n; ++k) minus[k] = -coarse(parent(e), k);
    add_product(cut.share, minus, x);
    for (int i = 0; i < c_flux; ++i) y[i] = 0;
    add_product(cut.restrict, &sigma_coarse(parent(e), 0), y);
    bool nothing = true;
    for (int i = 0; i < c_n; ++i) nothing = nothing && x[i] == 0;
    if (cut.children > 1 && !nothing) add_product(cut.lift, x, y);
    for (int c = 0; c < cut.children; ++c)
      if (child(e, c) >= 0)
        for (int i = 0; i < flux; ++i) sigma_fine(child(e, c), i) = y[c * flux + i];
  }
};

}  // namespace

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
    std::map<std::vector<mesh::ChildShape>, CutMatrices> known;
    for (int j = 0; j < last; ++j) families.push_back(families_below(j, q, known));
    for (auto& level : ancestry.levels) level = {};  // the families know all of it
  }

  std::size_t size_of(int level) const {
    return level == 0 ? static_cast<std::size_t>(ancestry.root->cells) : ancestry.levels[level - 1].parent.size();
  }

  std::vector<Family> families_below(int j, int q, std::map<std::vector<mesh::ChildShape>, CutMatrices>& known) const {
    const auto& parent = ancestry.levels[j].parent;
    const auto& shape = ancestry.levels[j].shape;
    const bool at_leaves = direct && j + 1 == static_cast<int>(ancestry.levels.size());
    std::vector<LocalIndex> cell_of_leaf;
    if (at_leaves) {
      cell_of_leaf.resize(parent.size());
      for (std::size_t K = 0; K < ancestry.leaf.size(); ++K) cell_of_leaf[ancestry.leaf[K]] = static_cast<LocalIndex>(K);
    }
    std::vector<std::array<LocalIndex, most_children>> children(size_of(j), {-1, -1, -1, -1});
    for (std::size_t c = 0; c < parent.size(); ++c) {
      auto& of_parent = children[parent[c]];
      *std::find(of_parent.begin(), of_parent.end(), -1) = static_cast<LocalIndex>(c);
    }
    std::map<std::vector<mesh::ChildShape>, std::vector<LocalIndex>> alike;
    std::vector<mesh::ChildShape> shapes;
    for (std::size_t K = 0; K < children.size(); ++K) {
      auto& of_parent = children[K];
      const auto end = std::find(of_parent.begin(), of_parent.end(), -1);
      if (end == of_parent.begin()) continue;  // of another rank
      std::sort(of_parent.begin(), end, [&](LocalIndex a, LocalIndex b) { return shape[a] < shape[b]; });
      shapes.clear();
      for (auto c = of_parent.begin(); c != end; ++c) shapes.push_back(shape[*c]);
      alike[shapes].push_back(static_cast<LocalIndex>(K));
    }
    std::vector<Family> found;
    for (const auto& [key, parents] : alike) {
      if (known.count(key) == 0) known.emplace(key, matrices(cut(key, q), q));
      Family family{known.at(key), View<LocalIndex*>("thixis::equilibration::parent", parents.size()),
                    Children("thixis::equilibration::children", parents.size())};
      const auto parent_host = Kokkos::create_mirror_view(family.parent);
      const auto child_host = Kokkos::create_mirror_view(family.child);
      for (std::size_t e = 0; e < parents.size(); ++e) {
        parent_host(e) = parents[e];
        for (int c = 0; c < most_children; ++c) {
          const LocalIndex child = children[parents[e]][c];
          child_host(e, c) = child >= 0 && at_leaves ? cell_of_leaf[child] : child;
        }
      }
      Kokkos::deep_copy(family.parent, parent_host);
      Kokkos::deep_copy(family.child, child_host);
      found.push_back(family);
    }
    return found;
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
