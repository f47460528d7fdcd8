#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "thixis/algebra/solver.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/mesh/geometry.hpp"
#include "thixis/method/form.hpp"
#include "thixis/reference/modal.hpp"
#include "thixis/reference/quadrature.hpp"

/// What Form::native_flux promises, looked at from outside.
namespace thixis::method {

/// A field of one membrane: any coefficients, data and multiplier.
struct FluxProblem {
  const Space& V;
  const Space& free;  ///< the same space on the same mesh, nothing held
  FormPtr (*diffusion)(const Space&, const scene::FieldPtr&);
  scene::FieldPtr tension, force;
  BoundaryValues boundary;
  double sign = 1;  ///< -(-1)^alpha

  FormPtr form() const { return diffusion(V, tension); }
  int degree() const { return V.flux_degree(); }
  BoundaryValues none() const {
    return {std::vector<scene::FieldPtr>(boundary.dirichlet.size()), std::vector<scene::FieldPtr>(boundary.dirichlet.size())};
  }
};

/// Numbers in [-1, 1] that depend on the unknown and not on the ranks.
inline algebra::Vector arbitrary(const Space& V, int seed) {
  algebra::Vector v(V.map());
  const auto ids = V.unknown_ids();
  const auto values = algebra::host_overwrite(v);
  for (std::size_t row = 0; row < ids.size(); ++row) values(row) = std::sin(12.9898 * static_cast<double>(ids[row] % 100003) + seed);
  return v;
}

/// X3 as a vector on all unknowns.
inline algebra::Vector extended(const Space& V, const algebra::Vector& X3) {
  algebra::Vector v(V.map());
  const auto out = algebra::host_view(v);
  const auto in = algebra::host_view(X3);
  for (std::size_t l = 0; l < in.extent(0); ++l) out(l) = in(l);
  return v;
}

inline algebra::Vector restricted(const Space& V, const algebra::Vector& v) {
  algebra::Vector X3(V.points());
  const auto out = algebra::host_overwrite(X3);
  const auto in = algebra::host_view(v);
  for (std::size_t l = 0; l < out.extent(0); ++l) out(l) = in(l);
  return X3;
}

/// R = F - (-1)^alpha D X3 - a(u, ·).
inline algebra::Vector residual(const FluxProblem& problem, const Coefficients& u, const algebra::Vector& X3) {
  const Space& V = problem.V;
  algebra::Vector R(V.map()), forces(V.map());
  load(*problem.form(), *problem.force, problem.boundary, 0, R);
  apply(*problem.form(), u, forces);
  R.update(-1, forces, problem.sign, extended(V, X3), 1);
  return R;
}

inline View<double**> flux(const FluxProblem& problem, const Coefficients& u) {
  const View<double**> sigma("sigma", problem.V.mesh().owned_cells, 2 * reference::dimension(problem.degree() + 1));
  problem.form()->native_flux(*problem.force, u, problem.boundary, 0, {}, sigma);
  return sigma;
}

/// The worst of (div sigma, v)_K - (f - (-1)^alpha lambda_h - r, v)_K over the cells and an orthonormal basis of P_q, over the largest of
/// what enters.
inline double imbalance(const FluxProblem& problem, const View<double**>& sigma, const algebra::Vector& R, const algebra::Vector& X3) {
  const Space& V = problem.V;
  const int n = V.basis().size(), q = problem.degree();
  const Coefficients zero("zero", V.coefficients().entries.size()), free_zero("zero", problem.free.coefficients().entries.size());
  algebra::Vector F(problem.free.map());
  load(*problem.diffusion(problem.free, problem.tension), *problem.force, problem.none(), 0, F);
  const Coefficients f = problem.free.complete(F, free_zero), lambda = V.complete(extended(V, X3), zero);
  const View<double**> r("r", V.cells().extent(0), n);
  V.share(R, r);

  const reference::Modal modal(q + 1), tests(q);
  const auto phi = tests.values(n, V.basis().points().data());
  const int size = modal.size();
  double worst = 0, largest = 0;
  for (LocalIndex K = 0; K < V.mesh().owned_cells; ++K)
    for (int k = 0; k < tests.size(); ++k) {
      double div = 0, rhs = 0;
      for (int d = 0; d < 2; ++d)
        for (int m = 0; m < size; ++m) div += modal.derivative(d)[k * size + m] * sigma(K, d * size + m);
      for (int l = 0; l < n; ++l) {
        double c = 0;
        for (int i = 0; i < n; ++i) c += V.basis().from_values()[l * n + i] * phi[i * tests.size() + k];
        const double parts[3] = {f(problem.free.coefficients().element_entries(K, l)),
                                 problem.sign * lambda(V.coefficients().element_entries(K, l)), -r(K, l)};
        for (const double part : parts) {
          rhs += c * part;
          largest = std::max(largest, std::abs(part));
        }
      }
      largest = std::max(largest, std::abs(div));
      worst = std::max(worst, std::abs(div - rhs));
    }
  return V.mesh().comm.max(worst) / V.mesh().comm.max(largest);
}

/// Moments of sigma·n against L_j on the faces of owned cells, outward, from the lower to the higher vertex id.
struct NormalMoment {
  GlobalIndex face;
  int j;
  double value;
};
inline std::vector<NormalMoment> normal_moments(const FluxProblem& problem, const View<double**>& sigma, int count) {
  const Space& V = problem.V;
  const reference::Modal modal(problem.degree() + 1);
  const auto host = mesh::on_host(V.mesh());
  const int size = modal.size();
  std::vector<NormalMoment> all;
  for (LocalIndex K = 0; K < V.mesh().owned_cells; ++K)
    for (int i = 0; i < 3; ++i) {
      const auto trace = modal.trace(i, count);
      const LocalIndex F = host.cell_faces(K, i);
      const bool along = host.face_vertices(F, 0) == host.cell_vertices(K, (i + 1) % 3);
      for (int j = 0; j < count; ++j) {
        double moment = 0;
        for (int d = 0; d < 2; ++d)
          for (int m = 0; m < size; ++m) moment += reference::face_normal[i][d] * trace[j * size + m] * sigma(K, d * size + m);
        all.push_back({V.mesh().face_id[F], j, along || j % 2 == 0 ? moment : -moment});
      }
    }
  return all;
}

/// The worst sum of the outward normal fluxes of both cells of a face inside, and of moments beyond q, over the largest moment.
inline double discontinuity(const FluxProblem& problem, const View<double**>& sigma) {
  const Space& V = problem.V;
  const int q = problem.degree(), count = q + 2;
  std::map<std::pair<GlobalIndex, int>, std::pair<int, double>> sum;
  double largest = 0, worst = 0;
  for (const auto& moment : V.mesh().comm.gather(normal_moments(problem, sigma, count))) {
    auto& entry = sum[{moment.face, moment.j}];
    ++entry.first;
    entry.second += moment.value;
    largest = std::max(largest, std::abs(moment.value));
    if (moment.j > q) worst = std::max(worst, std::abs(moment.value));
  }
  for (const auto& [key, entry] : sum)
    if (entry.first == 2) worst = std::max(worst, std::abs(entry.second));
  return worst / largest;
}

/// The worst moment of sigma·n + t on faces without Dirichlet data.
inline double traction_error(const FluxProblem& problem, const std::vector<bool>& dirichlet, const View<double**>& sigma) {
  const auto& mesh = problem.V.mesh();
  const auto host = mesh::on_host(mesh);
  const int count = problem.degree() + 1;
  const auto rule = reference::line_quadrature(2 * problem.V.basis().degree() + 4);
  std::map<GlobalIndex, LocalIndex> local;
  for (LocalIndex F = 0; F < mesh.faces; ++F) local[mesh.face_id[F]] = F;
  double worst = 0, largest = 0;
  for (const auto& moment : normal_moments(problem, sigma, count)) {
    const LocalIndex F = local[moment.face], tag = host.face_tag(F);
    largest = std::max(largest, std::abs(moment.value));
    if (tag < 0 || dirichlet[tag]) continue;
    double expected = 0;
    const double length = mesh::face_geometry(host.coordinates, host.face_vertices, F).length;
    for (int g = 0; g < rule.size() && problem.boundary.neumann[tag]; ++g) {
      double at[2], t;
      for (int d = 0; d < 2; ++d)
        at[d] = (1 - rule.point[g]) * host.coordinates(host.face_vertices(F, 0), d) +
                rule.point[g] * host.coordinates(host.face_vertices(F, 1), d);
      problem.boundary.neumann[tag]->evaluate({1, &at[0], &at[1]}, 0, &t);
      expected -= length * rule.weight[g] * t * reference::legendre(count, rule.point[g])[moment.j];
    }
    worst = std::max(worst, std::abs(moment.value - expected));
  }
  return mesh.comm.max(worst) / mesh.comm.max(largest);
}

/// ‖mu^{1/2} grad u_h + mu^{-1/2} sigma‖ over the mesh, with the gradients of the cells' polynomials.
inline double mismatch(const FluxProblem& problem, const Coefficients& u, const View<double**>& sigma) {
  const Space& V = problem.V;
  const auto host = mesh::on_host(V.mesh());
  const int n = V.basis().size();
  const reference::Modal modal(problem.degree() + 1);
  const auto rule = reference::triangle_quadrature(2 * V.basis().degree() + 4);
  const auto table = V.basis().tabulate(rule.size(), rule.point.data());
  const auto phi = modal.values(rule.size(), rule.point.data());
  double sum = 0;
  for (LocalIndex K = 0; K < V.mesh().owned_cells; ++K) {
    const auto cell = mesh::cell_geometry(host.coordinates, host.cell_vertices, K);
    double x[3][2];
    for (int a = 0; a < 3; ++a)
      for (int d = 0; d < 2; ++d) x[a][d] = host.coordinates(host.cell_vertices(K, a), d);
    for (int g = 0; g < rule.size(); ++g) {
      double reference_gradient[2] = {0, 0}, hat[2] = {0, 0}, place[2], mu, square = 0;
      for (int d = 0; d < 2; ++d) {
        for (int l = 0; l < n; ++l)
          reference_gradient[d] += table.gradient[2 * (g * n + l) + d] * u(V.coefficients().element_entries(K, l));
        for (int m = 0; m < modal.size(); ++m) hat[d] += phi[g * modal.size() + m] * sigma(K, d * modal.size() + m);
        place[d] = x[0][d] + rule.point[2 * g] * (x[1][d] - x[0][d]) + rule.point[2 * g + 1] * (x[2][d] - x[0][d]);
      }
      problem.tension->evaluate({1, &place[0], &place[1]}, 0, &mu);
      for (int d = 0; d < 2; ++d) {
        const double gradient = reference_gradient[0] * cell.gradient[1][d] + reference_gradient[1] * cell.gradient[2][d];
        const double value = (hat[0] * (x[1][d] - x[0][d]) + hat[1] * (x[2][d] - x[0][d])) / (2 * cell.area);
        square += (mu * gradient + value) * (mu * gradient + value) / mu;
      }
      sum += 2 * cell.area * rule.weight[g] * square;
    }
  }
  return std::sqrt(V.mesh().comm.sum(sum));
}

/// The discrete solution without contact.
inline Coefficients solution(const FluxProblem& problem) {
  const Space& V = problem.V;
  algebra::Vector F(V.map()), held(V.map()), u(V.map());
  const auto lift = V.lift(problem.boundary, 0);
  load(*problem.form(), *problem.force, problem.boundary, 0, F);
  apply(*problem.form(), lift, held);
  F.update(-1, held, 1);
  algebra::LinearParams params;
  params.solver = algebra::SolverKind::direct;
  algebra::Solver solver(params);
  solver.set_matrix(assemble(*problem.form()), 1);
  EXPECT_LT(solver.solve(F, u, {1e-13 * F.norm2(), 0, nullptr}).residual, 1e-10 * F.norm2());
  return V.complete(u, lift);
}

/// Tensions of the tests: constant, smooth, jumping across a curve through cells.
enum class Tension { constant, smooth, jump };
inline scene::FieldPtr interface_of(Tension kind) {
  if (kind != Tension::jump) return nullptr;
  return scene::formula([](double x, double y) { return x + 0.31 * y - 0.47; });
}
inline scene::FieldPtr tension_of(Tension kind) {
  if (kind == Tension::constant) return scene::constant(2.5);
  if (kind == Tension::smooth) return scene::formula([](double x, double y) { return 2 + std::sin(2 * x - y); });
  return scene::formula([](double x, double y) { return x + 0.31 * y > 0.47 ? 5.0 : 1.5; });
}

/// Which parts of the boundary have Dirichlet data: all, none, every second one.
enum class Held { all, none, alternating };
inline std::vector<bool> held_tags(const mesh::Mesh& mesh, Held held) {
  std::vector<bool> dirichlet(mesh.tags.size(), held == Held::all);
  for (std::size_t tag = 0; held == Held::alternating && tag < dirichlet.size(); tag += 2) dirichlet[tag] = true;
  return dirichlet;
}
inline BoundaryValues boundary_of(const std::vector<bool>& dirichlet, const scene::FieldPtr& g, const scene::FieldPtr& t) {
  BoundaryValues boundary;
  for (const bool held : dirichlet) {
    boundary.dirichlet.push_back(held ? g : nullptr);
    boundary.neumann.push_back(held ? nullptr : t);
  }
  return boundary;
}

}  // namespace thixis::method
