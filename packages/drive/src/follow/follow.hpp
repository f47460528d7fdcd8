#pragma once
#include "follow/follower.hpp"
#include "thixis/drive/stationary.hpp"

namespace thixis::drive {

/// The log's table of Newton steps, the history and the checkpoint follow the solve.
class Follow : public Follower {
 public:
  using Follower::Follower;

  Observer observer();
  /// Whether the iterate was worth it.
  bool save(const Position& at, const models::Discretization& discretization, const algebra::Vector& X) const;

 private:
  void begin_level(const mesh::Mesh& mesh, int level, const models::Sizes& sizes) const;
  void end_level(const Progress& at);
  void step(const Progress& at, const complementarity::NewtonRecord& record);
  void refined(int level, const std::vector<GlobalIndex>& marked);
  output::HistoryRow row_of(const Progress& at) const;
};

}  // namespace thixis::drive
