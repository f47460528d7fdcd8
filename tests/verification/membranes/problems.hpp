#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "methods.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/drive/stationary.hpp"
#include "thixis/membranes/membranes.hpp"

namespace thixis::verification {

using tests::built;
using tests::is_built;
using tests::method_of;
using tests::with;

/// A run with its mesh, which its results refer to.
struct Solved {
  mesh::Hierarchy hierarchy;
  std::unique_ptr<models::StationaryModel> model;
  drive::Outcome outcome;
};

/// Solves what the parameters describe.
Solved solve(const drive::RunParams& params, const core::Comm& comm = core::Comm(), const drive::Observer& observer = {});

/// A catalogued case on T_level: criss-cross 4 or 4 rings and so many refinements; nested start, direct solver on the reduced form.
drive::RunParams catalogued(const std::string& name, int level);
/// The scene of a deck in inputs/membranes, its mesh with so many refinements, and solved in the same way.
drive::RunParams from_deck(const std::string& deck, int refinements);

/// The block `data` of the deck: name -> expression or number.
drive::RunParams data(const std::map<std::string, std::string>& functions, int level, const std::string& model = "membranes");
/// Membranes with tensions mu1, mu2, held 0.1 apart from the plane and pressed together: contact in the middle of the unit square.
drive::RunParams pressed(const std::string& mu1, const std::string& mu2, int level);

/// The block `method` by its main entries.
method::MethodParams by(const std::string& name, int degree, method::Nodes nodes = method::Nodes::gauss_lobatto);

/// All methods of one degree that the program has, each with its name for messages: fem, sipg, nipg, hho.
std::vector<std::pair<std::string, method::MethodParams>> all_methods(int degree);

/// log2 of the ratio of two successive errors.
double order(double coarse, double fine);

}  // namespace thixis::verification
