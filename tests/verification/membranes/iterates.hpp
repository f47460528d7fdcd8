#pragma once
#include <functional>
#include <string>
#include <vector>

#include "problems.hpp"

namespace thixis::verification {

/// An iterate X^{k,i} as its bound sees it.
struct Seen {
  complementarity::Estimate eta;
  double error = 0;
  double effectivity() const { return eta.total / error; }
};

/// A scene on a mesh, to be looked at from outside.
struct Laid {
  drive::RunParams params;
  mesh::Hierarchy hierarchy;
  std::unique_ptr<models::StationaryModel> model;
  std::unique_ptr<models::Discretization> discretization;  ///< on the finest mesh

  models::Discretization& operator*() const { return *discretization; }
  models::Discretization* operator->() const { return discretization.get(); }
  Seen look(const algebra::Vector& X) const { return {discretization->estimate(X), discretization->energy_error(X).value_or(0)}; }
};
Laid lay(const drive::RunParams& params, const core::Comm& comm = core::Comm());

/// How Newton and the linear solver are stopped.
struct Stop {
  std::string name;
  complementarity::StoppingRule rule;
  algebra::SystemForm form;
};
const std::vector<Stop>& all_stops();

/// A cold start with loose linear solves: what is seen at X^0, at every look into the linear solver and at every X^k.
std::vector<Seen> iterates(const Laid& laid, const Stop& stop, complementarity::CFunction function, int check_every, int max_steps = 60);

/// The cases with a known solution, by letter: S, D, B, disk and the radial obstacle.
drive::RunParams known_case(const std::string& name, int level, const method::MethodParams& method);
const std::vector<std::string>& known_cases();

/// Finite elements with both kinds of contact, SIPG and NIPG with weak and strong data, HHO with both stabilization lengths.
std::vector<std::pair<std::string, method::MethodParams>> all_variants(int degree);

}  // namespace thixis::verification
