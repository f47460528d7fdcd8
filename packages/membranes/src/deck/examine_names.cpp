#include <fmt/format.h>

#include "deck/examine.hpp"

namespace thixis::membranes {

std::vector<MembraneEntries> membranes_of(const std::string& model) {
  using D = DataParams;
  using B = BoundaryParams;
  if (model == model::obstacle) return {{"", &D::mu, &D::f, &D::g, &D::u, &D::u_x, &D::u_y, &B::g, &B::t}};
  if (model == model::two || model == model::in_time)
    return {{"1", &D::mu1, &D::f1, &D::g1, &D::u1, &D::u1_x, &D::u1_y, &B::g1, &B::t1},
            {"2", &D::mu2, &D::f2, &D::g2, &D::u2, &D::u2_x, &D::u2_y, &B::g2, &B::t2}};
  return {};
}

std::vector<Place> places(const MembraneEntries& m, const SceneParams& params) {
  const DataParams& data = *params.data;
  const std::string &l = m.index, u = "u" + l;
  std::vector<Place> all = {{"data", "mu" + l, data.*m.mu}, {"data", "f" + l, data.*m.f},    {"data", "g" + l, data.*m.g},
                            {"data", u, data.*m.u},         {"data", u + "_x", data.*m.u_x}, {"data", u + "_y", data.*m.u_y}};
  for (const auto& [tag, part] : params.boundary) {
    all.push_back({"boundary/" + tag, "g" + l, part.*m.g_here});
    all.push_back({"boundary/" + tag, "t" + l, part.*m.t_here});
  }
  return all;
}

bool examine_names(const std::string& model, const SceneParams& params, const scene::Report& report) {
  bool right = true;
  const auto refuse = [&](const Place& entry, const std::string& sentence) {
    if (entry.formula.empty()) return;
    report(entry.path(), sentence);
    right = false;
  };
  const auto one = places(membranes_of(model::obstacle)[0], params), upper = places(membranes_of(model::two)[0], params),
             lower = places(membranes_of(model::two)[1], params);
  for (std::size_t i = 0; i < one.size(); ++i)
    if (model == model::obstacle) {
      refuse(upper[i], fmt::format("there is one membrane; write {} in place of {}.", one[i].name, upper[i].name));
      refuse(lower[i],
             fmt::format("the obstacle psi takes the place of the lower membrane; drop {}, or write model = 'membranes'.", lower[i].name));
    } else {
      refuse(one[i], fmt::format("there are two membranes; write {} and {} in place of {}, or model = 'obstacle'.", upper[i].name,
                                 lower[i].name, one[i].name));
    }
  if (model != model::obstacle)
    refuse({"data", "psi", params.data->psi}, "the lower membrane takes the place of an obstacle; drop psi, or write model = 'obstacle'.");
  return right;
}

}  // namespace thixis::membranes
