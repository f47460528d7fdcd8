#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "methods.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/bound/feasible.hpp"
#include "thixis/mesh/build.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/mesh/host.hpp"
#include "thixis/reference/modal.hpp"
#include "thixis/reference/quadrature.hpp"

/// What the tests of the feasible pair share: meshes, spaces, discrete functions, and the same integrals by brute force.
namespace thixis::bound {

using method::Coefficients;
using method::Nodes;
using method::Space;
using scene::FieldPtr;

inline mesh::Hierarchy square(int refinements) {
  mesh::MeshParams params;
  params.refinements = refinements;
  params.cells_per_rank = 20;
  return mesh::build(params, core::Comm(), "");
}

struct Setting {
  std::string name;
  int degree;
  Nodes nodes = Nodes::gauss_lobatto;
};

inline std::unique_ptr<Space> make_space(const mesh::Mesh& mesh, const Setting& setting, const FieldPtr& level_set = nullptr) {
  method::MethodParams params;
  params.name = setting.name;
  params.degree = setting.degree;
  params.nodes = setting.nodes;
  const method::SpaceOptions options{std::vector<bool>(mesh.tags.size(), true), level_set, params};
  return tests::method_of(setting.name).make_space(mesh, options);
}

inline method::BoundaryValues everywhere(const mesh::Mesh& mesh, const FieldPtr& dirichlet) {
  return {std::vector<FieldPtr>(mesh.tags.size(), dirichlet), std::vector<FieldPtr>(mesh.tags.size())};
}

/// Boundary data and interpolant of one function.
inline Coefficients interpolated(const Space& V, const FieldPtr& u, const FieldPtr& boundary) {
  algebra::Vector values(V.map());
  V.interpolate(*u, 0, values);
  return V.complete(values, V.lift(everywhere(V.mesh(), boundary), 0));
}
inline Coefficients interpolated(const Space& V, const FieldPtr& u) { return interpolated(V, u, u); }

inline FeasiblePair::Problem two_membranes(const mesh::Mesh& mesh, const FieldPtr& g1, const FieldPtr& g2, const FieldPtr& mu1,
                                           const FieldPtr& mu2) {
  return {2, {mu1, mu2}, {everywhere(mesh, g1), everywhere(mesh, g2)}, nullptr};
}

/// A point of the reference triangle in an owned cell.
struct PointOfCell {
  LocalIndex cell;
  double xi, eta, x, y;
};
inline PointOfCell point_of(const mesh::HostMesh& host, LocalIndex K, double xi, double eta) {
  const double lambda[3] = {1 - xi - eta, xi, eta};
  PointOfCell at{K, xi, eta, 0, 0};
  for (int a = 0; a < 3; ++a) {
    at.x += lambda[a] * host.coordinates(host.cell_vertices(K, a), 0);
    at.y += lambda[a] * host.coordinates(host.cell_vertices(K, a), 1);
  }
  return at;
}

/// f(weight, point) at the points of a rule of that order in every owned cell; the weights sum to |K|.
template <class F>
void at_points(const mesh::Mesh& mesh, int order, F f) {
  const auto host = mesh::on_host(mesh);
  const auto rule = reference::triangle_quadrature(order);
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
    const double det = 2 * mesh::cell_area(host.coordinates, host.cell_vertices, K);
    for (int q = 0; q < rule.size(); ++q) f(det * rule.weight[q], point_of(host, K, rule.point[2 * q], rule.point[2 * q + 1]));
  }
}

/// Densities of a function, of that degree: (owned cell, dim P_degree).
inline CellTable density_of(const mesh::Mesh& mesh, const FieldPtr& f, int degree) {
  const reference::Modal modal(degree);
  const int n = reference::dimension(degree);
  const CellTable g("density", mesh.owned_cells, n);
  at_points(mesh, 12, [&](double weight, const PointOfCell& at) {
    const double point[2] = {at.xi, at.eta};
    double value = 0;
    f->evaluate({1, &at.x, &at.y}, 0, &value);
    const auto phi = modal.values(1, point);
    for (int k = 0; k < n; ++k) g(at.cell, k) += weight * value * phi[k];
  });
  return g;
}

/// The same at the centroids of sides² equal parts of every owned cell.
template <class F>
void densely(const mesh::Mesh& mesh, int sides, F f) {
  const auto host = mesh::on_host(mesh);
  for (LocalIndex K = 0; K < mesh.owned_cells; ++K) {
    const double weight = mesh::cell_area(host.coordinates, host.cell_vertices, K) / (sides * sides);
    for (int i = 0; i < sides; ++i)
      for (int j = 0; i + j < sides; ++j) {
        f(weight, point_of(host, K, (i + 1.0 / 3) / sides, (j + 1.0 / 3) / sides));
        if (i + j + 1 < sides) f(weight, point_of(host, K, (i + 2.0 / 3) / sides, (j + 2.0 / 3) / sides));
      }
  }
}

/// A discrete function and its gradient at a point of an owned cell.
struct Sample {
  double value = 0, gradient[2] = {0, 0};
};
class Sampler {
 public:
  explicit Sampler(const Space& V) : V_(V), host_(mesh::on_host(V.mesh())) {}
  void at(const PointOfCell& place) {
    const double point[2] = {place.xi, place.eta};
    table_ = V_.basis().tabulate(1, point);
    geometry_ = mesh::cell_geometry(host_.coordinates, host_.cell_vertices, place.cell);
  }
  Sample operator()(const std::vector<double>& c) const {
    Sample sample;
    for (std::size_t l = 0; l < c.size(); ++l) {
      sample.value += c[l] * table_.value[l];
      for (int d = 0; d < 2; ++d)
        for (int r = 0; r < 2; ++r) sample.gradient[d] += c[l] * table_.gradient[2 * l + r] * geometry_.gradient[r + 1][d];
    }
    return sample;
  }
  std::vector<double> coefficients(const Coefficients& u, LocalIndex K) const {
    std::vector<double> c(V_.basis().size());
    for (std::size_t l = 0; l < c.size(); ++l) c[l] = u(V_.coefficients().element_entries(K, l));
    return c;
  }

 private:
  const Space& V_;
  mesh::HostMesh host_;
  reference::Tabulation table_;
  mesh::CellGeometry geometry_{};
};

inline double sum_of(const core::Comm& comm, const View<double*>& v, double power = 1) {
  double sum = 0;
  for (std::size_t K = 0; K < v.extent(0); ++K) sum += std::pow(v(K), power);
  return comm.sum(sum);
}

}  // namespace thixis::bound
