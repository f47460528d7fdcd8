#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "methods.hpp"
#include "thixis/algebra/tpetra.hpp"
#include "thixis/drive/params.hpp"
#include "thixis/membranes/parabolic_membranes.hpp"

namespace thixis::verification {

using tests::built;
using tests::method_of;

/// A run in time with fixed steps, and what was seen of it.
struct March {
  std::unique_ptr<models::UnsteadyModel> model;
  std::unique_ptr<models::Evolution> evolution;
  Teuchos::RCP<algebra::Vector> X;          ///< at the end
  std::vector<int> newton;                  ///< linear systems of each step
  std::vector<std::vector<double>> series;  ///< of each step
  bool solved = true;                       ///< all steps converged
  double worst_kkt = 0;                     ///< of all steps

  int total() const;
  double at(std::size_t step, const std::string& column) const;  ///< of the series
  double largest(const std::string& column) const;
  /// (sum_n tau |||u(t_n) - u_h^n|||²)^{1/2}.
  double error_at_ends(double step) const;
};

/// Called after each step with its end and X.
using AtStep = std::function<void(models::Evolution&, double, const algebra::Vector&)>;

/// `steps` equal steps up to `end`.
March march(const drive::RunParams& params, int steps, double end, const AtStep& at_step = {}, const core::Comm& comm = core::Comm());

/// A catalogued case on the unit square, n squares a side with one diagonal each; direct solver, full system, no scaling, nonlinear
/// residuals as small as rounding allows.
drive::RunParams on_squares(const std::string& name, int n, const std::string& method = "fem", int degree = 1);

double order(double coarse, double fine);

}  // namespace thixis::verification
