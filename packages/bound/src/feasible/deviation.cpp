#include "feasible/deviation.hpp"

#include <algorithm>
#include <cmath>

#include "thixis/mesh/remoteness.hpp"

namespace thixis::bound {
namespace {

/// The part of a quadrature at some positions.
method::CellQuadrature subset(const method::CellQuadrature& all, const std::vector<LocalIndex>& positions) {
  const LocalIndex count = static_cast<LocalIndex>(positions.size());
  const View<LocalIndex*> cell("thixis::bound::subset_cell", count), own_rule("thixis::bound::subset_rule", count);
  const View<GlobalIndex*> offset("thixis::bound::subset_offset", count + 1);
  for (LocalIndex k = 0; k < count; ++k) {
    cell(k) = all.cell(positions[k]);
    own_rule(k) = all.own_rule(positions[k]);
    offset(k + 1) = offset(k) + all.offset(positions[k] + 1) - all.offset(positions[k]);
  }
  method::CellQuadrature some = all;
  some.cell = cell;
  some.own_rule = own_rule;
  some.offset = offset;
  some.largest_block = 0;
  for (LocalIndex first = 0; first < count; first += some.block_cells)
    some.largest_block = std::max(some.largest_block, static_cast<int>(offset(std::min(first + some.block_cells, count)) - offset(first)));
  return some;
}

/// The same rule on each of sides² equal parts of every cell: integrands jump where the gap changes its sign.
method::CellQuadrature composite(method::CellQuadrature quadrature, int sides) {
  const int points = quadrature.rule_weight.extent_int(0), parts = sides * sides;
  const View<double* [2]> xi("thixis::bound::composite_xi", parts * points);
  const View<double*> weight("thixis::bound::composite_weight", parts * points);
  int at = 0;
  const auto add = [&](double origin_xi, double origin_eta, double scale) {
    for (int q = 0; q < points; ++q, ++at) {
      xi(at, 0) = origin_xi + scale * quadrature.rule_xi(q, 0);
      xi(at, 1) = origin_eta + scale * quadrature.rule_xi(q, 1);
      weight(at) = quadrature.rule_weight(q) / parts;
    }
  };
  const double h = 1.0 / sides;
  for (int i = 0; i < sides; ++i)
    for (int j = 0; i + j < sides; ++j) {
      add(i * h, j * h, h);
      if (i + j + 1 < sides) add((i + 1) * h, (j + 1) * h, -h);
    }
  const View<GlobalIndex*> offset("thixis::bound::composite_offset", quadrature.cells() + 1);
  for (LocalIndex k = 0; k <= quadrature.cells(); ++k) offset(k) = static_cast<GlobalIndex>(k) * parts * points;
  quadrature.rule_xi = xi;
  quadrature.rule_weight = weight;
  quadrature.offset = offset;
  quadrature.largest_block *= parts;
  return quadrature;
}

/// Points of the reference triangle on its faces, those of one after those of the other.
constexpr int points_of_face = 16;
View<double* [2]> face_points() {
  const View<double* [2]> xi("thixis::bound::face_points", 3 * points_of_face);
  for (int i = 0; i < 3; ++i)
    for (int m = 0; m < points_of_face; ++m) {
      double lambda[3] = {0, 0, 0};
      lambda[(i + 1) % 3] = 1 - (m + 0.5) / points_of_face;
      lambda[(i + 2) % 3] = (m + 0.5) / points_of_face;
      for (int d = 0; d < 2; ++d) xi(i * points_of_face + m, d) = lambda[1 + d];
    }
  return xi;
}

/// Marks the held faces of a cell on which D, given at face_points(), is more than round-off.
void mark_held(const mesh::HostMesh& host, const std::vector<bool>& dirichlet, LocalIndex K, const double* D, double noise,
               const View<bool* [3]>& on_held, LocalIndex place) {
  for (int i = 0; i < 3; ++i) {
    const LocalIndex tag = host.face_tag(host.cell_faces(K, i));
    if (tag < 0 || !dirichlet[tag]) continue;
    for (int m = 0; m < points_of_face; ++m) on_held(place, i) = on_held(place, i) || std::abs(D[i * points_of_face + m]) > noise;
  }
}

View<LocalIndex*> nowhere(const mesh::Mesh& mesh) {
  const View<LocalIndex*> place("thixis::bound::place_of_deviation", mesh.owned_cells);
  Kokkos::deep_copy(place, -1);
  return place;
}

}  // namespace

Deviation deviation_of_membranes(const method::PolynomialSpace& space, const BoundaryLift& lift, const std::vector<bool>& dirichlet,
                                 double noise) {
  if (lift.empty()) return {};
  const mesh::Mesh& mesh = space.mesh();
  const auto& cells = lift.cells();
  const auto place = nowhere(mesh);
  Deviation deviation;
  deviation.quadrature = composite(method::make_quadrature(mesh, cells, 6, nullptr), 4);
  const View<double*> bound("thixis::bound::deviation_bound", cells.extent(0));
  const View<double* [3]> D("thixis::bound::deviation", deviation.quadrature.points());
  const auto host = mesh::on_host(mesh);
  const View<bool* [3]> on_held("thixis::bound::deviation_on_held", cells.extent(0));
  const LiftTable table = lift.table(deviation.quadrature.rule_xi), on_faces = lift.table(face_points());
  std::vector<double> L[3];
  for (LocalIndex k = 0; k < cells.extent_int(0); ++k) {
    place(cells(k)) = k;
    bound(k) = lift.bound_of_difference(k);
    const auto K = mesh::cell_geometry(host.coordinates, host.cell_vertices, cells(k));
    on_faces.evaluate(lift.difference(k), L);
    mark_held(host, dirichlet, cells(k), L[0].data(), noise, on_held, k);
    table.evaluate(lift.difference(k), L);
    const GlobalIndex first = deviation.quadrature.offset(k);
    for (int q = 0; q < table.points(); ++q) {
      D(first + q, 0) = L[0][q];
      for (int d = 0; d < 2; ++d) D(first + q, 1 + d) = L[1][q] * K.gradient[1][d] + L[2][q] * K.gradient[2][d];
    }
  }
  deviation.place = place;
  deviation.bound = bound;
  deviation.at_points = D;
  deviation.on_held = on_held;
  return deviation;
}

Deviation deviation_of_obstacle(const method::PolynomialSpace& space, const BoundaryLift& lift, const ContinuousNodes& nodes,
                                const scene::FieldPtr& obstacle, const std::vector<double>& psi, const method::Jumps& jumps,
                                const std::vector<bool>& dirichlet) {
  const mesh::Mesh& mesh = space.mesh();
  const core::Comm& comm = mesh.comm;
  const auto host = mesh::on_host(mesh);
  const method::CellQuadrature& all = space.quadrature();
  const auto of_cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), nodes.of_cells);
  const auto functions = method::cell_functions(space.basis());
  const int n = space.basis().size();
  const auto polynomial = [&](LocalIndex K, double* c) {
    double local[reference::max_functions];
    for (int l = 0; l < n; ++l) local[l] = psi[of_cells(K, l)];
    functions.to_bernstein(local, c);
  };
  std::vector<LocalIndex> in_layer(mesh.owned_cells, -1), positions;
  for (std::size_t k = 0; k < lift.cells().extent(0); ++k) in_layer[lift.cells()(k)] = static_cast<LocalIndex>(k);

  double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300}, size = obstacle->cancelled();
  for (LocalIndex v = 0; v < mesh.vertices; ++v)
    for (int d = 0; d < 2; ++d) {
      low[d] = std::min(low[d], host.coordinates(v, d));
      high[d] = std::max(high[d], host.coordinates(v, d));
    }
  for (const double value : psi) size = std::max(size, std::abs(value));
  size = comm.max(size);
  const double width = std::max(comm.max(high[0]) - comm.min(low[0]), comm.max(high[1]) - comm.min(low[1]));

  // psi at rounded places is known as numbers of that size are
  const auto known_as = [&](LocalIndex K) {
    double least = psi[of_cells(K, 0)], most = least;
    for (int l = 1; l < n; ++l) {
      least = std::min(least, psi[of_cells(K, l)]);
      most = std::max(most, psi[of_cells(K, l)]);
    }
    return (most - least) * mesh::remoteness(3, [&](int a, int d) { return host.coordinates(host.cell_vertices(K, a), d); });
  };

  // where is psi more than its interpolant?
  bool deviates = false;
  const auto psi_less_interpolant = [&](const method::QuadratureBlock& block, LocalIndex k, const View<double*>& value, int q) {
    double c[reference::max_functions];
    polynomial(block.cell(k), c);
    const double xi = block.xi(q, 0), eta = block.xi(q, 1), lambda[3] = {1 - xi - eta, xi, eta};
    return value(q) - functions.B.value(c, lambda);
  };
  comm.together([&] {
    const View<double*> value("thixis::bound::obstacle", all.largest_block);
    method::for_each_block(all, [&](const method::QuadratureBlock& block) {
      method::evaluate(*obstacle, 0, block, value);
      for (LocalIndex k = 0; k < block.cells && block.cell(k) < mesh.owned_cells; ++k) {
        const LocalIndex K = block.cell(k);
        double most = 0;
        const double round_off = 1e-13 * std::max(size, known_as(K));
        for (int q = block.offset(k); q < block.offset(k + 1); ++q)
          most = std::max(most, std::abs(psi_less_interpolant(block, k, value, q)));
        deviates = deviates || most > round_off;
        const bool more = most > round_off && !jumps.at(block.first + k);
        if (more || in_layer[K] >= 0) positions.push_back(block.first + k);
      }
    });
  });
  Deviation deviation;
  deviation.of_obstacle = comm.any(deviates || jumps.any());
  if (!comm.any(!positions.empty())) return deviation;
  deviation.quadrature = subset(all, positions);
  const auto place = nowhere(mesh);
  const View<double*> bound("thixis::bound::deviation_bound", positions.size());
  const View<double* [3]> D("thixis::bound::deviation", deviation.quadrature.points());
  const View<bool* [3]> on_held("thixis::bound::deviation_on_held", positions.size());
  const auto slope = scene::difference_gradient(obstacle, 1e-5 * width);
  comm.together([&] {
    const int length = deviation.quadrature.largest_block;
    const View<double*> value("thixis::bound::obstacle", length), x("thixis::bound::obstacle_x", length),
        y("thixis::bound::obstacle_y", length);
    method::for_each_block(deviation.quadrature, [&](const method::QuadratureBlock& block) {
      method::evaluate(*obstacle, 0, block, value);
      method::evaluate(*slope[0], 0, block, x);
      method::evaluate(*slope[1], 0, block, y);
      for (LocalIndex k = 0; k < block.cells; ++k) {
        const LocalIndex K = block.cell(k), at = block.first + k;
        place(K) = at;
        if (in_layer[K] >= 0) bound(at) = lift.bound_of_difference(in_layer[K]);
        const auto geometry = mesh::cell_geometry(host.coordinates, host.cell_vertices, K);
        double c[reference::max_functions];
        polynomial(K, c);
        for (int q = block.offset(k); q < block.offset(k + 1); ++q) {
          const double xi = block.xi(q, 0), eta = block.xi(q, 1), lambda[3] = {1 - xi - eta, xi, eta};
          const GlobalIndex p = deviation.quadrature.offset(block.first) + q;
          double interpolant[3];
          functions.B.gradient(c, lambda, interpolant);
          if (!jumps.at(positions[at])) {
            D(p, 0) = functions.B.value(c, lambda) - value(q);
            D(p, 1) = -x(q);
            D(p, 2) = -y(q);
            for (int a = 0; a < 3; ++a)
              for (int d = 0; d < 2; ++d) D(p, 1 + d) += interpolant[a] * geometry.gradient[a][d];
          }
          if (in_layer[K] >= 0) {
            const auto L = lift(0, in_layer[K], xi, eta);
            D(p, 0) += L.value;
            for (int d = 0; d < 2; ++d) D(p, 1 + d) += L.gradient[d];
          }
          bound(at) = std::max(bound(at), std::abs(D(p, 0)));
        }
      }
    });
    const auto xi = face_points();
    std::vector<double> px(xi.extent(0)), py(xi.extent(0)), of_psi(xi.extent(0)), on_faces(xi.extent(0));
    for (std::size_t at = 0; at < positions.size(); ++at) {
      const LocalIndex K = all.cell(positions[at]);
      const auto is_held = [&](int i) {
        return host.face_tag(host.cell_faces(K, i)) >= 0 && dirichlet[host.face_tag(host.cell_faces(K, i))];
      };
      if (!is_held(0) && !is_held(1) && !is_held(2)) continue;
      double c[reference::max_functions];
      polynomial(K, c);
      for (std::size_t q = 0; q < xi.extent(0); ++q) {
        const double lambda[3] = {1 - xi(q, 0) - xi(q, 1), xi(q, 0), xi(q, 1)};
        px[q] = py[q] = 0;
        for (int a = 0; a < 3; ++a) {
          px[q] += lambda[a] * host.coordinates(host.cell_vertices(K, a), 0);
          py[q] += lambda[a] * host.coordinates(host.cell_vertices(K, a), 1);
        }
        on_faces[q] = functions.B.value(c, lambda);
        if (in_layer[K] >= 0) on_faces[q] += lift(0, in_layer[K], xi(q, 0), xi(q, 1)).value;
      }
      obstacle->evaluate({px.size(), px.data(), py.data()}, 0, of_psi.data());
      for (std::size_t q = 0; q < xi.extent(0); ++q) on_faces[q] -= of_psi[q];
      mark_held(host, dirichlet, K, on_faces.data(), 1e-12 * size, on_held, static_cast<LocalIndex>(at));
    }
  });
  deviation.place = place;
  deviation.bound = bound;
  deviation.at_points = D;
  deviation.on_held = on_held;
  return deviation;
}

