#include "falling.hpp"

#include <cmath>
#include <limits>

#include "thixis/algebra/tpetra.hpp"
#include "thixis/core/error.hpp"

namespace thixis::drive::test {
namespace {

using algebra::Vector;

double force(GlobalIndex l, double t) { return (1 + static_cast<double>(l)) * std::cos(3 * t) - 0.5; }

/// Unknowns (x_l, lambda_l); rows (x_l - x_l^before)/tau - f_l - lambda_l = 0 and the one of contact.
class Step final : public complementarity::Problem {
 public:
  Step(algebra::MapPtr points, const Falling& params)
      : params_(params), points_(std::move(points)), map_(algebra::interlaced(points_, 2)) {}

  void begin(const models::TimeStep& step, const Vector& before) {
    tau_ = step.length();
    const auto x = algebra::host_view(before);
    data_.resize(algebra::local_size(*points_));
    for (std::size_t l = 0; l < data_.size(); ++l)
      data_[l] = x(2 * l) / tau_ + force(points_->getGlobalElement(static_cast<LocalIndex>(l)), step.end);
  }

  algebra::MapPtr map() const override { return map_; }
  algebra::MapPtr points() const override { return points_; }
  void equations(const Vector& X, Vector& R) const override {
    const auto x = algebra::host_view(X);
    const auto r = algebra::host_overwrite(R);
    for (std::size_t l = 0; l < data_.size(); ++l) {
      r(2 * l) = x(2 * l) / tau_ - data_[l] - x(2 * l + 1);
      r(2 * l + 1) = 0;
    }
  }
  void arguments(const Vector& X, Vector& K, Vector& G) const override {
    const auto x = algebra::host_view(X);
    const auto k = algebra::host_overwrite(K), g = algebra::host_overwrite(G);
    for (std::size_t l = 0; l < data_.size(); ++l) {
      k(l) = x(2 * l);
      g(l) = x(2 * l + 1);
    }
  }
  void scaling(Vector& s) const override { s.putScalar(tau_); }
  void insert(const Vector& C, Vector& R) const override {
    const auto c = algebra::host_view(C);
    const auto r = algebra::host_view(R);
    for (std::size_t l = 0; l < data_.size(); ++l) r(2 * l + 1) = c(l);
  }
  void linearize(const Vector&, const Vector& a, const Vector& b) override {
    a_ = Teuchos::rcp(new Vector(a, Teuchos::Copy));
    b_ = Teuchos::rcp(new Vector(b, Teuchos::Copy));
  }
  algebra::LinearReport solve(const Vector& R, Vector& dX, const algebra::LinearStop&) override {
    algebra::LinearReport report;
    report.iterations = 1;
    report.converged = tau_ <= params_.longest_step;
    if (!report.converged) {
      report.residual = std::numeric_limits<double>::quiet_NaN();
      report.reason = "the step is too long";
      return report;
    }
    const auto r = algebra::host_view(R), a = algebra::host_view(std::as_const(*a_)), b = algebra::host_view(std::as_const(*b_));
    const auto d = algebra::host_overwrite(dX);
    for (std::size_t l = 0; l < data_.size(); ++l) {  // [1/tau -1; a b] d = -r
      const double det = b(l) / tau_ + a(l);
      d(2 * l) = (-r(2 * l) * b(l) - r(2 * l + 1)) / det;
      d(2 * l + 1) = (-r(2 * l + 1) / tau_ + r(2 * l) * a(l)) / det;
    }
    return report;
  }
  double reference_norm() const override {
    double square = 0;
    for (const double value : data_) square += value * value;
    return std::sqrt(algebra::comm_of(*points_).sum(square));
  }

 private:
  const Falling& params_;
  algebra::MapPtr points_, map_;
  double tau_ = 1;
  std::vector<double> data_;
  Teuchos::RCP<Vector> a_, b_;
};

class Fall final : public models::Evolution {
 public:
  Fall(const Falling& params, const core::Comm& comm)
      : params_(params), comm_(comm), points_(shares(params, comm)), step_(points_, params_) {}

