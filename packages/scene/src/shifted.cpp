#include "thixis/scene/shifted.hpp"

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

}  // namespace thixis::scene
