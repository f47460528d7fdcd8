#include "thixis/fem/lagrange_space.hpp"

#include "lagrange_nodes.hpp"
#include "mass.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/method/gradient_form.hpp"

namespace thixis::fem {
namespace {

using algebra::Vector;
using method::Coefficients;

/// p = 1: nodal multiplier, lumped mass as pairing. p >= 2: moments.
class LagrangeSpace final : public method::PolynomialSpace {
 public:
  LagrangeSpace(const mesh::Mesh& mesh, const method::SpaceOptions& options)
      : PolynomialSpace(mesh, options, lagrange_nodes(mesh, options)) {
    if (!nodal_multiplier()) return;
    auto D = Teuchos::rcp(new Vector(points()));
    mesh.comm.together([&] { add_moments(*scene::constant(1), 0, *D); });
    set_pairing(D);
  }

  bool conforming() const override { return true; }
  bool nodal_multiplier() const override { return params_.degree == 1; }

  std::shared_ptr<const method::CellForm> cell_form(const scene::Field& tension) const override {
    return method::gradient_form(mesh_, quadrature_, basis_, tension);
  }

  Coefficients multiplier(const Vector& X3) const override {
    const Coefficients zero("thixis::fem::zero", structure_.entries.size());
    if (nodal_multiplier()) return complete(X3, zero);
    if (!mass_) mass_ = std::make_unique<Mass>(mesh_, cells_, basis_, structure_);
    std::vector<double> moments(structure_.entries.size(), 0.0);
    const auto values = algebra::host_view(X3);
    for (std::size_t row = 0; row < values.extent(0); ++row) moments[numbering_.entry_of_column[row]] = values(row);
    return mass_->solve(moments);
  }

  void interpolate_multiplier(const scene::Field& lambda, double t, Vector& X3) const override {
    if (nodal_multiplier()) interpolate(lambda, t, X3);
    else PolynomialSpace::interpolate_multiplier(lambda, t, X3);
  }

  void prolongate_multiplier(const method::Space& coarse, const Vector& coarse_X3, Vector& X3) const override {
    if (nodal_multiplier()) prolongate(coarse, coarse.multiplier(coarse_X3), X3);
    else PolynomialSpace::prolongate_multiplier(coarse, coarse_X3, X3);
  }

 private:
  mutable std::unique_ptr<Mass> mass_;  ///< made when a multiplier is first asked for as a function
};

}  // namespace

std::unique_ptr<method::Space> make_lagrange_space(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  return std::make_unique<LagrangeSpace>(mesh, options);
}

}  // namespace thixis::fem
