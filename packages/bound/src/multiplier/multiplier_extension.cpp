#include "multiplier/multiplier_extension.hpp"

#include <algorithm>

#include "data/on_host.hpp"
#include "data/tables.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::bound {
namespace {

using algebra::MultiVector;

/// Adds the polynomial `from` in x' to `to` in x, x' = ratio x + offset, y' = ratio y + offset, in the order of monomials().
template <class From>
void add_translated(int degree, const From& from, double ratio, const double (&offset)[2], double* to) {
  constexpr double binomial[4][4] = {{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}};
  const auto index = [](int i, int j) { return (i + j) * (i + j + 1) / 2 + j; };
  double power[3][4];
  for (int k = 0; k < 4; ++k)
    for (int d = 0; d < 3; ++d) power[d][k] = k == 0 ? 1 : power[d][k - 1] * (d < 2 ? offset[d] : ratio);
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; i + j <= degree; ++j)
      for (int s = 0; s <= i; ++s)
        for (int t = 0; t <= j; ++t)
          to[index(s, t)] += from(index(i, j)) * binomial[i][s] * binomial[j][t] * power[2][s + t] * power[0][i - s] * power[1][j - t];
}

}  // namespace

MultiplierExtension::MultiplierExtension(const method::Space& space, const VertexPatches& patches, const Fits& fits)
    : degree_(space.basis().degree() - 1),
      columns_(reference::dimension(degree_)),
      comm_(space.mesh().comm),
      patch_of_vertex_(space.mesh().vertices, -1),
      around_(patches.size()),
      generation_(space.mesh().vertices, -1),
      diameter_(space.mesh().vertices, 0.0),
      place_(on_host(space.mesh().coordinates)) {
  const mesh::Mesh& mesh = space.mesh();
  const auto vertex = on_host(patches.vertex);
  patch_vertex_.assign(vertex.data(), vertex.data() + patches.size());
  for (LocalIndex a = 0; a < patches.size(); ++a) patch_of_vertex_[patch_vertex_[a]] = a;

  const auto cells = on_host(space.cells());
  const auto corners = on_host(mesh.cell_vertices);
  std::vector<bool> met(mesh.vertices, false);
  std::vector<GlobalIndex> own_ids, ids;
  for (std::size_t k = 0; k < cells.extent(0); ++k)
    for (int i = 0; i < 3; ++i) {
      const LocalIndex v = corners(cells(k), i);
      if (met[v]) continue;
      met[v] = true;
      all_.push_back(v);
      ids.push_back(mesh.vertex_id[v]);
      if (mesh.vertex_owner[v] != comm_.rank()) continue;
      own_.push_back(v);
      own_ids.push_back(mesh.vertex_id[v]);
    }
  import_ = Teuchos::rcp(new algebra::Import(algebra::map_of(own_ids, comm_), algebra::map_of(ids, comm_)));
  const auto offset = on_host(patches.offset), cell = on_host(patches.cell);
  const auto fit = on_host(fits.fit_offset), nodes = on_host(fits.node_offset);
  for (LocalIndex a = 0; a < patches.size(); ++a) {
    if (degree_ > 0 ? fit(a + 1) > fit(a) : nodes(a + 1) > nodes(a)) continue;
    for (LocalIndex e = offset(a); e < offset(a + 1); ++e)
      for (int i = 0; i < 3; ++i)
        if (const LocalIndex v = corners(cells(cell(e)), i); v != patch_vertex_[a]) around_[a].push_back(v);
  }
  find_generations(fits);
}

