#include "thixis/fem/lagrange_space.hpp"

#include "lagrange_nodes.hpp"
#include "mass.hpp"
#include "thixis/algebra/tpetra.hpp"

namespace thixis::fem {
namespace {

class LagrangeLayout final : public method::Layout {
 public:
  explicit LagrangeLayout(int degree) : degree_(degree) {}
  bool conforming() const override { return true; }
  bool nodal_multiplier() const override { return degree_ == 1; }

  method::Coefficients multiplier(const method::Space& space, const algebra::Vector& X3) const override {
    if (!mass_) mass_ = std::make_unique<Mass>(space);
    return mass_->solve(X3);
  }

 private:
  int degree_;
  mutable std::unique_ptr<Mass> mass_;  ///< made when a multiplier is first asked for as a function
};

}  // namespace

std::unique_ptr<method::Space> make_lagrange_space(const mesh::Mesh& mesh, const method::SpaceOptions& options) {
  auto structure = method::in_components(options, [&](const method::SpaceOptions& scalar) { return lagrange_nodes(mesh, scalar); });
  return std::make_unique<method::Space>(mesh, options, std::move(structure), std::make_unique<LagrangeLayout>(options.params.degree));
}

}  // namespace thixis::fem
