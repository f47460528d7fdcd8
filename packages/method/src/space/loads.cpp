#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/polynomial_kernels.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/to_view.hpp"
#include "thixis/method/evaluate.hpp"
#include "thixis/method/space.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::method {
namespace {

using Traces = Kokkos::View<const double***, Kokkos::LayoutRight>;
using Columns = Kokkos::View<LocalIndex**, Kokkos::LayoutRight>;

/// Points of the face f of the reference cell, from vertex f+1 to f+2, at t.
std::array<double, 2> on_face(int f, double t) {
  constexpr double corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  const double* const a = corner[(f + 1) % 3];
  const double* const b = corner[(f + 2) % 3];
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
}

/// (f, q, l): the basis functions at the points of a line rule on each face of the reference cell.
Traces traces_of(const reference::CellBasis& basis, const reference::Quadrature& rule) {
  const int n = basis.size();
  const Kokkos::View<double***, Kokkos::LayoutRight> traces("thixis::method::traces", 3, rule.size(), n);
  const auto host = Kokkos::create_mirror_view(traces);
  for (int f = 0; f < 3; ++f)
    for (int q = 0; q < rule.size(); ++q) {
      const auto value = basis.tabulate(1, on_face(f, rule.point[q]).data()).value;
      for (int l = 0; l < n; ++l) host(f, q, l) = value[l];
    }
  Kokkos::deep_copy(traces, host);
  return traces;
}

/// The faces with a tag, as faces of patch cells: positions of these, and the number of the face there.
struct TaggedFaces {
  View<const LocalIndex*> position;
  View<const int*> face;
  LocalIndex size() const { return position.extent_int(0); }
};

TaggedFaces with_tag(const Space& space, LocalIndex tag) {
  const mesh::HostMesh& mesh = space.host();
  std::vector<LocalIndex> positions;
  std::vector<int> faces;
  for (LocalIndex F = 0; F < space.mesh().faces; ++F) {
    if (mesh.face_tag(F) != tag) continue;
    const LocalIndex K = mesh::first_cell(mesh.face_cells, F);
    if (space.position(K) < 0) continue;
    positions.push_back(space.position(K));
    faces.push_back(mesh::local_face(mesh.cell_faces, K, F));
  }
  return {mesh::to_view("thixis::method::tagged_cells", positions), mesh::to_view("thixis::method::tagged_faces", faces)};
}

/// The points of a line rule on these faces, from vertex f+1 to f+2 of the cell.
struct PlaceOnFaces {
  View<double* [2]> coordinates;
  View<LocalIndex* [3]> vertices;
  View<const LocalIndex*> cells;
  TaggedFaces on;
  Values t;
  View<double*> x, y, length;  ///< out, overwritten: (e, q), flat; (e)

  KOKKOS_FUNCTION void operator()(int e) const {
    const LocalIndex K = cells(on.position(e)), a = vertices(K, (on.face(e) + 1) % 3), b = vertices(K, (on.face(e) + 2) % 3);
    const double dx = coordinates(b, 0) - coordinates(a, 0), dy = coordinates(b, 1) - coordinates(a, 1);
    length(e) = std::hypot(dx, dy);
    for (int q = 0; q < t.extent_int(0); ++q) {
      x(e * t.extent_int(0) + q) = coordinates(a, 0) + t(q) * dx;
      y(e * t.extent_int(0) + q) = coordinates(a, 1) + t(q) * dy;
    }
  }
};

/// F(e, l) = <t, psi_l> over a face, and the columns of a component of these functions.
struct TraceMoments {
  TaggedFaces on;
  Traces trace;
  Values weight, length, traction;  ///< (q), (e), (e, q)
  ElementUnknowns elements;
  Component component;
  Columns columns;  ///< out, overwritten
  Block2 F;         ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const int points = weight.extent_int(0);
    for (int l = 0; l < F.extent_int(1); ++l) {
      columns(e, l) = elements(on.position(e), component(l));
      F(e, l) = 0;
      for (int q = 0; q < points; ++q) F(e, l) += length(e) * weight(q) * traction(e * points + q) * trace(on.face(e), q, l);
    }
  }
};

