#include "flux/discretization_flux.hpp"

#include "data/tables.hpp"
#include "flux/flux_sources.hpp"

namespace thixis::bound {

DiscretizationFlux::DiscretizationFlux(const method::Space& space, int q, const std::vector<bool>& held) : space_(space) {
  if (!space.conforming()) return;
  const LocalIndex cells = space.cells().extent_int(0);
  const int n = reference::dimension(q);
  patches_ = std::make_unique<equilibration::PatchFlux>(space.mesh(), space.cells(), held, q);
  times_ = times_hats(q);
  density_ = CellTable("thixis::bound::patch_density", cells, 3 * n);
  target_ = CellTable("thixis::bound::patch_target", cells, 2 * n);
}

void DiscretizationFlux::operator()(const ContactProblem& problem, const method::Coefficients& u, int alpha, const FluxMultiplier& lambda,
                                    const ConstCellTable& rate, const MembraneFlux& of) const {
  const double sign = alpha == 0 ? 1 : -1;
  if (!on_patches())
    return problem.form[alpha]->native_flux(*problem.force[alpha], u, problem.boundary[alpha], problem.time, {lambda.at_held, sign},
                                            of.disc);
  PatchSources sources;
  sources.f = of.data.force;
  sources.rate = rate;
  sources.r_alg = of.alg.r;
  sources.r_lin = of.lin.r;
  sources.lambda = lambda.of_vertices;
  sources.w = of.w;
  sources.sign = sign;
  sources.times = times_;
  sources.density = density_;
  sources.target = target_;
  Kokkos::parallel_for("thixis::bound::patch_data", Kokkos::RangePolicy<>(0, density_.extent_int(0)), sources);
  (*patches_)({density_, target_, of.data.traction}, of.disc);
}

std::size_t DiscretizationFlux::bytes() const {
  return sizeof(double) * (density_.size() + target_.size()) + (patches_ ? patches_->bytes() : 0);
}

}  // namespace thixis::bound
