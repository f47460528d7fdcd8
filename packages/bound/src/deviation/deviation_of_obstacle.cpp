#include <algorithm>
#include <cmath>

#include "data/on_host.hpp"
#include "deviation/deviation.hpp"
#include "deviation/deviation_points.hpp"
#include "deviation/over_obstacle.hpp"
#include "thixis/mesh/remoteness.hpp"
#include "thixis/mesh/statistics.hpp"

namespace thixis::bound {

BlockOnHost::BlockOnHost(const method::QuadratureBlock& block)
    : cell(on_host(block.cell)), offset(on_host(block.offset)), xi(on_host(block.xi)) {}

OverObstacle::OverObstacle(const method::Space& space, const BoundaryLift& lift, const ContinuousNodes& nodes,
                           const scene::FieldPtr& obstacle, const std::vector<double>& psi, const method::Jumps& jumps)
    : space_(space),
      mesh_(space.mesh()),
      host_(mesh::on_host(mesh_)),
      lift_(lift),
      of_cells_(on_host(nodes.of_cells)),
      obstacle_(obstacle),
      psi_(psi),
      jumps_(jumps),
      B_(space.basis().bernstein()),
      in_layer_(mesh_.owned_cells, -1),
      size_(obstacle->cancelled()) {
  const auto layer = on_host(lift.cells());
  for (std::size_t k = 0; k < layer.extent(0); ++k) in_layer_[layer(k)] = static_cast<LocalIndex>(k);
  for (const double value : psi) size_ = std::max(size_, std::abs(value));
  size_ = mesh_.comm.max(size_);
  const mesh::Box box = mesh::bounding_box(mesh_);
  slope_ = scene::difference_gradient(obstacle, 1e-5 * std::max(box.side(0), box.side(1)));
}

/// psi at rounded places is known as numbers of that size are.
double OverObstacle::known_as(LocalIndex K) const {
  double least = psi_[of_cells_(K, 0)], most = least;
  for (int l = 1; l < space_.basis().size(); ++l) {
    least = std::min(least, psi_[of_cells_(K, l)]);
    most = std::max(most, psi_[of_cells_(K, l)]);
  }
  return (most - least) * mesh::remoteness(3, [&](int a, int d) { return host_.coordinates(host_.cell_vertices(K, a), d); });
}

double OverObstacle::most(const BlockOnHost& block, LocalIndex k, const mesh::HostView<double*>& value) const {
  double c[reference::max_functions], most = 0;
  polynomial(block.cell(k), c);
  for (int q = block.offset(k); q < block.offset(k + 1); ++q) {
    const double xi = block.xi(q, 0), eta = block.xi(q, 1), lambda[3] = {1 - xi - eta, xi, eta};
    most = std::max(most, std::abs(value(q) - B_.value(c, lambda)));
  }
  return most;
}

std::vector<LocalIndex> OverObstacle::find() {
  const method::CellQuadrature& all = space_.quadrature();
  const View<double*> value("thixis::bound::obstacle", all.largest_block);
  std::vector<LocalIndex> positions;
  method::for_each_block(all, [&](const method::QuadratureBlock& block) {
    method::evaluate(*obstacle_, 0, block, value);
    const BlockOnHost points(block);
    const mesh::HostView<double*> psi = on_host(value);
    for (LocalIndex k = 0; k < block.cells && points.cell(k) < mesh_.owned_cells; ++k) {
      const LocalIndex K = points.cell(k);
      const bool more = most(points, k, psi) > 1e-13 * std::max(size_, known_as(K));
      deviates_ = deviates_ || more;
      if ((more && !jumps_.at(block.first + k)) || in_layer_[K] >= 0) positions.push_back(block.first + k);
    }
  });
  return positions;
}

/// D and its derivatives at the points of the cells of a block, and a bound on |D| in each.
void OverObstacle::tabulate(const method::QuadratureBlock& block, const mesh::ConstHostView<const GlobalIndex*>& offset,
                            const std::vector<LocalIndex>& positions) {
  const auto at_points = [&](const scene::Field& field) {
    const View<double*> values("thixis::bound::obstacle", block.points);
    method::evaluate(field, 0, block, values);
    return on_host(values);
  };
  const mesh::HostView<double*> value = at_points(*obstacle_), x = at_points(*slope_[0]), y = at_points(*slope_[1]);
  const BlockOnHost points(block);
  const GlobalIndex first = offset(block.first);
  for (LocalIndex k = 0; k < block.cells; ++k) {
    const LocalIndex K = points.cell(k), at = block.first + k, layer = in_layer_[K];
    out_.place(K) = at;
    if (layer >= 0) out_.bound(at) = lift_.bound_of_difference(layer);
    const auto geometry = mesh::cell_geometry(host_.coordinates, host_.cell_vertices, K);
    double c[reference::max_functions];
    polynomial(K, c);
    for (int q = points.offset(k); q < points.offset(k + 1); ++q) {
      const double xi = points.xi(q, 0), eta = points.xi(q, 1), lambda[3] = {1 - xi - eta, xi, eta};
      const GlobalIndex p = first + q;
      if (!jumps_.at(positions[at])) {
        double interpolant[3];
        B_.gradient(c, lambda, interpolant);
        out_.at_points(p, 0) = B_.value(c, lambda) - value(q);
        out_.at_points(p, 1) = -x(q);
        out_.at_points(p, 2) = -y(q);
        for (int a = 0; a < 3; ++a)
          for (int d = 0; d < 2; ++d) out_.at_points(p, 1 + d) += interpolant[a] * geometry.gradient[a][d];
      }
      if (layer >= 0) {
        const auto L = lift_(0, layer, xi, eta);
        out_.at_points(p, 0) += L.value;
        for (int d = 0; d < 2; ++d) out_.at_points(p, 1 + d) += L.gradient[d];
      }
      out_.bound(at) = std::max(out_.bound(at), std::abs(out_.at_points(p, 0)));
    }
  }
}

void OverObstacle::mark(const std::vector<LocalIndex>& positions, const std::vector<bool>& dirichlet) const {
  const auto xi = on_host(face_points());
  const auto cells = on_host(space_.quadrature().cell);
  std::vector<double> px(xi.extent(0)), py(xi.extent(0)), of_psi(xi.extent(0)), on_faces(xi.extent(0));
  for (std::size_t at = 0; at < positions.size(); ++at) {
    const LocalIndex K = cells(positions[at]);
    const auto is_held = [&](int i) {
      const LocalIndex tag = host_.face_tag(host_.cell_faces(K, i));
      return tag >= 0 && dirichlet[tag];
    };
    if (!is_held(0) && !is_held(1) && !is_held(2)) continue;
    double c[reference::max_functions];
    polynomial(K, c);
    for (std::size_t q = 0; q < xi.extent(0); ++q) {
      const double lambda[3] = {1 - xi(q, 0) - xi(q, 1), xi(q, 0), xi(q, 1)};
      px[q] = py[q] = 0;
      for (int a = 0; a < 3; ++a) {
        px[q] += lambda[a] * host_.coordinates(host_.cell_vertices(K, a), 0);
        py[q] += lambda[a] * host_.coordinates(host_.cell_vertices(K, a), 1);
      }
      on_faces[q] = B_.value(c, lambda);
      if (in_layer_[K] >= 0) on_faces[q] += lift_(0, in_layer_[K], xi(q, 0), xi(q, 1)).value;
    }
    obstacle_->evaluate({px.size(), px.data(), py.data()}, 0, of_psi.data());
    for (std::size_t q = 0; q < xi.extent(0); ++q) on_faces[q] -= of_psi[q];
    mark_held(host_, dirichlet, K, on_faces.data(), 1e-12 * size_, out_.on_held, static_cast<LocalIndex>(at));
  }
}

Deviation OverObstacle::operator()(const std::vector<bool>& dirichlet) {
  const core::Comm& comm = mesh_.comm;
  const auto positions = comm.together([&] { return find(); });
  Deviation deviation;
  deviation.of_obstacle = comm.any(deviates_ || jumps_.any());
  if (!comm.any(!positions.empty())) return deviation;
  quadrature_ = subset(space_.quadrature(), positions);
  out_ = DeviationOnHost(mesh_, positions.size(), quadrature_.points());
  comm.together([&] {
    const mesh::ConstHostView<const GlobalIndex*> offset = on_host(quadrature_.offset);
    method::for_each_block(quadrature_, [&](const method::QuadratureBlock& block) { tabulate(block, offset, positions); });
    mark(positions, dirichlet);
  });
  deviation.quadrature = quadrature_;
  out_.commit(deviation);
  return deviation;
}

Deviation deviation_of_obstacle(const method::Space& space, const BoundaryLift& lift, const ContinuousNodes& nodes,
                                const scene::FieldPtr& obstacle, const std::vector<double>& psi, const method::Jumps& jumps,
                                const std::vector<bool>& dirichlet) {
  return OverObstacle(space, lift, nodes, obstacle, psi, jumps)(dirichlet);
}

}  // namespace thixis::bound
