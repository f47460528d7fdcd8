#include "thixis/method/gradient_form.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "kernels/polynomial_kernels.hpp"
#include "thixis/core/error.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::method {
namespace {

/// A(e) = mu 2|K| (m_00 Q_0 + m_01 Q_1 + m_11 Q_2), m_ab = grad(lambda_a+1)·grad(lambda_b+1): Q_0, Q_2 hold the products of the derivatives
/// in xi and in eta, Q_1 those of the mixed ones.
struct ConstantTension {
  View<double* [2]> x;
  View<LocalIndex* [3]> vertices;
  View<const LocalIndex*> cells;
  Kokkos::View<const double* [3], Kokkos::LayoutRight> Q;  ///< (i n + j, 0 … 2)
  double mu;
  LocalIndex first;
  LocalMatrices A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const mesh::CellGeometry K = mesh::cell_geometry(x, vertices, cells(first + e));
    const double* const a = K.gradient[1];
    const double* const b = K.gradient[2];
    const double scale = 2 * mu * K.area;
    const double m[3] = {scale * (a[0] * a[0] + a[1] * a[1]), scale * (a[0] * b[0] + a[1] * b[1]), scale * (b[0] * b[0] + b[1] * b[1])};
    const int n = A.extent_int(1);
    double* const out = &A(e, 0, 0);
    for (int ij = 0; ij < n * n; ++ij) out[ij] = m[0] * Q(ij, 0) + m[1] * Q(ij, 1) + m[2] * Q(ij, 2);
  }
};

struct VaryingTension {
  CellQuadrature quadrature;
  CellFunctions functions;
  View<const double*> mu;
  LocalIndex first;
  LocalMatrices A;  ///< out, overwritten

  KOKKOS_FUNCTION void operator()(int e) const {
    const CellQuadrature& Q = quadrature;
    const LocalIndex k = first + e, rule = Q.own_rule(k);
    const mesh::CellGeometry K = mesh::cell_geometry(Q.coordinates, Q.cell_vertices, Q.cell(k));
    const int n = functions.size(), points = static_cast<int>(Q.offset(k + 1) - Q.offset(k));
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) A(e, i, j) = 0;
    for (int q = 0; q < points; ++q) {
      const GlobalIndex at = rule < 0 ? q : Q.own_offset(rule) + q;
      const double xi = rule < 0 ? Q.rule_xi(at, 0) : Q.own_xi(at, 0), eta = rule < 0 ? Q.rule_xi(at, 1) : Q.own_xi(at, 1);
      const double weight = 2 * K.area * (rule < 0 ? Q.rule_weight(at) : Q.own_weight(at)) * mu(Q.offset(k) + q);
      const double lambda[3] = {1 - xi - eta, xi, eta};
      double g[reference::max_functions][2];
      functions.gradients(K, lambda, g);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) A(e, i, j) += weight * (g[i][0] * g[j][0] + g[i][1] * g[j][1]);
    }
  }
};

/// Products of the reference derivatives, integrated: (i n + j, …) as in ConstantTension.
Kokkos::View<double* [3], Kokkos::LayoutRight> reference_products(const reference::CellBasis& basis) {
  const int n = basis.size();
  const auto rule = reference::triangle_quadrature(2 * basis.degree());
  const auto table = basis.tabulate(rule.size(), rule.point.data());
  Kokkos::View<double* [3], Kokkos::LayoutRight> Q("thixis::method::reference_products", n * n);
  const auto host = Kokkos::create_mirror_view(Q);
  for (int q = 0; q < rule.size(); ++q)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double* const di = &table.gradient[2 * (q * n + i)];
        const double* const dj = &table.gradient[2 * (q * n + j)];
        host(i * n + j, 0) += rule.weight[q] * di[0] * dj[0];
        host(i * n + j, 1) += rule.weight[q] * (di[0] * dj[1] + di[1] * dj[0]);
        host(i * n + j, 2) += rule.weight[q] * di[1] * dj[1];
      }
  Kokkos::deep_copy(Q, host);
  return Q;
}

class ConstantForm final : public ElementForm {
 public:
  ConstantForm(const mesh::Mesh& mesh, const View<const LocalIndex*>& cells, const reference::CellBasis& basis, double mu)
      : mesh_(mesh), cells_(cells), Q_(reference_products(basis)), mu_(mu) {}
  void matrices(LocalIndex first, const LocalMatrices& A) const override {
    ConstantTension kernel;
    kernel.x = mesh_.coordinates;
    kernel.vertices = mesh_.cell_vertices;
    kernel.cells = cells_;
    kernel.Q = Q_;
    kernel.mu = mu_;
    kernel.first = first;
    kernel.A = A;
    Kokkos::parallel_for("thixis::method::gradient_form", Kokkos::RangePolicy<>(0, A.extent_int(0)), kernel);
  }

