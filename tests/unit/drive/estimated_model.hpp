#pragma once
/// Two membranes by P1 elements, with an estimate that knows the exact solution: what is tested is what the drivers do with an estimate.
#include <memory>
#include <vector>

#include "thixis/drive/params.hpp"
#include "thixis/models/model.hpp"

namespace thixis::drive::test {

/// The bound is `effectivity` times the true error at discretization; what is out of balance and below zero comes on top. Cells near the
/// circle r = 1/3 have the larger part of it.
class EstimatedModel final : public models::StationaryModel {
 public:
  explicit EstimatedModel(const RunParams& params);

  double effectivity = 1.5;
  complementarity::Promise promise = complementarity::Promise::guaranteed;
  int good_levels = 100;             ///< on finer ones the bound is ten times larger
  mutable int estimates = 0;         ///< calls of `estimate`
  mutable std::vector<int> entered;  ///< levels that were discretized
  mutable std::vector<bool> nested;  ///< whether a level began from the one before, for those that were solved

  std::string name() const override { return inner_->name(); }
  std::string case_name() const override { return inner_->case_name(); }
  std::vector<std::string> point_fields() const override { return inner_->point_fields(); }
  void check(const mesh::Mesh& mesh, const models::Wanted& wanted) const override { inner_->check(mesh, wanted); }
  std::unique_ptr<models::Discretization> discretize(const mesh::Hierarchy& hierarchy, int level) const override;

 private:
  std::unique_ptr<models::StationaryModel> inner_;
};

/// The smooth contact on 4 x 4 squares, refined once; direct solver.
RunParams smooth_contact();

}  // namespace thixis::drive::test