  const core::Comm& comm() const override { return comm_; }
  GlobalIndex cells() const override { return params_.points; }
  models::Sizes sizes() const override { return {2 * params_.points, 2 * params_.points, 4 * params_.points}; }
  Teuchos::RCP<Vector> initial() override {
    auto X = Teuchos::rcp(new Vector(step_.map()));
    const auto x = algebra::host_view(*X);
    for (std::size_t i = 0; i < x.extent(0); i += 2) x(i) = 0.1;
    return X;
  }
  void begin(const models::TimeStep& step, const Vector& before) override {
    length_ = step.length();
    at_ = step.end;
    begin_ = step.begin;
    if (step.end > params_.wrong_from) throw core::InputError("scene: the data end here.");
    step_.begin(step, before);
  }
  void give_up() override { at_ = begin_; }
  complementarity::Problem& problem() override { return step_; }
  bool predict(Vector& X) override {
    if (params_.misleading) X.putScalar(std::numeric_limits<double>::quiet_NaN());
    return params_.misleading;
  }
  complementarity::Estimate estimate(const Vector&) override { return {1, 1, 0, 0, 0, 0}; }
  models::CellEstimates cell_estimates() const override { return {}; }
  std::optional<models::StepErrors> step_errors() const override {
    return models::StepErrors{params_.error_in_time * std::max(length_, params_.alike < 1e300 ? params_.alike : 0), 1};
  }
  void accept(const Vector& X) override { sum_ += X.norm1() * length_; }
  std::optional<double> error_so_far() const override { return sum_; }

  complementarity::KktData kkt_data(const Vector& X) const override {
    auto K = Teuchos::rcp(new Vector(points_)), G = Teuchos::rcp(new Vector(points_));
    step_.arguments(X, *K, *G);
    complementarity::KktData data;
    data.gap = K;
    data.claimed = G;
    data.equilibrium = {G};
    return data;
  }
  std::vector<std::string> series_names() const override { return {"sum"}; }
  std::vector<double> series(const Vector& X) const override { return {X.norm1()}; }
  output::Grid grid() const override { return {}; }
  std::vector<output::FieldData> fields(const Vector&, const complementarity::ActiveSet&, const std::vector<std::string>&) const override {
    return {};
  }
  models::State save(const Vector& X) const override {
    output::CheckpointBlock block{"x", {}, {}};
    const auto x = algebra::host_view(X);
    for (std::size_t i = 0; i < x.extent(0); ++i) {
      block.ids.push_back(X.getMap()->getGlobalElement(static_cast<LocalIndex>(i)));
      block.values.push_back(x(i));
    }
    return {{block}, {{"sum", sum_}, {"data_time", at_}}};
  }
  Teuchos::RCP<Vector> restore(const output::StoredCheckpoint& stored) override {
    auto X = Teuchos::rcp(new Vector(step_.map()));
    std::vector<GlobalIndex> ids;
    const auto x = algebra::host_overwrite(*X);
    for (std::size_t i = 0; i < x.extent(0); ++i) ids.push_back(X->getMap()->getGlobalElement(static_cast<LocalIndex>(i)));
    const auto values = stored.fetch("x", ids);
    std::copy(values.begin(), values.end(), x.data());
    sum_ = stored.attribute("sum");
    return X;
  }

 private:
  static algebra::MapPtr shares(const Falling& params, const core::Comm& comm) {
    const GlobalIndex each = params.points / comm.size(), more = params.points % comm.size();
    return algebra::contiguous_map(static_cast<LocalIndex>(each + (comm.rank() < more ? 1 : 0)), comm);
  }

  Falling params_;
  core::Comm comm_;
  algebra::MapPtr points_;
  Step step_;
  double length_ = 0, sum_ = 0, begin_ = 0;
  double at_ = 0;  ///< the time of the data
};

}  // namespace

std::unique_ptr<models::Evolution> falling(const Falling& params, const core::Comm& comm) { return std::make_unique<Fall>(params, comm); }

}  // namespace thixis::drive::test
