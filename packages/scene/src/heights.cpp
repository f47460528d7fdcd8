#include "thixis/scene/heights.hpp"

#include <algorithm>
#include <cmath>

namespace thixis::scene {
namespace {

class Shifted final : public Field {
 public:
  Shifted(FieldPtr f, double by) : f_(std::move(f)), by_(by) {}
  void evaluate(const Points& points, double t, double* values) const override {
    f_->evaluate(points, t, values);
    for (std::size_t i = 0; i < points.count; ++i) values[i] += by_;
  }
  bool steady() const override { return f_->steady(); }
  std::optional<Degree> degree() const override { return f_->degree(); }
  double cancelled() const override { return std::max(f_->cancelled(), std::abs(by_)); }

 private:
  FieldPtr f_;
  double by_;
};

}  // namespace

FieldPtr shifted(const FieldPtr& f, double by) {
  if (!f || by == 0) return f;
  if (const double* value = f->constant()) return constant(*value + by);
  return std::make_shared<Shifted>(f, by);
}

MembraneScene counted_from(double origin, MembraneScene scene) {
  const auto lower = [origin](FieldPtr& height) { height = shifted(height, -origin); };
  const auto lower_held = [&](BoundaryCondition& condition) {
    if (condition.kind == BoundaryKind::dirichlet)
      for (FieldPtr& value : condition.value) lower(value);
  };
  lower_held(scene.default_boundary);
  for (auto& [tag, condition] : scene.boundary) lower_held(condition);
  lower(scene.obstacle);
  for (int alpha = 0; alpha < scene.count; ++alpha) {
    lower(scene.initial[alpha]);
    if (scene.exact) lower(scene.exact->u[alpha]);
  }
  return scene;
}

}  // namespace thixis::scene