Excess excess_of_majorant(const method::PolynomialSpace& space, const ContinuousNodes& nodes, const scene::Field& obstacle,
                          const std::vector<double>& majorant, const method::Jumps& jumps) {
  const mesh::Mesh& mesh = space.mesh();
  std::vector<LocalIndex> positions;
  for (LocalIndex k = 0; k < mesh.owned_cells; ++k)
    if (jumps.at(k)) positions.push_back(k);
  if (positions.empty()) return {};
  const auto of_cells = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), nodes.of_cells);
  const auto functions = method::cell_functions(space.basis());
  const reference::Modal modal(space.basis().degree());
  const int n = space.basis().size();
  Excess excess{nowhere(mesh), CellTable("thixis::bound::excess", positions.size(), n)};
  const auto quadrature = subset(space.quadrature(), positions);
  const View<double*> psi("thixis::bound::obstacle", quadrature.largest_block);
  method::for_each_block(quadrature, [&](const method::QuadratureBlock& block) {
    method::evaluate(obstacle, 0, block, psi);
    for (LocalIndex k = 0; k < block.cells; ++k) {
      const LocalIndex K = block.cell(k), at = block.first + k;
      excess.place(K) = at;
      double local[reference::max_functions], c[reference::max_functions], area = 0;
      for (int l = 0; l < n; ++l) local[l] = majorant[of_cells(K, l)];
      functions.to_bernstein(local, c);
      for (int q = block.offset(k); q < block.offset(k + 1); ++q) area += block.weight(q);
      for (int q = block.offset(k); q < block.offset(k + 1); ++q) {
        const double xi = block.xi(q, 0), eta = block.xi(q, 1), lambda[3] = {1 - xi - eta, xi, eta};
        const double above = block.weight(q) / (2 * area) * (functions.B.value(c, lambda) - psi(q));
        const auto phi = modal.values(1, &block.xi(q, 0));
        for (int m = 0; m < n; ++m) excess.moments(at, m) += above * phi[m];
      }
    }
  });
  return excess;
}

}  // namespace thixis::bound
