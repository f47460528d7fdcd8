#include <limits>

#include "elasticity_kernels.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/core/error.hpp"
#include "thixis/fem/forms.hpp"
#include "thixis/method/gradient_form.hpp"
#include "thixis/reference/quadrature.hpp"

namespace thixis::fem {
namespace {

using mesh::View;
using method::LocalMatrices;

ReferenceProducts reference_products(const reference::CellBasis& basis) {
  const int n = basis.size();
  const auto rule = reference::triangle_quadrature(2 * basis.degree());
  const auto table = basis.tabulate(rule.size(), rule.point.data());
  const Kokkos::View<double* [4], Kokkos::LayoutRight> Q("thixis::fem::reference_products", n * n);
  const auto host = Kokkos::create_mirror_view(Q);
  for (int q = 0; q < rule.size(); ++q)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int a = 0; a < 2; ++a)
          for (int b = 0; b < 2; ++b)
            host(i * n + j, 2 * a + b) += rule.weight[q] * table.gradient[2 * (q * n + i) + a] * table.gradient[2 * (q * n + j) + b];
  Kokkos::deep_copy(Q, host);
  return Q;
}

[[noreturn]] void refuse() {
  throw core::InputError(
      "scene/data: a material is not stable somewhere; give Lamé parameters with mu > 0 and lambda + mu > 0 everywhere.");
}

class ConstantForm final : public method::ElementForm {
 public:
  ConstantForm(const method::Space& space, double mu, double lambda)
      : space_(space), Q_(reference_products(space.basis())), mu_(mu), lambda_(lambda) {}
  void matrices(LocalIndex first, const LocalMatrices& A) const override {
    ConstantElasticity kernel;
    kernel.x = space_.mesh().coordinates;
    kernel.vertices = space_.mesh().cell_vertices;
    kernel.cells = space_.cells();
    kernel.Q = Q_;
    kernel.functions = space_.basis().size();
    kernel.mu = mu_;
    kernel.lambda = lambda_;
    kernel.first = first;
    kernel.A = A;
    Kokkos::parallel_for("thixis::fem::elasticity", Kokkos::RangePolicy<>(0, A.extent_int(0)), kernel);
  }

 private:
  const method::Space& space_;
  ReferenceProducts Q_;
  double mu_, lambda_;
};

class VaryingForm final : public method::ElementForm {
 public:
  VaryingForm(const method::Space& space, const scene::Field& mu, const scene::Field& lambda)
      : quadrature_(space.quadrature()),
        functions_(method::cell_functions(space.basis())),
        mu_(method::values_at_points(space.mesh(), quadrature_, mu)),
        lambda_(method::values_at_points(space.mesh(), quadrature_, lambda)) {
    double least = std::numeric_limits<double>::infinity();
    const View<const double*> shear = mu_, volume = lambda_;
    Kokkos::parallel_reduce(
        "thixis::fem::least_stiffness", Kokkos::RangePolicy<>(0, shear.extent_int(0)),
        KOKKOS_LAMBDA(int q, double& lowest) {
          const double both = shear(q) + volume(q), stiffness = shear(q) < both ? shear(q) : both;
          lowest = stiffness < lowest ? stiffness : lowest;
        },
        Kokkos::Min<double>(least));
    if (!(space.mesh().comm.min(least) > 0)) refuse();
  }
  void matrices(LocalIndex first, const LocalMatrices& A) const override {
    Kokkos::parallel_for("thixis::fem::elasticity_varying", Kokkos::RangePolicy<>(0, A.extent_int(0)),
                         VaryingElasticity{quadrature_, functions_, mu_, lambda_, first, A});
  }

 private:
  method::CellQuadrature quadrature_;
  method::CellFunctions functions_;
  View<const double*> mu_, lambda_;
};

class Elasticity final : public method::Form {
 public:
  Elasticity(const method::Space& space, scene::FieldPtr mu, scene::FieldPtr lambda)
      : Form(space), mu_(std::move(mu)), lambda_(std::move(lambda)) {}

  std::shared_ptr<const method::ElementForm> cells() const override {
    const double *const mu = mu_->constant(), *const lambda = lambda_->constant();
    if (!mu || !lambda) return std::make_shared<VaryingForm>(space(), *mu_, *lambda_);
    if (!(*mu > 0 && *mu + *lambda > 0)) refuse();
    return std::make_shared<ConstantForm>(space(), *mu, *lambda);
  }

  double energy(const method::QuadratureBlock& block, LocalIndex cells, const method::Coefficients& uh, const std::vector<method::Known>& u,
                double t) const override {
    const View<double*> mu("thixis::fem::mu", block.points), lambda("thixis::fem::lambda", block.points);
    evaluate(*mu_, 0, block, mu);
    evaluate(*lambda_, 0, block, lambda);
    ElasticEnergy kernel;
    kernel.functions = method::cell_functions(space().basis());
    kernel.x = space().mesh().coordinates;
    kernel.vertices = space().mesh().cell_vertices;
    kernel.block = block;
    kernel.mu = mu;
    kernel.lambda = lambda;
    kernel.gradient = gradient(block, u, t);
    kernel.entries = space().coefficients().element_entries;
    kernel.uh = uh;
    double sum = 0;
    Kokkos::parallel_reduce("thixis::fem::elastic_energy", Kokkos::RangePolicy<>(0, cells), kernel, sum);
    return sum;
  }

 private:
  static View<const double*[2][2]> gradient(const method::QuadratureBlock&block, const std::vector<method::Known>&u, double t) {
    const View<double* [2][2]> values("thixis::fem::gradient", u.empty() ? 0 : block.points);
    const View<double*> one("thixis::fem::derivative", values.extent(0));
    for (std::size_t i = 0; i < u.size(); ++i)
      for (int d = 0; d < 2; ++d) {
        evaluate(*u[i].gradient[d], t, block, one);
        Kokkos::deep_copy(Kokkos::subview(values, Kokkos::ALL, i, d), one);
      }
    return values;
  }

  scene::FieldPtr mu_,
      lambda_;
};

}  // namespace

method::FormPtr elasticity(const method::Space& space, const scene::FieldPtr& mu, const scene::FieldPtr& lambda) {
  THIXIS_ASSERT_EQ(space.components(), 2, "displacements in the plane");
  return std::make_shared<Elasticity>(space, mu, lambda);
}

}  // namespace thixis::fem
