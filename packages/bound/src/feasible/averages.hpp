#pragma once
#include "lift/continuous_nodes.hpp"

namespace thixis::bound {

/// Continuous functions from broken ones: the coefficient of a node is the mean of those of the cells around it, and that of the boundary
/// data where they hold it (Oswald). Right at the nodes of owned cells: all their cells are patch cells.
class Averages {
 public:
  Averages(const method::Space& space, const ContinuousNodes& nodes);
  /// `held`: coefficients of the data, by node. Overwrites `average`.
  void operator()(const method::Coefficients& u, const View<const double*>& held, const View<double*>& average) const;

 private:
  View<const LocalIndex*> offset_, source_;  ///< coefficients of u of node e: source(offset(e)) … ; none: held
};

}  // namespace thixis::bound