 private:
  const mesh::Mesh& mesh_;
  View<const LocalIndex*> cells_;
  Kokkos::View<const double* [3], Kokkos::LayoutRight> Q_;
  double mu_;
};

class VaryingForm final : public ElementForm {
 public:
  VaryingForm(const CellQuadrature& quadrature, const reference::CellBasis& basis, const View<const double*>& mu)
      : quadrature_(quadrature), functions_(cell_functions(basis)), mu_(mu) {}
  void matrices(LocalIndex first, const LocalMatrices& A) const override {
    Kokkos::parallel_for("thixis::method::gradient_form_varying", Kokkos::RangePolicy<>(0, A.extent_int(0)),
                         VaryingTension{quadrature_, functions_, mu_, first, A});
  }

 private:
  CellQuadrature quadrature_;
  CellFunctions functions_;
  View<const double*> mu_;
};

}  // namespace

CellFunctions cell_functions(const reference::CellBasis& basis) {
  return {basis.bernstein(), matrix_view("thixis::method::to_bernstein", basis.size(), basis.size(), basis.to_bernstein())};
}

Kokkos::View<double**, Kokkos::LayoutRight> matrix_view(const char* label, int rows, int columns, const std::vector<double>& values) {
  Kokkos::View<double**, Kokkos::LayoutRight> view(std::string(label), rows, columns);
  const auto host = Kokkos::create_mirror_view(view);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) host(i, j) = values[static_cast<std::size_t>(i) * columns + j];
  Kokkos::deep_copy(view, host);
  return view;
}

LocalIndex cells_per_block(int width) { return std::clamp<LocalIndex>((1 << 16) / (width * width), 16, block_size); }

View<double*> values_at_points(const mesh::Mesh& mesh, const CellQuadrature& quadrature, const scene::Field& field) {
  const View<double*> values(Kokkos::view_alloc(std::string("thixis::method::coefficient"), Kokkos::WithoutInitializing),
                             quadrature.points());
  const auto offset = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), quadrature.offset);
  mesh.comm.together([&] {
    for_each_block(quadrature, [&](const QuadratureBlock& block) {
      const auto first = static_cast<std::size_t>(offset(block.first));
      evaluate(field, 0, block, Kokkos::subview(values, std::pair(first, first + block.points)));
    });
  });
  return values;
}

View<double*> tension_at_points(const mesh::Mesh& mesh, const CellQuadrature& quadrature, const scene::Field& tension) {
  const View<double*> mu = values_at_points(mesh, quadrature, tension);
  double least = std::numeric_limits<double>::infinity();
  Kokkos::parallel_reduce(
      "thixis::method::least_tension", Kokkos::RangePolicy<>(0, mu.extent_int(0)),
      KOKKOS_LAMBDA(int q, double& lowest) { lowest = mu(q) < lowest ? mu(q) : lowest; }, Kokkos::Min<double>(least));
  if (!(mesh.comm.min(least) > 0))
    throw core::InputError("scene/data: a tension is not positive in some cell; give tensions that are positive everywhere.");
  return mu;
}

double gradient_energy(const Space& space, const scene::Field& tension, const QuadratureBlock& block, LocalIndex cells,
                       const Coefficients& uh, const std::vector<Known>& u, double t) {
  const bool compared = !u.empty();
  const auto buffer = [&](const char* label, bool used) {
    return View<double*>(Kokkos::view_alloc(std::string(label), Kokkos::WithoutInitializing), used ? block.points : 0);
  };
  const View<double*> mu = buffer("thixis::method::tension", true), x = buffer("thixis::method::gradient_x", compared),
                      y = buffer("thixis::method::gradient_y", compared);
  evaluate(tension, t, block, mu);
  if (compared) {
    evaluate(*u[0].gradient[0], t, block, x);
    evaluate(*u[0].gradient[1], t, block, y);
  }
  return gradient_error(cell_functions(space.basis()), space.mesh(), block, cells, {mu, x, y}, space.coefficients().element_entries, uh);
}

std::shared_ptr<const ElementForm> gradient_form(const mesh::Mesh& mesh, const CellQuadrature& quadrature,
                                                 const reference::CellBasis& basis, const scene::Field& tension) {
  if (const double* mu = tension.constant()) return std::make_shared<ConstantForm>(mesh, quadrature.cell, basis, *mu);
  return std::make_shared<VaryingForm>(quadrature, basis, tension_at_points(mesh, quadrature, tension));
}

}  // namespace thixis::method
