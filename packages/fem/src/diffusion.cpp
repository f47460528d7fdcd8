#include "thixis/core/assert.hpp"
#include "thixis/fem/forms.hpp"
#include "thixis/method/gradient_form.hpp"

namespace thixis::fem {
namespace {

class Diffusion final : public method::Form {
 public:
  Diffusion(const method::Space& space, scene::FieldPtr tension) : Form(space), tension_(std::move(tension)) {}

  std::shared_ptr<const method::ElementForm> cells() const override {
    return method::gradient_form(space().mesh(), space().quadrature(), space().basis(), *tension_);
  }

  double energy(const method::QuadratureBlock& block, LocalIndex cells, const method::Coefficients& uh, const std::vector<method::Known>& u,
                double t) const override {
    return method::gradient_energy(space(), *tension_, block, cells, uh, u, t);
  }

 private:
  scene::FieldPtr tension_;
};

}  // namespace

method::FormPtr diffusion(const method::Space& space, const scene::FieldPtr& tension) {
  THIXIS_ASSERT_EQ(space.components(), 1, "diffusion is of scalar fields");
  return std::make_shared<Diffusion>(space, tension);
}

}  // namespace thixis::fem