void MultiplierExtension::find_generations(const Fits& fits) {
  MultiVector own(import_->getSourceMap(), 2), all(import_->getTargetMap(), 2);
  const auto diameter = on_host(fits.diameter);
  for (int round = 0;; ++round) {
    {
      const auto out = own.getLocalViewHost(Tpetra::Access::OverwriteAll);
      for (std::size_t i = 0; i < own_.size(); ++i) {
        const LocalIndex a = patch_of_vertex_[own_[i]];
        int& generation = generation_[own_[i]];
        if (generation < 0 && (round == 0 ? around_[a].empty() : !sources(a, round).empty())) generation = round;
        out(i, 0) = generation;
        out(i, 1) = diameter(a);
      }
    }
    all.doImport(own, *import_, Tpetra::INSERT);
    bool reached = false;
    const auto in = all.getLocalViewHost(Tpetra::Access::ReadOnly);
    for (std::size_t i = 0; i < all_.size(); ++i) {
      generation_[all_[i]] = static_cast<int>(in(i, 0));
      diameter_[all_[i]] = in(i, 1);
      reached = reached || generation_[all_[i]] == round;
    }
    if (!comm_.any(reached)) return;
    rounds_ = round;
  }
}

View<int*> MultiplierExtension::generations() const {
  std::vector<int> of_patches;
  for (const LocalIndex v : patch_vertex_) of_patches.push_back(generation_[v]);
  return to_view("thixis::bound::generation", of_patches);
}

MultiplierExtension::Around MultiplierExtension::sources(LocalIndex a, int round) const {
  Around found;
  for (const LocalIndex v : around_[a])
    if (generation_[v] >= 0 && generation_[v] < round) found.push_back(v);
  return found;
}

void MultiplierExtension::operator()(const CellTable& coefficients, const View<double*>& mean) const {
  const bool complete = std::all_of(around_.begin(), around_.end(), [](const Around& around) { return around.empty(); });
  if (rounds_ == 0 && complete) return;
  const auto c = on_host(coefficients);
  const auto m = on_host(mean);
  for (std::size_t a = 0; a < around_.size(); ++a)
    if (!around_[a].empty()) {
      for (int b = 0; b < columns_; ++b) c(a, b) = 0;
      if (generation_[patch_vertex_[a]] < 0) m(a) = std::max(m(a), 0.0);
    }
  MultiVector own(import_->getSourceMap(), columns_ + 1), all(import_->getTargetMap(), columns_ + 1);
  std::vector<std::size_t> row(generation_.size());
  for (std::size_t i = 0; i < all_.size(); ++i) row[all_[i]] = i;
  for (int round = 1; round <= rounds_; ++round) {
    {
      const auto out = own.getLocalViewHost(Tpetra::Access::OverwriteAll);
      for (std::size_t i = 0; i < own_.size(); ++i) {
        const LocalIndex a = patch_of_vertex_[own_[i]];
        for (int b = 0; b < columns_; ++b) out(i, b) = c(a, b);
        out(i, columns_) = m(a);
      }
    }
    all.doImport(own, *import_, Tpetra::INSERT);
    const auto in = all.getLocalViewHost(Tpetra::Access::ReadOnly);
    for (std::size_t a = 0; a < around_.size(); ++a) {
      const LocalIndex v = patch_vertex_[a];
      if (generation_[v] != round) continue;
      const auto from = sources(static_cast<LocalIndex>(a), round);
      double sum[most_coefficients] = {}, of_means = 0;
      for (const LocalIndex b : from) {
        const double offset[2] = {(place_(v, 0) - place_(b, 0)) / diameter_[b], (place_(v, 1) - place_(b, 1)) / diameter_[b]};
        add_translated(
            degree_, [&](int k) { return in(row[b], k); }, diameter_[v] / diameter_[b], offset, sum);
        of_means += std::max(in(row[b], columns_), 0.0);
      }
      for (int b = 0; b < columns_; ++b) c(a, b) = sum[b] / static_cast<double>(from.size());
      if (m(a) < 0) m(a) = of_means / static_cast<double>(from.size());
    }
  }
  Kokkos::deep_copy(coefficients, c);
  Kokkos::deep_copy(mean, m);
}

}  // namespace thixis::bound
