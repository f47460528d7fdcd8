#include "thixis/method/numbering.hpp"

#include <algorithm>

#include "thixis/algebra/tpetra.hpp"

namespace thixis::method {

void Entries::reserve(std::size_t count) {
  id.reserve(count);
  owner.reserve(count);
  held.reserve(count);
  point.reserve(count);
}

void Entries::add(GlobalIndex id_, int owner_, LocalIndex held_, std::array<double, 2> point_) {
  id.push_back(id_);
  owner.push_back(owner_);
  held.push_back(held_);
  point.push_back(point_);
}

Numbering number(const Entries& entries, const core::Comm& comm) {
  Numbering numbering;
  numbering.held = entries.held;

  // entries of this rank, then the ghosts by owner and identity
  std::vector<LocalIndex> order, ghosts;
  for (LocalIndex e = 0; e < entries.size(); ++e) (entries.owner[e] == comm.rank() ? order : ghosts).push_back(e);
  const std::size_t owned = order.size();
  std::sort(ghosts.begin(), ghosts.end(), [&](LocalIndex d, LocalIndex e) {
    return std::pair(entries.owner[d], entries.id[d]) < std::pair(entries.owner[e], entries.id[e]);
  });
  std::vector<GlobalIndex> ids;
  ids.reserve(entries.id.size());
  for (const LocalIndex e : order) ids.push_back(entries.id[e]);
  const auto own_map = algebra::map_of(ids, comm);
  for (const LocalIndex e : ghosts) ids.push_back(entries.id[e]);
  const auto all_map = algebra::map_of(ids, comm);
  order.insert(order.end(), ghosts.begin(), ghosts.end());

  LocalIndex unknowns = 0;
  for (std::size_t k = 0; k < owned; ++k) unknowns += entries.held[order[k]] < 0;
  numbering.rows = algebra::contiguous_map(unknowns, comm);

  // one number per entry tells the ghosts: the row, or -1 - tag
  algebra::Vector code(own_map), codes(all_map);
  {
    const auto out = algebra::host_overwrite(code);
    LocalIndex row = 0;
    for (std::size_t k = 0; k < owned; ++k) {
      const LocalIndex tag = entries.held[order[k]];
      out(k) = tag < 0 ? static_cast<double>(numbering.rows->getGlobalElement(row++)) : -1.0 - tag;
    }
  }
  codes.doImport(code, algebra::Import(own_map, all_map), Tpetra::INSERT);

  numbering.column_of_entry = mesh::View<LocalIndex*>("thixis::method::column_of_entry", entries.id.size());
  const auto column_of_entry = Kokkos::create_mirror_view(numbering.column_of_entry);
  std::vector<LocalIndex> entry_of_column;
  std::vector<GlobalIndex> columns;
  columns.reserve(order.size());
  const auto in = algebra::host_view(std::as_const(codes));
  for (std::size_t k = 0; k < order.size(); ++k) {
    const LocalIndex e = order[k];
    const bool held = in(k) < 0;
    numbering.held[e] = held ? static_cast<LocalIndex>(-1 - in(k)) : -1;
    column_of_entry(e) = held ? -1 : static_cast<LocalIndex>(columns.size());
    if (held) continue;
    entry_of_column.push_back(e);
    columns.push_back(static_cast<GlobalIndex>(in(k)));
  }
  Kokkos::deep_copy(numbering.column_of_entry, column_of_entry);
  numbering.entry_of_column = mesh::View<LocalIndex*>("thixis::method::entry_of_column", entry_of_column.size());
  Kokkos::deep_copy(numbering.entry_of_column,
                    Kokkos::View<const LocalIndex*, Kokkos::HostSpace>(entry_of_column.data(), entry_of_column.size()));
  numbering.columns = algebra::map_of(columns, comm);
  return numbering;
}

}  // namespace thixis::method
