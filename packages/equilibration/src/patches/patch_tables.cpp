#include "patches/patch_tables.hpp"

namespace thixis::equilibration {
namespace {

/// Allocates a table and fills it on the host.
template <class Table, class F>
void fill(Table& table, F f) {
  table = Table("thixis::equilibration::tables");
  const auto host = Kokkos::create_mirror_view(table);
  f(host);
  Kokkos::deep_copy(table, host);
}

}  // namespace

template <int Q>
PatchTables<Q> PatchTables<Q>::make() {
  const reference::RaviartThomas rt(Q);
  const reference::Modal modal(Q);
  const auto shortened = [](const std::vector<double>& v, int l) { return v[l / density * (flux / 2) + l % density]; };

  PatchTables tables;
  fill(tables.face, [&](const auto& table) {
    for (int f = 0; f < 3; ++f)
      for (int j = 0; j <= Q; ++j)
        for (int l = 0; l < length; ++l) table(f, j, l) = shortened(rt.from_face(f, j), l);
  });
  fill(tables.from_density, [&](const auto& table) {
    for (int m = 0; m < density; ++m)
      for (int l = 0; l < length; ++l) table(m, l) = shortened(rt.from_density(m), l);
  });
  fill(tables.hat, [&](const auto& table) {
    for (int i = 0; i < 3; ++i)
      for (int m = 0; m < density; ++m)
        for (int l = 0; l < density; ++l) table(i, m, l) = modal.times_barycentric(i)[m * density + l];
  });
  fill(tables.bubble, [&](const auto& table) {
    for (int m = 0; m < bubbles; ++m)
      for (int l = 0; l < length; ++l) table(m, l) = shortened(rt.bubble(m), l);
  });
  fill(tables.bubble_transposed, [&](const auto& table) {
    for (int m = 0; m < bubbles; ++m)
      for (int l = 0; l < length; ++l) table(l, m) = shortened(rt.bubble(m), l);
  });
  fill(tables.test, [&](const auto& table) {
    for (int i = 0; i < 3; ++i)
      for (int l = 0; l < length; ++l) {
        const int before = (i + 2) % 3, after = (i + 1) % 3;  // faces: from the vertex outwards, and towards it
        for (int j = 1; j <= Q; ++j) {
          table(i, l, j - 1) = -shortened(rt.from_face(before, j), l);
          table(i, l, Q + j - 1) = (j % 2 == 0 ? 1 : -1) * shortened(rt.from_face(after, j), l);
        }
        table(i, l, 2 * Q) = shortened(rt.from_face(after, 0), l) - shortened(rt.from_face(before, 0), l);
      }
  });
  fill(tables.field, [&](const auto& table) {
    const auto set = [&](int row, const std::vector<double>& v) {
      for (int l = 0; l < flux; ++l) table(row, l) = v[l];
    };
    for (int f = 0; f < 3; ++f)
      for (int j = 0; j <= Q; ++j) set(f * (Q + 1) + j, rt.from_face(f, j));
    for (int m = 1; m < density; ++m) set(3 * (Q + 1) + m - 1, rt.from_density(m));
    for (int m = 0; m < bubbles; ++m) set(given + m, rt.bubble(m));
  });
  return tables;
}

template struct PatchTables<0>;
template struct PatchTables<1>;
template struct PatchTables<2>;
template struct PatchTables<3>;
template struct PatchTables<4>;

}  // namespace thixis::equilibration
