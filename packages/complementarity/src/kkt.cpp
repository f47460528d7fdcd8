#include "thixis/complementarity/kkt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "views.hpp"

namespace thixis::complementarity {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// What is not finite counts as infinitely wrong.
double judged(double x) { return std::isfinite(x) ? x : infinite; }

/// Largest max(-v_l, 0) / scale
struct BelowZero {
  Read v;
  double scale;
  KOKKOS_FUNCTION void operator()(int l, double& worst) const {
    const double violation = !std::isfinite(v(l)) ? infinite : v(l) < 0 ? -v(l) / scale : 0.0;
    if (worst < violation) worst = violation;
  }
};

/// Largest min(|g_l| / gap_scale, |λ_l| / multiplier_scale)
struct NotComplementary {
  Read gap, multiplier;
  double gap_scale, multiplier_scale;
  KOKKOS_FUNCTION void operator()(int l, double& worst) const {
    const double g = std::abs(gap(l)) / gap_scale, m = std::abs(multiplier(l)) / multiplier_scale;
    const double violation = !std::isfinite(g) || !std::isfinite(m) ? infinite : g < m ? g : m;
    if (worst < violation) worst = violation;
  }
};

/// Largest |λ_l - claimed_l| / scale
struct Disagreement {
  Read multiplier, claimed;
  double scale;
  KOKKOS_FUNCTION void operator()(int l, double& worst) const {
    const double difference = std::abs(multiplier(l) - claimed(l)) / scale;
    const double violation = std::isfinite(difference) ? difference : infinite;
    if (worst < violation) worst = violation;
  }
};

template <class Kernel>
double worst_of(const char* label, const algebra::Vector& points, const Kernel& kernel) {
  double worst = 0;
  Kokkos::parallel_reduce(label, Kokkos::RangePolicy<Execution>(0, static_cast<int>(points.getLocalLength())), kernel,
                          Kokkos::Max<double>(worst));
  return std::max(worst, 0.0);
}

void must_fit(const KktData& data) {
  const auto fits = [&](const Teuchos::RCP<const algebra::Vector>& v) {
    return !v.is_null() && !data.gap.is_null() && v->getLocalLength() == data.gap->getLocalLength();
  };
  bool here = fits(data.gap) && fits(data.claimed) && !data.equilibrium.empty();
  for (const auto& multiplier : data.equilibrium) here = here && fits(multiplier);
  if (data.gap.is_null() || !comm_of(*data.gap->getMap()).all(here))
    throw core::Error(core::ExitCode::internal,
                      "The contact conditions need a gap, the claimed multiplier and the multiplier of each body on one map.");
  const auto positive = [](double scale) { return scale > 0 && std::isfinite(scale); };
  const bool bodies = data.body_scale.empty() || data.body_scale.size() == data.equilibrium.size();
  if (!positive(data.gap_scale) || !positive(data.multiplier_scale) || !bodies ||
      !std::all_of(data.body_scale.begin(), data.body_scale.end(), positive))
    throw core::Error(core::ExitCode::internal,
                      fmt::format("The contact conditions need positive scales of gap and multiplier, not {} and {}.", data.gap_scale,
                                  data.multiplier_scale));
}

}  // namespace

Kkt verify(const KktData& data) {
  must_fit(data);
  const algebra::Vector& gap = *data.gap;
  Kkt kkt;
  kkt.infeasible = worst_of("thixis::complementarity::infeasible", gap, BelowZero{read(gap), data.gap_scale});
  kkt.between_nodes = std::max(judged(data.between_nodes / data.gap_scale), 0.0);
  kkt.equilibrium = judged(std::abs(data.unbalanced));

  const auto judge = [&](const algebra::Vector& multiplier, double scale) {
    kkt.negative = std::max(kkt.negative, worst_of("thixis::complementarity::negative", gap, BelowZero{read(multiplier), scale}));
    kkt.complementary = std::max(kkt.complementary, worst_of("thixis::complementarity::complementary", gap,
                                                             NotComplementary{read(gap), read(multiplier), data.gap_scale, scale}));
    kkt.equilibrium = std::max(
        kkt.equilibrium, worst_of("thixis::complementarity::equilibrium", gap, Disagreement{read(multiplier), read(*data.claimed), scale}));
  };
  judge(*data.claimed, data.multiplier_scale);
  for (std::size_t alpha = 0; alpha < data.equilibrium.size(); ++alpha)
    judge(*data.equilibrium[alpha], data.body_scale.empty() ? data.multiplier_scale : data.body_scale[alpha]);

  std::vector<double> global = {kkt.infeasible, kkt.negative, kkt.complementary, kkt.between_nodes, kkt.equilibrium};
  comm_of(*gap.getMap()).max(global);
  return {global[0], global[1], global[2], global[3], global[4]};
}

double Kkt::worst() const { return std::max({infeasible, negative, complementary, equilibrium}); }

std::string Kkt::sentence(double tolerance) const {
  const std::string between =
      between_nodes > 0 ? fmt::format(" Between the points the gap goes down to {:.1e} below zero.", between_nodes) : std::string();
  if (holds(tolerance)) return fmt::format("The contact conditions hold up to {:.1e}.", worst()) + between;
  std::string wrong;
  const auto name = [&](double violation, const char* what) {
    if (violation <= tolerance) return;
    wrong += fmt::format("{}{} {:.1e}", wrong.empty() ? "" : ", ", what, violation);
  };
  name(infeasible, "gap below zero by");
  name(negative, "multiplier below zero by");
  name(complementary, "gap and multiplier both open by");
  name(equilibrium, "multiplier out of equilibrium by");
  return fmt::format("The contact conditions are violated (more than {:.1e}, relative): {}.", tolerance, wrong) + between;
}

}  // namespace thixis::complementarity