/// The loads of tractions on faces, by a line rule.
class TraceLoads {
 public:
  explicit TraceLoads(const Space& space)
      : space_(space),
        rule_(reference::line_quadrature(space.options().params.order())),
        t_(mesh::to_view("thixis::method::line_points", rule_.point)),
        weight_(mesh::to_view("thixis::method::line_weights", rule_.weight)),
        trace_(traces_of(space.basis(), rule_)) {}

  /// Throws on this rank only.
  void add(const scene::Field& traction, double t, LocalIndex tag, int component, algebra::Vector& F) const {
    const TaggedFaces on = with_tag(space_, tag);
    if (on.size() == 0) return;
    const View<double*> x("thixis::method::trace_x", on.size() * rule_.size()), y("thixis::method::trace_y", x.extent(0)),
        value("thixis::method::traction", x.extent(0)), length("thixis::method::face_length", on.size());
    place(on, x, y, length);
    evaluate(traction, t, x.extent_int(0), x, y, value);

    TraceMoments kernel;
    kernel.on = on;
    kernel.trace = trace_;
    kernel.weight = weight_;
    kernel.length = length;
    kernel.traction = value;
    kernel.elements = space_.elements();
    kernel.component = {space_.components(), component};
    kernel.columns = Columns("thixis::method::trace_columns", on.size(), space_.basis().size());
    kernel.F = Block2("thixis::method::trace_loads", on.size(), space_.basis().size());
    Kokkos::parallel_for("thixis::method::trace_moments", Kokkos::RangePolicy<>(0, on.size()), kernel);
    scatter(kernel.columns, 0, kernel.F, F);
  }

 private:
  void place(const TaggedFaces& on, const View<double*>& x, const View<double*>& y, const View<double*>& length) const {
    PlaceOnFaces kernel;
    kernel.coordinates = space_.mesh().coordinates;
    kernel.vertices = space_.mesh().cell_vertices;
    kernel.cells = space_.cells();
    kernel.on = on;
    kernel.t = t_;
    kernel.x = x;
    kernel.y = y;
    kernel.length = length;
    Kokkos::parallel_for("thixis::method::place_on_faces", Kokkos::RangePolicy<>(0, on.size()), kernel);
  }

  const Space& space_;
  reference::Quadrature rule_;
  View<const double*> t_, weight_;
  Traces trace_;
};

}  // namespace

void Space::add_moments(const Function& f, double t, algebra::Vector& F) const {
  THIXIS_ASSERT_EQ(f.components(), components(), "a function for each component");
  const View<double*> values(Kokkos::view_alloc(std::string("thixis::method::force"), Kokkos::WithoutInitializing),
                             quadrature_.largest_block);
  const Block2 local("thixis::method::loads", std::min(quadrature_.block_cells, quadrature_.cells()), components() * basis_.size());
  const CellFunctions basis = cell_functions(basis_);
  const auto rule = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), quadrature_.rule_xi);
  const int points = rule.extent_int(0);
  const Table at_rule = matrix_view("thixis::method::at_rule", points, basis_.size(), basis_.tabulate(points, rule.data()).value);
  for_each_block(quadrature_, [&](const QuadratureBlock& block) {
    const Block2 part = Kokkos::subview(local, std::pair(0, block.cells), Kokkos::ALL);
    for (int i = 0; i < components(); ++i) {
      evaluate(f[i], t, block, values);
      moments(basis, at_rule, block, values, {components(), i}, part);
    }
    scatter(elements_, block.first, part, F);
  });
}

void Layout::add_traces(const Space& space, const std::vector<scene::FieldPtr>& by_tag, double t, algebra::Vector& F) const {
  if (std::none_of(by_tag.begin(), by_tag.end(), [](const scene::FieldPtr& traction) { return traction != nullptr; })) return;
  const TraceLoads loads(space);
  for (std::size_t at = 0; at < by_tag.size(); ++at) {
    const int tag = static_cast<int>(at) / space.components(), component = static_cast<int>(at) % space.components();
    if (by_tag[at]) loads.add(*by_tag[at], t, tag, component, F);
  }
}

}  // namespace thixis::method
