#include <algorithm>

#include "checks/membrane_checks.hpp"
#include "level/membrane_level.hpp"
#include "thixis/method/measures.hpp"

namespace thixis::membranes {

using algebra::Vector;

std::vector<output::FieldData> MembraneLevel::shown(const Vector& X, const complementarity::ActiveSet& active,
                                                    const std::vector<std::string>& names) const {
  const Fields x = fields(X);
  std::vector<output::FieldData> shown;
  const auto add = [&](const std::string& name, auto values) {
    if (names.empty() || std::find(names.begin(), names.end(), name) != names.end())
      shown.push_back({name, output::Centre::vertex, values()});
  };
  for (int alpha = 0; alpha < scene_.count; ++alpha)
    add(displacement(scene_.count, alpha), [&] {
      auto heights = space_->shown(membrane(x, alpha));
      for (double& height : heights) height += origin_;
      return heights;
    });
  add("lambda", [&] { return space_->shown(space_->multiplier(x.lambda)); });
  add("gap", [&] {
    auto gap = space_->shown(membrane(x, 0));
    const auto below = scene_.count == 2 ? space_->shown(membrane(x, 1))
                                         : space_->mesh().comm.together([&] { return grid_points().evaluate(*scene_.obstacle); });
    for (std::size_t i = 0; i < gap.size(); ++i) gap[i] -= below[i];
    return gap;
  });
  add("active", [&] {
    Vector flag(space_->map());
    {
      const auto out = algebra::host_view(flag);
      for (std::size_t l = 0; l < active.flags().size(); ++l) out(l) = active.flags()[l];
    }
    return space_->coefficients_shown(space_->complete(flag, nothing_));
  });
  return shown;
}

std::vector<std::string> MembraneLevel::point_fields(const MembraneScene& scene) {
  std::vector<std::string> names;
  for (int alpha = 0; alpha < scene.count; ++alpha) names.push_back(displacement(scene.count, alpha));
  names.insert(names.end(), {"lambda", "gap"});
  return names;
}

std::vector<double> MembraneLevel::values_at(const std::vector<models::Probe>& probes, const Vector& X) const {
  const Fields x = fields(X);
  const auto places = place(probes, space_->mesh());
  std::vector<std::vector<double>> columns;
  for (int alpha = 0; alpha < scene_.count; ++alpha) columns.push_back(method::values_at(*space_, places, membrane(x, alpha)));
  columns.push_back(method::values_at(*space_, places, space_->multiplier(x.lambda)));
  columns.push_back(columns[0]);
  PointList at;
  for (const auto& probe : probes) at.add(probe.at[0], probe.at[1]);
  const auto below = scene_.count == 2 ? columns[1] : at.evaluate(*scene_.obstacle);
  for (std::size_t i = 0; i < probes.size(); ++i) columns.back()[i] -= below[i];
  for (int alpha = 0; alpha < scene_.count; ++alpha)
    for (double& height : columns[alpha]) height += origin_;
  std::vector<double> rows;
  for (std::size_t i = 0; i < probes.size(); ++i)
    for (const auto& column : columns) rows.push_back(column[i]);
  return rows;
}

Vector MembraneLevel::gaps(const Fields& x) const {
  Vector K(problem_->points());
  gap(problem_->membranes(), x.u, K);
  return K;
}

double MembraneLevel::largest_gap(const Vector& X) const {
  const Vector gaps_l = gaps(fields(X));
  const auto K = algebra::host_view(gaps_l);
  double largest = 0;
  for (std::size_t l = 0; l < K.extent(0); ++l) largest = std::max(largest, K(l));
  return space_->mesh().comm.max(largest);
}

models::Contact MembraneLevel::contact(const Vector& X) const {
  const Fields x = fields(X);
  const Vector gaps_l = gaps(x);
  Vector scale(problem_->points());
  problem_->scaling(scale);
  models::Contact sum;
  {
    const auto read = [](const Vector& v) { return algebra::host_view(v); };
    const auto weight = read(areas()), K = read(gaps_l), s = read(scale), lambda = read(x.lambda), D = read(space_->pairing());
    for (std::size_t l = 0; l < K.extent(0); ++l) {
      if (s(l) * lambda(l) > K(l)) sum.area += weight(l);
      sum.force += D(l) * lambda(l);
    }
  }
  const core::Comm& comm = space_->mesh().comm;
  return {comm.sum(sum.area), comm.sum(sum.force)};
}

/// Set up at the first call. Collective.
const Vector& MembraneLevel::areas() const {
  if (areas_.is_null()) {
    areas_ = Teuchos::rcp(new Vector(space_->map()));
    space_->mesh().comm.together([&] { space_->add_moments(*scene::constant(1), 0, *areas_); });
  }
  return *areas_;
}

}  // namespace thixis::membranes
